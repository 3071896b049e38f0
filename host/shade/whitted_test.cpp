// SPDX-License-Identifier: Apache-2.0
// Tests Whitted's integrator in the batched renderer, on a tiny scene with the CPU backend:
// shadows, mirrors, glass, and the same pixels however the picture is cut.
#include "host/shade/whitted.h"

#include "host/render/render.h"
#include "host/render/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

/// Returns a red floor at y = 0, a small blocker above its middle, a mirror wall behind and a light
/// overhead, to be seen from the front.
static Scene room() {
    Scene scene;
    scene.materials = {{"red", {0.8f, 0.1f, 0.1f}, 0}, {"mirror", vec3(0.5f), 0.9f}};
    scene.add_mesh("floor", 0, quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}));
    scene.add_mesh("blocker", 0, quad({-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}));
    scene.add_mesh("wall", 1, quad({-4, 0, -4}, {4, 0, -4}, {4, 6, -4}, {-4, 6, -4}));
    scene.lights = {{{0, 8, 0}, vec3(3)}};
    return scene;
}

/// Returns a camera with so narrow a view that its one pixel shows `target`.
static Camera towards(dvec3 target) {
    Camera camera;
    camera.eye = {0, 1.5, 9};
    camera.target = target;
    camera.fov_degrees = 0.01;
    return camera;
}

static Image render(const Scene& scene, const Camera& camera, RenderOptions options = {},
                    uint32_t width = 1, uint32_t height = 1, RenderReport* report = nullptr) {
    Film film(width, height);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Result<RenderReport> done = render_picture(scene, camera, *backend, options, {}, film);
    EXPECT_TRUE(done && done->complete);
    if (report)
        *report = *done;
    return film.image();
}

static float red(const Scene& scene, dvec3 target, RenderOptions options = {}) {
    return render(scene, towards(target), options).pixels[0].r;
}

TEST(Whitted, CastsShadows) {
    const Scene scene = room();
    RenderOptions unshadowed;
    unshadowed.shadows = false;
    EXPECT_LT(red(scene, {0, 0, 0}), red(scene, {3, 0, 0}));
    EXPECT_GT(red(scene, {0, 0, 0}, unshadowed), red(scene, {3, 0, 0}, unshadowed));
}

TEST(Whitted, ASurfaceDoesNotShadowItselfNorDoesItsCopy) {
    Scene scene = room();
    const float alone = red(scene, {3, 0, 0});
    scene.add_mesh("floor again", 0, quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}));
    EXPECT_EQ(red(scene, {3, 0, 0}), alone);
}

TEST(Whitted, MirrorsShowTheFloor) {
    const Scene scene = room();
    const dvec3 low_on_the_wall(2.5, 0.3, -4);
    const vec4 pixel = render(scene, towards(low_on_the_wall)).pixels[0];
    EXPECT_GT(pixel.r, 3 * pixel.b);
    RenderOptions no_bounces;
    no_bounces.max_depth = 0;
    const vec4 plain = render(scene, towards(low_on_the_wall), no_bounces).pixels[0];
    EXPECT_LT(plain.r, plain.b); // the wall is grey, under a blue sky
}

TEST(Whitted, ShowsTheBackgroundWhereNothingIs) {
    const Scene scene = room();
    const vec4 pixel = render(scene, towards({0, 300, -300})).pixels[0];
    EXPECT_GT(pixel.b, pixel.r);
    EXPECT_EQ(pixel.a, 1);
    const Scene empty;
    EXPECT_EQ(render(empty, Camera{}).pixels[0].a, 1);
}

TEST(Whitted, CountsRays) {
    RenderReport report;
    render(room(), towards({3, 0, 0}), {}, 1, 1, &report);
    EXPECT_EQ(report.rays.primary, 1u);
    EXPECT_EQ(report.rays.shadow, 1u);
    EXPECT_EQ(report.rays.reflection, 0u);
}

TEST(Whitted, EndsBetweenTwoMirrors) {
    Scene scene;
    scene.materials = {{"mirror", vec3(0.5f), 1}};
    scene.add_mesh("ahead", 0, quad({-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4}));
    scene.add_mesh("behind", 0, quad({-9, -9, 14}, {9, -9, 14}, {9, 9, 14}, {-9, 9, 14}));
    RenderOptions options;
    options.max_depth = 7;
    RenderReport report;
    render(scene, towards({0, 1.5, 0}), options, 1, 1, &report);
    EXPECT_EQ(report.rays.reflection, 7u);
}

/// Returns the room with a closed box of this material in front of the wall, which mirrors no more.
static Scene room_with_box(Material material) {
    Scene scene = room();
    scene.materials[1] = {"wall", {0.1f, 0.2f, 0.8f}, 0};
    add_box(scene, std::move(material), {-1, 0.5, 3}, {1, 2.5, 5});
    return scene;
}

static Camera at_the_box(double fov_degrees) {
    Camera camera = towards({0.2, 1.6, 4});
    camera.fov_degrees = fov_degrees;
    return camera;
}

TEST(Whitted, ClearGlassOfTheAirsIndexIsNotSeen) {
    Scene bare = room_with_box({});
    bare.meshes.resize(3);
    bare.soup.chunks.erase(bare.soup.chunks.begin() + 3, bare.soup.chunks.end());
    RenderOptions options;
    options.shadows = false;
    const Image without = render(bare, at_the_box(30), options, 61, 43);
    RenderReport report;
    for (const double ior : {1.0, 1 + 1e-12, 1 - 1e-12}) {
        const Scene scene = room_with_box({"glass", vec3(0), 0, 1, vec3(1), ior});
        const Image with = render(scene, at_the_box(30), options, 61, 43, &report);
        EXPECT_LT(difference(with, without).max, 1e-6) << ior;
        EXPECT_GT(report.rays.refraction, 61u);
    }
}

TEST(Whitted, TheFilterTintsEveryCrossing) {
    RenderOptions options;
    options.shadows = false;
    const vec4 clear =
        render(room_with_box({"glass", vec3(0), 0, 1, vec3(1), 1}), at_the_box(0.01), options)
            .pixels[0];
    const vec4 tinted =
        render(room_with_box({"glass", vec3(0), 0, 1, {1, 0.5f, 0}, 1}), at_the_box(0.01), options)
            .pixels[0];
    EXPECT_FLOAT_EQ(tinted.r, clear.r);
    EXPECT_FLOAT_EQ(tinted.g, 0.25f * clear.g);
    EXPECT_EQ(tinted.b, 0);
}

TEST(Whitted, LightThroughGlassIsDimmedAndTintedAtEveryCrossing) {
    Scene scene = room();
    scene.materials[0] = {"grey", vec3(0.5f), 0};
    const vec4 dark = render(scene, towards({0, 0, 0})).pixels[0];
    RenderOptions options;
    options.shadows = false;
    const vec4 lit = render(scene, towards({0, 0, 0}), options).pixels[0];
    // The blocker becomes two panes, one above the other.
    scene.materials.push_back({"pane", vec3(0), 0.1f, 0.5f, {1, 0.5f, 0}, 1.5});
    scene.meshes[1].material = 2;
    scene.add_mesh("pane", 2, quad({-1, 2.5, 1}, {1, 2.5, 1}, {1, 2.5, -1}, {-1, 2.5, -1}));
    RenderReport report;
    const vec4 through = render(scene, towards({0, 0, 0}), {}, 1, 1, &report).pixels[0];
    EXPECT_NEAR((through.r - dark.r) / (lit.r - dark.r), 0.25, 1e-5);
    EXPECT_NEAR((through.g - dark.g) / (lit.g - dark.g), 0.0625, 1e-5);
    EXPECT_NEAR(through.b, dark.b, 1e-6);
    EXPECT_EQ(report.rays.shadow, 3u) << "one for each stretch of the way";
}

/// Light under povray's panes with caustics 1, tilted by 15 and by 0 degrees, is 1.2102 and 2 times
/// that without.
TEST(Whitted, CausticsBrightenLightThatCrossesHeadOn) {
    Scene scene = room();
    scene.materials[0] = {"grey", vec3(0.5f), 0};
    scene.materials[0].finish = Finish{};
    scene.materials.push_back({"pane", vec3(0), 0, 1});
    scene.materials[2].finish = Finish{};
    const double h = 4 * std::tan(15 * std::numbers::pi / 180);
    for (const bool tilted : {false, true}) {
        const double up = tilted ? h : 0;
        scene.soup.chunks[1] =
            quad({-4, 3 - up, 4}, {4, 3 - up, 4}, {4, 3 + up, -4}, {-4, 3 + up, -4});
        scene.materials[2].caustics = 0;
        scene.meshes[1].material = 2;
        const float without = red(scene, {0, 0, 0});
        scene.materials[2].caustics = 1;
        EXPECT_NEAR(red(scene, {0, 0, 0}) / without, tilted ? 1.2102 : 2, 1e-3);
    }
}

/// The blocker hides a half of the points of the light from the floor, whose light has the strength
/// of the middle.
TEST(Whitted, AreaLightsShineFromTheirMiddleAndCastSoftShadows) {
    Scene scene = room();
    scene.materials[0] = {"grey", vec3(0.5f), 0};
    const float dark = red(scene, {0, 0, 0});
    RenderOptions options;
    options.shadows = false;
    const float lit = red(scene, {0, 0, 0}, options);
    Light half = scene.lights[0];
    half.color *= 0.5f;
    scene.lights = {half, half};
    scene.lights[1].shadow_offset = {40, 0, 0}; // past the blocker
    EXPECT_NEAR((red(scene, {0, 0, 0}) - dark) / (lit - dark), 0.5, 1e-5);
    scene.lights[1].shadow_offset = {0, -9, 0}; // below the floor
    EXPECT_NEAR(red(scene, {0, 0, 0}), dark, 1e-6);
}

/// Under an even sky of radiance L, a floor of color c and diffuse d sends out c d L. Of the light
/// that a wall of the same kind beside it takes from the sky, it gets a part back.
TEST(Whitted, RadiosityIsTheLightOfTheSkyAndOfOtherSurfaces) {
    Scene scene;
    scene.background.horizon = scene.background.zenith = vec3(0.5f);
    scene.materials = {{"white", vec3(0.8f)}};
    scene.materials[0].finish = Finish{.diffuse = 0.6f};
    scene.may_add_light = false;
    scene.add_mesh("floor", 0, quad({-99, 0, 99}, {99, 0, 99}, {99, 0, -99}, {-99, 0, -99}));
    EXPECT_EQ(red(scene, {0, 0, 0}), 0) << "there is no lamp";
    scene.radiosity = Radiosity{.bounces = 1};
    EXPECT_NEAR(red(scene, {0, 0, 0}), 0.8 * 0.6 * 0.5, 1e-5);
    scene.add_mesh("wall", 0, quad({-99, 0, -1}, {99, 0, -1}, {99, 99, -1}, {-99, 99, -1}));
    const float once = red(scene, {0, 0, 0});
    EXPECT_LT(once, 0.8 * 0.6 * 0.5);
    scene.radiosity->bounces = 3;
    const float thrice = red(scene, {0, 0, 0});
    EXPECT_GT(thrice, 1.05 * once);
    EXPECT_LT(thrice, 0.8 * 0.6 * 0.5);
    scene.radiosity->brightness = 2;
    EXPECT_GT(red(scene, {0, 0, 0}), 1.9 * thrice);
}

TEST(Whitted, GlassCountsReflectionsAndRefractions) {
    RenderReport report;
    const Scene scene = room_with_box({"glass", vec3(0), 0.25f, 0.75f, vec3(1), 1.5});
    RenderOptions options;
    options.max_depth = 1;
    render(scene, at_the_box(0.01), options, 1, 1, &report);
    EXPECT_EQ(report.rays.reflection, 1u);
    EXPECT_EQ(report.rays.refraction, 1u);
    options.max_depth = 2;
    render(scene, at_the_box(0.01), options, 1, 1, &report);
    EXPECT_EQ(report.rays.reflection, 2u) << "at the front, and inside at the back";
    EXPECT_EQ(report.rays.refraction, 2u);
}

TEST(Whitted, GlassInGlassBendsByBothIndices) {
    const auto picture = [](std::optional<double> ior_of_core) {
        Scene scene = room_with_box({"glass", vec3(0), 0, 1, vec3(1), 1.5});
        if (ior_of_core)
            add_box(scene, {"core", vec3(0), 0, 1, vec3(1), *ior_of_core}, {-0.3, 1.1, 3.8},
                    {0.4, 1.9, 4.5});
        Camera camera = at_the_box(20);
        camera.eye = {1, 2.5, 9};
        RenderOptions options;
        options.shadows = false;
        return render(scene, camera, options, 8, 8);
    };
    const Image alone = picture({});
    EXPECT_LT(difference(picture(1.5), alone).max, 1e-3) << "the same glass is not seen";
    EXPECT_GT(difference(picture(1), alone).max, 0.01) << "a bubble is";
}

TEST(Whitted, SolidsAreLeftInAnyOrder) {
    Solids solids;
    EXPECT_EQ(solids.innermost(), kNone);
    for (const uint32_t material : {1u, 2u, 3u})
        solids.enter(material);
    solids.leave(2);
    solids.leave(7);
    EXPECT_EQ(solids.innermost(), 3u);
    solids.leave(3);
    EXPECT_EQ(solids.innermost(), 1u);
    solids.leave(1);
    EXPECT_EQ(solids.innermost(), kNone);
}

TEST(Whitted, TotalReflectionKeepsAllTheLight) {
    // A ray inside a glass box of a great index never leaves, until the box shows its own color.
    Scene scene = room_with_box({"glass", {0, 1, 0}, 0, 1, vec3(1), 1e3});
    Camera camera = at_the_box(0.01);
    camera.eye = {0, 1.5, 4};
    camera.target = {0.3, 1.7, 4.4};
    RenderOptions options;
    options.max_depth = 50;
    RenderReport report;
    const vec4 pixel = render(scene, camera, options, 1, 1, &report).pixels[0];
    EXPECT_EQ(report.rays.reflection, 50u);
    EXPECT_EQ(report.rays.refraction, 0u);
    EXPECT_GT(pixel.g, 0.01f);
    EXPECT_EQ(pixel.r, 0);
}

/// As povray 3.7.0.10: what is behind a box that absorbs is dim, its inner side's own light is not.
TEST(Whitted, SolidsAbsorbWhatComesThroughThem) {
    Scene scene;
    Material tinted;
    tinted.transmission = 1;
    tinted.absorption = Absorption{.distance = 2, .power = 1000, .color = vec3(0.5f)};
    tinted.finish = Finish{};
    tinted.finish->diffuse = 0;
    tinted.finish->ambient = vec3(0.1f);
    tinted.color = vec3(1);
    add_box(scene, tinted, {-1, -1, -1}, {1, 1, 1});
    scene.may_add_light = false;
    scene.background = {vec3(0.5f), vec3(0.5f)};
    Camera camera;
    camera.eye = {0, 0, 9};
    camera.fov_degrees = 0.01;
    EXPECT_NEAR(render(scene, camera).pixels[0].r, 0.1 + 0.1 + 0.5 * std::exp(-0.5), 1e-4);
}

TEST(Whitted, ACameraDoesNotSeeTheWallItStandsOn) {
    Scene scene = room();
    scene.add_mesh("gate", 1, quad({-4, -4, 9}, {4, -4, 9}, {4, 6, 9}, {-4, 6, 9}));
    Camera camera = towards({3, 0, 0}); // its eye lies in the gate
    const float bare = render(room(), camera).pixels[0].r;
    EXPECT_NE(render(scene, camera).pixels[0].r, bare);
    camera.nearest = 1e-6;
    EXPECT_EQ(render(scene, camera).pixels[0].r, bare);
}

TEST(Whitted, BatchSizeDoesNotChangeAPixelThroughSplittingRays) {
    const Scene scene = room_with_box({"glass", vec3(0.2f), 0.45f, 0.5f, {1, 0.9f, 0.8f}, 1.5});
    RenderOptions options;
    options.max_depth = 12;
    RenderReport report;
    const Image whole = render(scene, at_the_box(30), options, 67, 45, &report);
    EXPECT_GT(report.rays.total(), 20u * 67 * 45 / 4);
    for (size_t batch : {1u, 7u, 64u, 1000u}) {
        options.batch_rays = batch;
        RenderReport again;
        EXPECT_EQ(
            difference(render(scene, at_the_box(30), options, 67, 45, &again), whole).differing, 0u)
            << batch;
        EXPECT_EQ(again.rays.total(), report.rays.total());
    }
}

/// Hands rays on to the CPU, and remembers the maximum that it got at once.
class CountingBackend final : public Backend {
public:
    explicit CountingBackend(const Soup& soup) : cpu_(make_cpu_backend(soup)) {}
    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        most = std::max(most, rays.size());
        return cpu_->intersect(rays, without, hits);
    }
    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        return cpu_->occluded(rays, without, occluded);
    }
    ovc_statistics statistics() const override { return {}; }
    std::string renderer() const override { return "none"; }

    size_t most = 0;

private:
    std::unique_ptr<Backend> cpu_;
};

TEST(Whitted, ABatchIsNeverLargerThanAsked) {
    const Scene scene = room_with_box({"glass", vec3(0), 0.45f, 0.55f, vec3(1), 1.5});
    CountingBackend backend(scene.soup);
    RenderOptions options;
    options.max_depth = 200;
    options.batch_rays = 400;
    Film film(64, 64);
    ASSERT_TRUE(render_picture(scene, at_the_box(8), backend, options, {}, film));
    EXPECT_EQ(backend.most, 400u);
}

TEST(Whitted, BatchSizeDoesNotChangeAPixel) {
    const Scene scene = room();
    Camera camera = towards({0, 1, 0});
    camera.fov_degrees = 50;
    const Image whole = render(scene, camera, {}, 67, 45);
    for (size_t batch : {1u, 7u, 64u, 1000u}) {
        RenderOptions options;
        options.batch_rays = batch;
        EXPECT_EQ(difference(render(scene, camera, options, 67, 45), whole).differing, 0u) << batch;
    }
}

TEST(Whitted, StopsWhenToldAndKeepsThePixelsThatAreDone) {
    const Scene scene = room();
    Camera camera = towards({0, 0, 0});
    camera.fov_degrees = 50;
    Film film(256, 256);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    RenderOptions options;
    options.batch_rays = 1000;
    const auto until_some_are_done = [](const RenderReport& report) {
        return report.pixels_done < 5000;
    };
    const Result<RenderReport> part =
        render_picture(scene, camera, *backend, options, until_some_are_done, film);
    ASSERT_TRUE(part);
    EXPECT_FALSE(part->complete);
    EXPECT_GE(part->pixels_done, 5000u);
    EXPECT_LT(part->pixels_done, 10000u);

    // Finished pixels have the colors of the whole picture; the rest can be rendered later.
    const Image whole = render(scene, camera, {}, 256, 256);
    Film rest(256, 256);
    uint64_t kept = 0;
    const Image half = film.image();
    for (uint32_t pixel = 0; pixel < 256 * 256; ++pixel) {
        if (!film.done(pixel)) {
            EXPECT_EQ(half.pixels[pixel], vec4(0));
            continue;
        }
        ++kept;
        EXPECT_EQ(half.pixels[pixel], whole.pixels[pixel]);
        rest.restore(pixel, film.sums(pixel));
    }
    EXPECT_EQ(kept, part->pixels_done);
    const Result<RenderReport> done = render_picture(scene, camera, *backend, options, {}, rest);
    ASSERT_TRUE(done && done->complete);
    EXPECT_EQ(done->rays.primary, 256 * 256 - kept);
    EXPECT_EQ(difference(rest.image(), whole).differing, 0u);
}

TEST(Whitted, SamplesSmoothEdgesAndAverageTheSameLight) {
    const Scene scene = room();
    Camera camera = towards({0, 0, 0});
    camera.fov_degrees = 50;
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    // The 16 samples of a pixel are stratified in 4 x 4, so their mean is near that of 16 pixels in
    // its place.
    Film film(32, 32, 16);
    const Result<RenderReport> done = render_picture(scene, camera, *backend, {}, {}, film);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->rays.primary, 32u * 32 * 16);
    const Image smooth = film.image();
    const Image fine = render(scene, camera, {}, 128, 128);
    double worst = 0, sum = 0;
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 32; ++x) {
            vec4 mean(0);
            for (uint32_t k = 0; k < 16; ++k)
                mean += fine.at(4 * x + k % 4, 4 * y + k / 4) / 16.0f;
            const double off = std::abs(double(mean.r - smooth.at(x, y).r));
            worst = std::max(worst, off);
            sum += off;
        }
    EXPECT_LT(worst, 0.25);
    EXPECT_LT(sum / (32 * 32), 0.004);
    EXPECT_GT(sum, 0);
}

/// Answers no ray, like a lost device.
class FailingBackend final : public Backend {
public:
    Result<Done> intersect(std::span<const Ray>, const Exclusions&, std::span<Hit>) override {
        return Error{"the device was lost"};
    }
    Result<Done> occluded(std::span<const Ray>, const Exclusions&, std::span<uint8_t>) override {
        return Error{"the device was lost"};
    }
    ovc_statistics statistics() const override { return {}; }
    std::string renderer() const override { return "none"; }
};

TEST(Whitted, HandsOnTheBackendsError) {
    FailingBackend backend;
    Film film(2, 2);
    const Result<RenderReport> done = render_picture(room(), Camera{}, backend, {}, {}, film);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "the device was lost");
}

} // namespace ovc
