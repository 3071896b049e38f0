// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/sky_sampler.h"

#include "host/shade/lights/light_sampler.h"
#include "host/shade/shade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace ovc {
namespace {

/// A dark sky with a small bright sun.
class SunnySky final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        const bool is_sun = glm::length(area.st - dvec2(0.3, 0.8)) < 0.02;
        return vec4(vec3(is_sun ? 500 : 0.25f), 1);
    }
    dvec2 size() const override { return dvec2(512, 256); }
    bool has_opacity() const override { return false; }
};

Scene scene_under(const ImageLookup& lookup) {
    Scene scene;
    Texture sky;
    sky.kind = TextureKind::Image;
    sky.image = ImageTexture{.projection = ImageTexture::Projection::LatLong, .lookup = &lookup};
    scene.textures = {sky};
    scene.background.layers = {
        PlacedTexture{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}}};
    return scene;
}

TEST(SkySampler, SamplesAreSpreadByTheirDensity) {
    const SunnySky lookup;
    const Scene scene = scene_under(lookup);
    const SkySampler sky(scene, vec3(0, 1, 0));
    ASSERT_TRUE(sky.shines());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    // The mean of 1 / density is the sphere, and that of radiance / density the light of the sky.
    double sphere = 0, light = 0, even_light = 0;
    constexpr int kSamples = 40'000;
    for (int i = 0; i < kSamples; ++i) {
        const SkySample sample = sky.sample({unit(random), unit(random)});
        EXPECT_NEAR(glm::length(sample.direction), 1, 1e-12);
        EXPECT_NEAR(sky.density(sample.direction), sample.density, 1e-6 * sample.density);
        sphere += 1 / sample.density;
        light += background_color(scene, vec3(0, 1, 0), sample.direction).x / sample.density;
        const double z = 1 - 2 * (i + 0.5) / kSamples, r = std::sqrt(1 - z * z);
        const double phi = i * std::numbers::pi * (3 - std::sqrt(5.0));
        even_light +=
            background_color(scene, vec3(0, 1, 0), {r * std::cos(phi), r * std::sin(phi), z}).x;
    }
    const double all = 4 * std::numbers::pi;
    EXPECT_NEAR(sphere / kSamples, all, 0.05 * all);
    EXPECT_NEAR(light / kSamples, all * even_light / kSamples, 0.05 * light / kSamples);
    EXPECT_NEAR(sky.mean(), even_light / kSamples, 0.05 * sky.mean());
}

TEST(SkySampler, AGradientAloneIsLeftToPaths) {
    EXPECT_FALSE(SkySampler(Scene(), vec3(0, 1, 0)).shines());
    EXPECT_EQ(LightSampler(Scene(), vec3(0, 1, 0)).sky_density(dvec3(0, 1, 0)), 0);
}

TEST(SkySampler, LightOfTheSkyComesFromFarAway) {
    const SunnySky lookup;
    Scene scene = scene_under(lookup);
    scene.materials.emplace_back();
    scene.add_mesh("t", 0, Chunk::owning(dvec3(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    const LightSampler lights(scene, vec3(0, 1, 0));
    EXPECT_FALSE(lights.has_lights());
    const SurfacePoint surface =
        surface_point(scene, {{0.2, 0.2, 1}, 0, {0, 0, -1}}, {1, 0.2, 0.2, {0, 0}});
    const auto arriving = lights.sample(surface, 0.5, {0.4, 0.6});
    ASSERT_TRUE(arriving);
    EXPECT_TRUE(std::isinf(arriving->ray.t_max));
    EXPECT_EQ(arriving->number, kNone);
    EXPECT_NEAR(lights.sky_density(arriving->towards), arriving->density, 1e-6 * arriving->density);
}

} // namespace
} // namespace ovc
