// SPDX-License-Identifier: Apache-2.0
// Pictures of surfaces with holes: the same on every backend and after a way through a file; light
// goes through holes; and leaves that are cut out look as those that are modelled.
#include "host/camera/camera.h"
#include "host/camera/camera_rays.h"
#include "host/render/render.h"
#include "host/render/sight.h"
#include "host/render/test_shapes.h"
#include "importers/importer.h"
#include "importers/scene_file/scene_file.h"
#include "testscenes/plants/leaf_canopy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace ovc {
namespace {

constexpr uint32_t kCutoutSide = 64;

std::unique_ptr<Backend> two_level(const Scene& scene, uint64_t budget_bytes) {
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    options.gpu_memory.bytes = budget_bytes;
    options.leaves = 8;
    auto gpu = make_backend(scene.soup, options, {});
    return gpu ? std::move(*gpu) : nullptr;
}

Image drawn(const Scene& scene, Backend& backend, RenderOptions options = {},
            const Camera* camera = nullptr) {
    Film film(kCutoutSide, kCutoutSide);
    options.max_depth = 3;
    const auto done =
        render_picture(scene, camera ? *camera : *scene.camera, backend, options, {}, film);
    EXPECT_TRUE(done) << (done ? "" : done.error().message);
    return film.image();
}

uint64_t differing(const Image& a, const Image& b) {
    return difference(a, b).differing;
}

/// A floor that is lit from above through a wall of `opacity`, with a hole in its middle texel.
Scene holed(float opacity) {
    Scene scene;
    scene.materials = {{"white", vec3(1)}};
    scene.add_mesh("floor", 0, quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}));
    scene.add_mesh("wall", 0, quad({-2, 1, 2}, {2, 1, 2}, {2, 1, -2}, {-2, 1, -2}));
    Cutout cutout{.width = 3, .height = 3, .opacity = std::vector<uint8_t>(9, 255)};
    cutout.opacity[4] = 0;
    cutout.scale = opacity;
    scene.cutouts.push_back(std::move(cutout));
    scene.meshes[1].cutout = 0;
    scene.meshes[1].uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    scene.lights.push_back({dvec3(0, 100, 0), vec3(3)});
    scene.background = {vec3(0), vec3(0)};
    scene.camera = Camera{dvec3(0, 0.7, 1.9), dvec3(0, 0, 0.3), dvec3(0, 1, 0), 80};
    return scene;
}

TEST(CutoutPictures, AreTheSameOnEveryBackend) {
    LeafCanopy few{.leaves = 600, .texels = 64};
    Scene leaves = make_leaf_canopy(few);
    leaves.cutouts[0].smooth = true;
    leaves.cutouts[0].scale = 0.8f; // so that chance decides too
    const auto cpu = make_cpu_backend(leaves.soup);
    const Image expected = drawn(leaves, *cpu);
    RenderOptions mixed;
    mixed.mode = RenderMode::Mixed;
    RenderOptions small;
    small.batch_rays = 777;
    EXPECT_EQ(differing(drawn(leaves, *cpu, mixed), expected), 0u);
    EXPECT_EQ(differing(drawn(leaves, *cpu, small), expected), 0u);
    for (const uint64_t budget : {uint64_t(64) << 20, uint64_t(512) << 10}) {
        const auto gpu = two_level(leaves, budget);
        if (!gpu)
            GTEST_SKIP() << "no device";
        EXPECT_EQ(differing(drawn(leaves, *gpu), expected), 0u);
        EXPECT_EQ(differing(drawn(leaves, *gpu, mixed), expected), 0u);
        EXPECT_EQ(differing(drawn(leaves, *gpu, small), expected), 0u);
    }
}

TEST(CutoutPictures, LetLightThroughHoles) {
    const Scene scene = holed(1);
    const auto cpu = make_cpu_backend(scene.soup);
    RenderOptions shadowless, whole;
    shadowless.shadows = false;
    whole.cutouts = false;
    const Image lit = drawn(scene, *cpu, shadowless), holes = drawn(scene, *cpu),
                none = drawn(scene, *cpu, whole);
    uint64_t bright = 0, dark = 0;
    for (uint32_t y = kCutoutSide / 2; y < kCutoutSide; ++y)
        for (uint32_t x = 0; x < kCutoutSide; ++x) {
            EXPECT_NE(none.at(x, y), lit.at(x, y)) << "a wall without a hole shadows all";
            bright += holes.at(x, y) == lit.at(x, y);
            dark += holes.at(x, y) == none.at(x, y);
        }
    EXPECT_GT(bright, 100u);
    EXPECT_GT(dark, 100u);
    EXPECT_EQ(bright + dark, uint64_t(kCutoutSide) * kCutoutSide / 2);
}

TEST(CutoutPictures, OfShadowsAloneAreSeenWhole) {
    Scene scene = holed(1);
    std::swap(scene.meshes[1].cutout, scene.meshes[1].shadow_cutout);
    const auto cpu = make_cpu_backend(scene.soup);
    const Camera above{dvec3(0, 6, 0.01), dvec3(0), dvec3(0, 0, -1), 40};
    RenderOptions whole;
    whole.cutouts = false;
    EXPECT_EQ(differing(drawn(scene, *cpu, {}, &above), drawn(scene, *cpu, whole, &above)), 0u);
    EXPECT_NE(differing(drawn(scene, *cpu), drawn(scene, *cpu, whole)), 0u);
}

TEST(CutoutPictures, ComeBackFromAFile) {
    const auto path = std::filesystem::path(testing::TempDir()) / "overcast-cutouts.ovc";
    Scene scene = make_leaf_canopy({.leaves = 300, .texels = 32});
    scene.cutouts[0].scale = 0.7f;
    scene.show(1, kSeenInReflections);
    const Image before = drawn(scene, *make_cpu_backend(scene.soup));
    ASSERT_TRUE(save(scene, path));
    const Result<Scene> after = load(path);
    ASSERT_TRUE(after) << after.error().message;
    EXPECT_EQ(differing(drawn(*after, *make_cpu_backend(after->soup)), before), 0u);
    EXPECT_EQ(checksum_of(*after), checksum_of(scene));
    scene.cutouts[0].opacity[500] ^= 255;
    EXPECT_NE(checksum_of(*after), checksum_of(scene));
    std::filesystem::remove(path);
}

/// Returns the leaf that a hit is on; kNone for the trunks, the ground and nothing.
uint32_t leaf_of(const Hit& hit, uint32_t triangles) {
    return hit.id.mesh == 0 ? hit.id.prim / triangles : kNone;
}

TEST(CutoutPictures, OfLeavesAreThoseOfModelledLeaves) {
    constexpr uint32_t kTexels = 128, kPixels = 300;
    const Scene cut = make_leaf_canopy({.leaves = 4000, .texels = kTexels});
    const Scene modelled = make_leaf_canopy({.leaves = 4000, .as = LeafCanopy::Leaves::Modelled});
    const Camera camera{dvec3(0, 4, 6), dvec3(0, 5, 0), dvec3(0, 1, 0), 60};
    const Pinhole pinhole(camera, kPixels, kPixels);
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < kPixels * kPixels; ++i)
        rays.push_back(pinhole.ray(i % kPixels, i / kPixels));
    const Sight sight(cut);
    std::vector<uint32_t> room;
    Exclusions holes;
    holes.sieves = sight.of_camera(rays.size(), room);
    std::vector<Hit> found(rays.size()), expected(rays.size());
    ASSERT_TRUE(make_cpu_backend(cut.soup)->intersect(rays, holes, found));
    ASSERT_TRUE(make_cpu_backend(modelled.soup)->intersect(rays, {}, expected));
    uint32_t same = 0, others = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const uint32_t leaf = leaf_of(found[i], 2), wanted = leaf_of(expected[i], 22);
        if (leaf == wanted) {
            same += leaf != kNone;
            if (leaf != kNone) {
                EXPECT_NEAR(found[i].t, expected[i].t, 1e-4) << i;
            }
        } else {
            ++others;
        }
    }
    // The outline of a leaf passes through some 4 in 128 texels of a row, of which half are wrong
    // on average: 3 % of what is seen of leaves. Seen through many holes, a little more.
    EXPECT_GT(same, 30'000u);
    EXPECT_LT(others, same / 40);
    RenderOptions options;
    const Image a = drawn(cut, *make_cpu_backend(cut.soup), options, &camera);
    const Image b = drawn(modelled, *make_cpu_backend(modelled.soup), options, &camera);
    uint32_t unlike = 0; // modelled leaves bend a little, by the rounding of their corners
    for (size_t i = 0; i < a.pixels.size(); ++i)
        unlike += glm::length(a.pixels[i] - b.pixels[i]) > 0.01f;
    EXPECT_LT(unlike, kCutoutSide * kCutoutSide / 25);
}

} // namespace
} // namespace ovc
