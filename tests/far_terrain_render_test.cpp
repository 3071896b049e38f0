// SPDX-License-Identifier: Apache-2.0
// Tests the picture of far-terrain, 1e7 m wide with 1 mm detail at the far corner where the camera
// stands. No background shows through the ground, and each pixel shows the triangle that the
// reference finds.
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/render/render.h"
#include "host/suites/stability/terrain_rays.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {
namespace {

constexpr uint32_t kWidth = 400, kHeight = 300;

/// Returns a scene with black ground under a bright sky.
Scene black_terrain() {
    Result<Scene> scene = make_test_scene("far-terrain");
    for (Material& material : scene->materials)
        material.color = vec3(0);
    return std::move(*scene);
}

class FarTerrainPicture : public testing::TestWithParam<ovc_kernel> {
protected:
    Result<std::unique_ptr<Backend>> backend() const {
        BackendOptions options;
        options.kind = BackendKind::TwoLevel;
        options.kernel = GetParam();
        options.leaves = 100; // This makes many borders.
        return make_backend(scene_.soup, options, {});
    }

    const Scene scene_ = black_terrain();
    const Pinhole pinhole_{*scene_.camera, kWidth, kHeight};
};

TEST_P(FarTerrainPicture, HasNoBackgroundBelowTheHorizon) {
    const auto two_level = backend();
    if (!two_level)
        GTEST_SKIP() << two_level.error().message;
    Box bounds;
    hittable_triangles(scene_.soup, nullptr, &bounds);
    Film film(kWidth, kHeight);
    const auto observe = [](const RenderReport&) { return true; };
    ASSERT_TRUE(render_picture(scene_, *scene_.camera, **two_level, {}, observe, film));
    const Image image = film.image();
    uint64_t ground = 0, sky = 0, cracks = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const bool is_sky = vec3(image.at(x, y)) != vec3(0);
            const bool below = must_hit_ground(pinhole_.ray(x, y), bounds);
            ASSERT_EQ(image.at(x, y).w, 1);
            ground += below;
            sky += is_sky;
            cracks += below && is_sky;
        }
    EXPECT_EQ(cracks, 0u);
    EXPECT_GT(ground, kWidth * kHeight / 2);
    EXPECT_GT(sky, kWidth * kHeight / 4);
}

TEST_P(FarTerrainPicture, IsTheReferences) {
    const auto two_level = backend();
    if (!two_level)
        GTEST_SKIP() << two_level.error().message;
    std::vector<Ray> rays;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            rays.push_back(pinhole_.ray(x, y));
    std::vector<Hit> expected(rays.size()), found(rays.size());
    ASSERT_TRUE(make_cpu_backend(scene_.soup)->intersect(rays, {}, expected));
    ASSERT_TRUE((*two_level)->intersect(rays, {}, found));
    uint64_t wrong = 0;
    std::vector<bool> seen(scene_.soup.chunks.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        wrong += expected[i].id != found[i].id || expected[i].t != found[i].t;
        if (found[i].is_hit())
            seen[found[i].id.mesh] = true;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(std::ranges::count(seen, true), 8) << "rings from millimetres to kilometres";
}

INSTANTIATE_TEST_SUITE_P(Kernels, FarTerrainPicture,
                         testing::Values(OVC_KERNEL_FRAGMENT, OVC_KERNEL_COMPUTE),
                         [](const auto& kernel) {
                             return kernel.param == OVC_KERNEL_COMPUTE ? "Compute" : "Fragment";
                         });

} // namespace
} // namespace ovc
