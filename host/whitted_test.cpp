// SPDX-License-Identifier: Apache-2.0
// The batched renderer on a tiny scene with the CPU backend: shadows, mirrors, and the same pixels
// however it is cut.
#include "host/whitted_batched.h"

#include "host/backend.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {

static Chunk quad(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    return Chunk::owning(dvec3(0), {vec3(a), vec3(b), vec3(c), vec3(a), vec3(c), vec3(d)});
}

/// A red floor at y = 0, a small blocker above its middle, a mirror wall behind, a light overhead;
/// seen from the front.
static Scene room() {
    Scene scene;
    scene.materials = {{"red", {0.8f, 0.1f, 0.1f}, 0}, {"mirror", vec3(0.5f), 0.9f}};
    scene.add_mesh("floor", 0, quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}));
    scene.add_mesh("blocker", 0, quad({-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}));
    scene.add_mesh("wall", 1, quad({-4, 0, -4}, {4, 0, -4}, {4, 6, -4}, {-4, 6, -4}));
    scene.lights = {{{0, 8, 0}, vec3(3)}};
    return scene;
}

/// So narrow a view that its one pixel shows `target`.
static Camera towards(dvec3 target) {
    Camera camera;
    camera.eye = {0, 1.5, 9};
    camera.target = target;
    camera.fov_degrees = 0.01;
    return camera;
}

static Image render(const Scene& scene, const Camera& camera, WhittedOptions options = {},
                    uint32_t width = 1, uint32_t height = 1, RenderReport* report = nullptr) {
    Image image(width, height);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    const Result<RenderReport> done = render_batched(scene, camera, *backend, options, {}, image);
    EXPECT_TRUE(done && done->complete);
    if (report)
        *report = *done;
    return image;
}

static float red(const Scene& scene, dvec3 target, WhittedOptions options = {}) {
    return render(scene, towards(target), options).pixels[0].r;
}

TEST(WhittedBatched, CastsShadows) {
    const Scene scene = room();
    WhittedOptions unshadowed;
    unshadowed.shadows = false;
    EXPECT_LT(red(scene, {0, 0, 0}), red(scene, {3, 0, 0}));
    EXPECT_GT(red(scene, {0, 0, 0}, unshadowed), red(scene, {3, 0, 0}, unshadowed));
}

TEST(WhittedBatched, ASurfaceDoesNotShadowItselfNorDoesItsCopy) {
    Scene scene = room();
    const float alone = red(scene, {3, 0, 0});
    scene.add_mesh("floor again", 0, quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}));
    EXPECT_EQ(red(scene, {3, 0, 0}), alone);
}

TEST(WhittedBatched, MirrorsShowTheFloor) {
    const Scene scene = room();
    const dvec3 low_on_the_wall(2.5, 0.3, -4);
    const vec4 pixel = render(scene, towards(low_on_the_wall)).pixels[0];
    EXPECT_GT(pixel.r, 3 * pixel.b);
    WhittedOptions no_bounces;
    no_bounces.max_depth = 0;
    const vec4 plain = render(scene, towards(low_on_the_wall), no_bounces).pixels[0];
    EXPECT_LT(plain.r, plain.b); // grey, under a blue sky
}

TEST(WhittedBatched, ShowsTheBackgroundWhereNothingIs) {
    const Scene scene = room();
    const vec4 pixel = render(scene, towards({0, 300, -300})).pixels[0];
    EXPECT_GT(pixel.b, pixel.r);
    EXPECT_EQ(pixel.a, 1);
    const Scene empty;
    EXPECT_EQ(render(empty, Camera{}).pixels[0].a, 1);
}

TEST(WhittedBatched, CountsRays) {
    RenderReport report;
    render(room(), towards({3, 0, 0}), {}, 1, 1, &report);
    EXPECT_EQ(report.rays.primary, 1u);
    EXPECT_EQ(report.rays.shadow, 1u);
    EXPECT_EQ(report.rays.reflection, 0u);
}

TEST(WhittedBatched, EndsBetweenTwoMirrors) {
    Scene scene;
    scene.materials = {{"mirror", vec3(0.5f), 1}};
    scene.add_mesh("ahead", 0, quad({-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4}));
    scene.add_mesh("behind", 0, quad({-9, -9, 14}, {9, -9, 14}, {9, 9, 14}, {-9, 9, 14}));
    WhittedOptions options;
    options.max_depth = 7;
    RenderReport report;
    render(scene, towards({0, 1.5, 0}), options, 1, 1, &report);
    EXPECT_EQ(report.rays.reflection, 7u);
}

TEST(WhittedBatched, BatchSizeDoesNotChangeAPixel) {
    const Scene scene = room();
    Camera camera = towards({0, 1, 0});
    camera.fov_degrees = 50;
    const Image whole = render(scene, camera, {}, 67, 45);
    for (size_t batch : {1u, 7u, 64u, 1000u}) {
        WhittedOptions options;
        options.batch_rays = batch;
        EXPECT_EQ(difference(render(scene, camera, options, 67, 45), whole).differing, 0u) << batch;
    }
}

TEST(WhittedBatched, StopsWhenToldAndKeepsWhatItHas) {
    const Scene scene = room();
    Image image(16, 16);
    const std::unique_ptr<Backend> backend = make_cpu_backend(scene.soup);
    WhittedOptions options;
    options.batch_rays = 64;
    const auto after_two_batches = [](const RenderReport& report) {
        return report.rays.primary <= 128;
    };
    const Result<RenderReport> done =
        render_batched(scene, towards({0, 0, 0}), *backend, options, after_two_batches, image);
    ASSERT_TRUE(done);
    EXPECT_FALSE(done->complete);
    const size_t begun = size_t(std::count_if(image.pixels.begin(), image.pixels.end(),
                                              [](const vec4& p) { return p.a == 1; }));
    EXPECT_EQ(begun, 192u);
}

/// Answers nothing: what a lost device looks like.
class FailingBackend final : public Backend {
public:
    Result<Done> intersect(std::span<const Ray>, std::span<const TriangleId>,
                           std::span<Hit>) override {
        return Error{"the device was lost"};
    }
    Result<Done> occluded(std::span<const Ray>, std::span<const TriangleId>,
                          std::span<uint8_t>) override {
        return Error{"the device was lost"};
    }
    ovc_statistics statistics() const override { return {}; }
    std::string renderer() const override { return "none"; }
};

TEST(WhittedBatched, HandsOnTheBackendsError) {
    FailingBackend backend;
    Image image(2, 2);
    const Result<RenderReport> done = render_batched(room(), Camera{}, backend, {}, {}, image);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "the device was lost");
}

} // namespace ovc
