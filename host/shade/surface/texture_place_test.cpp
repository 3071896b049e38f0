// SPDX-License-Identifier: Apache-2.0
// Textures on surfaces: where a hit looks them up, how large a part it sees, and what they change.
#include "host/shade/surface/texture_place.h"

#include "host/shade/shade.h"
#include "host/shade/surface/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ovc {
namespace {

/// Notes the area that it was asked for last; its color is s, t and 0.5.
class NotesArea final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        last = area;
        return {float(area.st.x), float(area.st.y), 0.5f, 1};
    }
    dvec2 size() const override { return dvec2(8); }
    bool has_opacity() const override { return false; }

    mutable PictureArea last;
};

Texture image_on_uv(const ImageLookup& lookup) {
    Texture texture;
    texture.kind = TextureKind::Image;
    texture.on_uv = true;
    texture.image = ImageTexture{.lookup = &lookup};
    return texture;
}

/// A triangle in the plane z = 0 whose u grows by 1 over 4 units of x, and v over 2 of y.
Scene textured_triangle(const ImageLookup& lookup) {
    Scene scene;
    scene.textures = {image_on_uv(lookup)};
    scene.materials.resize(1);
    scene.materials[0].texture =
        PlacedTexture{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}};
    const uint32_t mesh =
        scene.add_mesh("t", 0, Chunk::owning(dvec3(0), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
    scene.meshes[mesh].uv = {{0, 0}, {1, 0}, {0, 2}};
    return scene;
}

/// A ray that meets the triangle at (1, 1, 0), from `away` in direction `from`.
struct Look {
    Ray ray;
    Hit hit;
};

Look look_from(const dvec3& from, double away) {
    const dvec3 target(1, 1, 0);
    return {{target + away * from, 0, -from}, {away, 0.25, 0.25, {0, 0}}};
}

} // namespace

TEST(TexturePlace, InterpolatesTextureCoordinates) {
    const NotesArea lookup;
    const Scene scene = textured_triangle(lookup);
    const Look look = look_from({0, 0, 1}, 5);
    EXPECT_EQ(surface_point(scene, look.ray, look.hit).color, vec3(0.25f, 0.5f, 0.5f));
    EXPECT_EQ(lookup.last.side_a, dvec2(0)) << "without a cone it is a point";
}

TEST(TexturePlace, AConeSeesItsWidthAndMoreAlongAGrazingView) {
    const NotesArea lookup;
    const Scene scene = textured_triangle(lookup);
    for (const double degrees : {0.0, 30.0, 75.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const Look look = look_from({std::sin(angle), 0, std::cos(angle)}, 10);
        surface_point(scene, look.ray, look.hit, Cone{0.1f, 0.02f});
        const double width = 0.1 + 0.02 * 10; // of the cone at the hit
        const double along = width / std::cos(angle) / 4, across = width / 2;
        const PictureArea& area = lookup.last;
        const bool a_is_along_u = std::abs(area.side_a.x) > std::abs(area.side_a.y);
        const dvec2 u = a_is_along_u ? area.side_a : area.side_b;
        const dvec2 v = a_is_along_u ? area.side_b : area.side_a;
        if (degrees > 0) {
            EXPECT_NEAR(std::abs(u.x), along, 1e-6);
            EXPECT_NEAR(u.y, 0, 1e-6);
            EXPECT_NEAR(v.x, 0, 1e-6);
            EXPECT_NEAR(std::abs(v.y), across, 1e-6);
        }
        EXPECT_NEAR(std::abs(u.x * v.y - u.y * v.x), along * across, 1e-6) << "the area";
    }
}

TEST(TexturePlace, ConesAreNeededWhereMeansAreTaken) {
    Scene scene;
    EXPECT_FALSE(needs_cones(scene));
    scene.textures.resize(1);
    scene.textures[0].pattern.kind = Pattern::Kind::Checker;
    scene.materials.resize(1);
    EXPECT_FALSE(needs_cones(scene));
    scene.textures[0].pattern.kind = Pattern::Kind::Perlin;
    EXPECT_TRUE(needs_cones(scene));
    scene.textures[0] = {};
    scene.textures[0].kind = TextureKind::Image;
    EXPECT_TRUE(needs_cones(scene));
    scene.textures.clear();
    scene.materials[0].normal_map.emplace();
    EXPECT_TRUE(needs_cones(scene));
}

TEST(TexturePlace, ATextureTakesThePlaceOfDiffuseLightInPathTracing) {
    const NotesArea lookup;
    Scene scene = textured_triangle(lookup);
    scene.materials[0].optics = Optics{.diffuse = vec3(0.9f)};
    const Look look = look_from({0, 0, 1}, 5);
    const SurfacePoint surface = surface_point(scene, look.ray, look.hit);
    const vec3 seen = Bsdf(surface).evaluate(dvec3(0, 0, 1));
    EXPECT_LT(glm::length(seen - vec3(0.25f, 0.5f, 0.5f) * std::numbers::inv_pi_v<float>), 1e-6f);
}

/// A picture that is scaled or inverted may be brighter than white, or darker than black.
TEST(TexturePlace, ATextureSendsOnNoMoreLightThanArrives) {
    const NotesArea lookup;
    Scene scene = textured_triangle(lookup);
    scene.materials[0].optics = Optics{.diffuse = vec3(0.9f)};
    const Look look = look_from({0, 0, 1}, 5);
    for (const auto& [scale, expected] : {std::pair(3.0f, vec3(0.75f, 1, 1)), {-1.0f, vec3(0)}}) {
        scene.textures[0].image->scale = vec3(scale);
        EXPECT_EQ(optics_at(surface_point(scene, look.ray, look.hit)).diffuse, expected) << scale;
    }
}

TEST(TexturePlace, MapsChangeWhatTheyName) {
    const NotesArea lookup;
    Scene scene = textured_triangle(lookup);
    scene.textures.push_back({{}, {{0, {vec3(0.25f)}, kNoTexture}}});
    scene.materials[0].optics = Optics{.boundary = Optics::Boundary::Metal,
                                       .reflection = vec3(1),
                                       .width = 0.5f,
                                       .emission = vec3(4, 2, 0)};
    scene.materials[0].maps = MaterialMaps{.reflection = 1, .width = 1, .emission = 0};
    const Look look = look_from({0, 0, 1}, 5);
    SurfacePoint surface = surface_point(scene, look.ray, look.hit);
    EXPECT_EQ(surface.maps.gloss(), 0.25f);
    EXPECT_EQ(optics_at(surface).reflection, vec3(0.25f));
    EXPECT_EQ(optics_at(surface).width, 0.125f);
    EXPECT_EQ(optics_at(surface).emission, vec3(1, 1, 0));
    scene.materials[0].maps = MaterialMaps{.metallic = 1};
    surface = surface_point(scene, look.ray, look.hit);
    const vec3 base(0.25f, 0.5f, 0.5f);
    EXPECT_EQ(optics_at(surface).diffuse, 0.75f * base);
    EXPECT_LT(glm::length(optics_at(surface).reflection - (0.03f + 0.25f * base)), 1e-6f);
}

TEST(TexturePlace, ANormalMapTiltsBothSidesAlike) {
    class Slanted final : public ImageLookup {
    public:
        vec4 color(const PictureArea&) const override { return {0.75f, 0.5f, 1, 1}; }
        dvec2 size() const override { return dvec2(1); }
        bool has_opacity() const override { return false; }
    };
    const Slanted lookup;
    Scene scene = textured_triangle(lookup);
    scene.materials[0].normal_map = NormalMap{.kind = NormalMap::Kind::Tangent};
    const dvec3 tilted = glm::normalize(dvec3(0.5, 0, 1));
    const Look front = look_from({0, 0, 1}, 5), back = look_from({0, 0, -1}, 5);
    EXPECT_LT(glm::length(surface_point(scene, front.ray, front.hit).normal - tilted), 1e-9);
    EXPECT_LT(glm::length(surface_point(scene, back.ray, back.hit).normal + tilted), 1e-9);
}

} // namespace ovc
