// SPDX-License-Identifier: Apache-2.0
// The mixed renderer: the batched one's picture, the same bits in whatever order answers come, and
// fewer passes where memory is short.
#include "host/whitted_mixed.h"

#include "host/camera.h"
#include "host/scene_summary.h"
#include "host/whitted_batched.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

constexpr uint32_t kSide = 96;

/// A test scene, dressed for a picture.
class Shown {
public:
    explicit Shown(const char* name) : scene(std::move(*make_test_scene(name))) {
        camera = scene.camera ? *scene.camera
                              : framing_camera(hittable_bounds(scene.soup), kSide, kSide);
        scene.lights = placed_lights(scene.lights, camera);
    }
    Scene scene;
    Camera camera;
};

struct Picture {
    Image image{kSide, kSide};
    RenderReport report;
};

template <class Render>
Picture picture(Render&& render, const Shown& shown, Backend& backend) {
    Picture made;
    const Result<RenderReport> report =
        render(shown.scene, shown.camera, backend, WhittedOptions{}, {}, made.image);
    EXPECT_TRUE(report && report->complete);
    if (report)
        made.report = *report;
    return made;
}

void expect_same_bits(const Image& a, const Image& b) {
    size_t differing = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        differing += a.pixels[i] != b.pixels[i];
    EXPECT_EQ(differing, 0u);
}

TEST(WhittedMixed, IsTheBatchedPicture) {
    for (const char* name : {"mirrors", "glass", "city"}) {
        SCOPED_TRACE(name);
        const Shown shown(name);
        const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
        const Picture batched = picture(render_batched, shown, *cpu);
        const Picture mixed = picture(render_mixed, shown, *cpu);
        EXPECT_EQ(mixed.report.rays.primary, batched.report.rays.primary);
        EXPECT_EQ(mixed.report.rays.shadow, batched.report.rays.shadow);
        EXPECT_EQ(mixed.report.rays.reflection, batched.report.rays.reflection);
        EXPECT_EQ(mixed.report.rays.refraction, batched.report.rays.refraction);
        EXPECT_EQ(mixed.report.pixels_done, size_t(kSide) * kSide);
        for (size_t i = 0; i < mixed.image.pixels.size(); ++i)
            for (int channel = 0; channel < 4; ++channel)
                ASSERT_NEAR(mixed.image.pixels[i][channel], batched.image.pixels[i][channel], 2e-6)
                    << "pixel " << i;
    }
}

TEST(WhittedMixed, HasTheSameBitsUnderAnyBudgetAndMakesFewerPasses) {
    const Shown shown("mirrors");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    const Picture expected = picture(render_mixed, shown, *cpu);
    for (const uint64_t budget : {uint64_t(64) << 20, uint64_t(256) << 10}) {
        BackendOptions options;
        options.kind = BackendKind::TwoLevel;
        options.gpu_memory.bytes = budget;
        options.leaves = 12;
        const Result<std::unique_ptr<Backend>> gpu = make_backend(shown.scene.soup, options, {});
        if (!gpu)
            GTEST_SKIP() << gpu.error().message;
        expect_same_bits(picture(render_mixed, shown, **gpu).image, expected.image);
        const uint64_t mixed = (*gpu)->statistics().passes;
        picture(render_batched, shown, **gpu);
        EXPECT_LT(mixed, (*gpu)->statistics().passes - mixed);
    }
}

TEST(WhittedMixed, StopsWhenToldAndKeepsWhatItHas) {
    const Shown shown("mirrors");
    const std::unique_ptr<Backend> cpu = make_cpu_backend(shown.scene.soup);
    Image image(kSide, kSide);
    const Result<RenderReport> report = render_mixed(
        shown.scene, shown.camera, *cpu, {},
        [](const RenderReport& so_far) { return so_far.rays.shadow == 0; }, image);
    ASSERT_TRUE(report);
    EXPECT_FALSE(report->complete);
    EXPECT_EQ(image.pixels[0].a, 1);
}

} // namespace
} // namespace ovc
