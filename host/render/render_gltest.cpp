// SPDX-License-Identifier: Apache-2.0
// Tests that the batched and the mixed renderer make the same bits in whatever order answers come,
// and that mixed makes fewer passes where memory is short.
#include "host/render/render.h"

#include "core/system/parallel.h"
#include "host/camera/camera.h"
#include "host/scene/scene_summary.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <optional>

namespace ovc {
namespace {

constexpr uint32_t kRenderSide = 96;

/// A test scene with a camera and lights for a picture.
class Shown {
public:
    explicit Shown(const char* name) : scene(std::move(*make_test_scene(name))) {
        camera = scene.camera
                     ? *scene.camera
                     : framing_camera(hittable_bounds(scene.soup), kRenderSide, kRenderSide);
        scene.lights = placed_lights(scene, scene.lights, camera);
    }
    Scene scene;
    Camera camera;
};

struct Picture {
    Image image;
    RenderReport report;
};

Picture picture(RenderMode mode, const Shown& shown, Backend& backend, uint32_t samples = 1) {
    Film film(kRenderSide, kRenderSide, samples);
    RenderOptions options;
    options.mode = mode;
    const Result<RenderReport> report =
        render_picture(shown.scene, shown.camera, backend, options, {}, film);
    EXPECT_TRUE(report && report->complete);
    return {film.image(), report ? *report : RenderReport{}};
}

void expect_same_bits(const Image& a, const Image& b) {
    size_t differing = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        differing += a.pixels[i] != b.pixels[i];
    EXPECT_EQ(differing, 0u);
}

TEST(Modes, MakeTheSamePicture) {
    for (const char* name : {"mirrors", "glass", "leaf-canopy"}) {
        SCOPED_TRACE(name);
        const Shown shown(name);
        const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
        const Picture batched = picture(RenderMode::Batched, shown, *cpu, 2);
        const Picture mixed = picture(RenderMode::Mixed, shown, *cpu, 2);
        EXPECT_EQ(mixed.report.rays.primary, batched.report.rays.primary);
        EXPECT_EQ(mixed.report.rays.shadow, batched.report.rays.shadow);
        EXPECT_EQ(mixed.report.rays.reflection, batched.report.rays.reflection);
        EXPECT_EQ(mixed.report.rays.refraction, batched.report.rays.refraction);
        EXPECT_EQ(mixed.report.pixels_done, size_t(kRenderSide) * kRenderSide);
        EXPECT_EQ(batched.report.pixels_done, size_t(kRenderSide) * kRenderSide);
        expect_same_bits(mixed.image, batched.image);
    }
}

TEST(Modes, MakeTheSamePictureOnAnyNumberOfThreads) {
    const Shown shown("glass");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    const Image expected = picture(RenderMode::Batched, shown, *cpu).image;
    for (const size_t threads : {1, 3})
        for (const RenderMode mode : {RenderMode::Batched, RenderMode::Mixed}) {
            const ThreadLimit limit(threads);
            expect_same_bits(picture(mode, shown, *cpu).image, expected);
        }
}

TEST(Modes, MakeAPartOfThePicture) {
    const Shown shown("glass");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    const Image whole = picture(RenderMode::Batched, shown, *cpu).image;
    for (const RenderMode mode : {RenderMode::Batched, RenderMode::Mixed}) {
        RenderOptions options;
        options.mode = mode;
        options.part = {{kRenderSide, kRenderSide}, 17, 40, {60, 33}};
        Film film(60, 33);
        ASSERT_TRUE(render_picture(shown.scene, shown.camera, *cpu, options, {}, film));
        const Image part = film.image();
        for (uint32_t y = 0; y < 33; ++y)
            for (uint32_t x = 0; x < 60; ++x)
                ASSERT_EQ(part.at(x, y), whole.at(17 + x, 40 + y));
    }
}

TEST(Modes, HaveTheSameBitsUnderAnyBudgetAndMixedMakesFewerPasses) {
    const Shown shown("mirrors");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    const Picture expected = picture(RenderMode::Mixed, shown, *cpu);
    for (const uint64_t budget : {uint64_t(64) << 20, uint64_t(256) << 10}) {
        BackendOptions options;
        options.kind = BackendKind::TwoLevel;
        options.gpu_memory.bytes = budget;
        options.leaves = 12;
        const Result<std::unique_ptr<Backend>> gpu = make_backend(shown.scene.soup, options, {});
        if (!gpu)
            GTEST_SKIP() << gpu.error().message;
        expect_same_bits(picture(RenderMode::Mixed, shown, **gpu).image, expected.image);
        const uint64_t mixed = (*gpu)->statistics().passes;
        expect_same_bits(picture(RenderMode::Batched, shown, **gpu).image, expected.image);
        EXPECT_LT(mixed, (*gpu)->statistics().passes - mixed);
    }
}

TEST(Modes, MoveTheSamePagesInEveryRun) {
    const Shown shown("glass");
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    options.leaves = 12;
    for (const RenderMode mode : {RenderMode::Batched, RenderMode::Mixed}) {
        std::optional<ovc_statistics> first;
        for (int run = 0; run < 4; ++run) {
            options.gpu_memory.bytes = 1 << 19;
            const auto gpu = make_backend(shown.scene.soup, options, {});
            if (!gpu)
                GTEST_SKIP() << gpu.error().message;
            EXPECT_TRUE((*gpu)->moves_pages());
            const uint64_t at_first = (*gpu)->statistics().bytes_in;
            picture(mode, shown, **gpu);
            const ovc_statistics now = (*gpu)->statistics();
            EXPECT_GT(now.bytes_in, at_first);
            if (!first)
                first = now;
            EXPECT_EQ(now.bytes_in, first->bytes_in);
            EXPECT_EQ(now.passes, first->passes);
            EXPECT_EQ(now.ray_visits, first->ray_visits);
        }
    }
    options.gpu_memory = {};
    const auto whole = make_backend(shown.scene.soup, options, {});
    ASSERT_TRUE(whole);
    EXPECT_FALSE((*whole)->moves_pages());
    EXPECT_FALSE(make_cpu_backend(shown.scene.soup)->moves_pages());
}

TEST(Modes, MixedStopsWhenToldAndKeepsThePixelsThatAreDone) {
    const Shown shown("mirrors");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    Film film(kRenderSide, kRenderSide);
    RenderOptions options;
    options.mode = RenderMode::Mixed;
    const Result<RenderReport> report = render_picture(
        shown.scene, shown.camera, *cpu, options,
        [](const RenderReport& so_far) { return so_far.rays.shadow == 0; }, film);
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->complete);
    const Image image = film.image();
    const Image whole = picture(RenderMode::Mixed, shown, *cpu).image;
    for (uint32_t pixel = 0; pixel < kRenderSide * kRenderSide; ++pixel)
        EXPECT_EQ(image.pixels[pixel], film.done(pixel) ? whole.pixels[pixel] : vec4(0));
}

} // namespace
} // namespace ovc
