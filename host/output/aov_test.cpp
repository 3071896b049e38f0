// SPDX-License-Identifier: Apache-2.0
// Tests the words of --aov, and that the layers of a file tell the hits of the camera's rays.
#include "host/output/aov.h"

#include "core/exact/triangle.h"
#include "host/camera/camera.h"
#include "tests/temp_folder.h"
#include "testscenes/catalog.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

namespace ovc {
namespace {

constexpr uint32_t kLayerWidth = 40, kLayerHeight = 30;

std::string error_of(std::string_view text) {
    const Result<Aovs> aovs = parse_aovs(text);
    return aovs ? "" : aovs.error().message;
}

TEST(Aovs, AreNamedInAnyOrderOnceEach) {
    const Result<Aovs> aovs = parse_aovs("id,depth");
    ASSERT_TRUE(aovs);
    EXPECT_TRUE(aovs->id && aovs->depth && !aovs->normal && !aovs->leaf && !aovs->passes);
    EXPECT_TRUE(parse_aovs("leaf,passes")->leaf);
    EXPECT_TRUE(parse_aovs("flagged")->flagged);
    EXPECT_EQ(error_of("depth,depth"), "--aov: depth is given twice");
    EXPECT_NE(error_of("norml").find("did you mean 'normal'"), std::string::npos)
        << error_of("norml");
    EXPECT_NE(error_of(""), "");
    EXPECT_NE(error_of("depth,"), "");
}

/// Returns one channel of a file, without conversion.
std::vector<uint32_t> channel(const std::string& path, const char* name, Imf::PixelType type) {
    Imf::InputFile file(path.c_str());
    const Imf::Channel* found = file.header().channels().findChannel(name);
    EXPECT_TRUE(found && found->type == type) << name;
    std::vector<uint32_t> words(size_t(kLayerWidth) * kLayerHeight);
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(words.data()), sizeof(uint32_t),
                                  sizeof(uint32_t) * kLayerWidth));
    file.setFrameBuffer(frame);
    file.readPixels(0, int(kLayerHeight) - 1);
    return words;
}

TEST(Aovs, OfAFileAreWhatEachPixelsRayHits) {
    const Result<Scene> scene = make_test_scene("box");
    ASSERT_TRUE(scene);
    const Camera camera = scene->camera.value_or(Camera{dvec3(3, 2, 6), dvec3(0)});
    const auto backend = make_cpu_backend(scene->soup);
    Aovs aovs{.depth = true, .normal = true, .id = true};
    const auto layers = trace_aovs(*scene, Pinhole(camera, kLayerWidth, kLayerHeight),
                                   Sight(*scene), *backend, aovs);
    ASSERT_TRUE(layers);
    ASSERT_EQ(layers->size(), 6u);
    const test::TempFolder folder;
    const std::string path = (folder / "aov.exr").string();
    ASSERT_TRUE(save_image(Image(kLayerWidth, kLayerHeight), path, {.layers = *layers}));
    const auto depth = channel(path, "depth.Z", Imf::FLOAT);
    const auto mesh = channel(path, "id.mesh", Imf::UINT),
               prim = channel(path, "id.prim", Imf::UINT);
    const std::vector<uint32_t> normal[3] = {channel(path, "normal.X", Imf::FLOAT),
                                             channel(path, "normal.Y", Imf::FLOAT),
                                             channel(path, "normal.Z", Imf::FLOAT)};

    const Pinhole pinhole(camera, kLayerWidth, kLayerHeight);
    size_t hit = 0, missed = 0;
    for (uint32_t i = 0; i < kLayerWidth * kLayerHeight; ++i) {
        const Ray ray = pinhole.ray(i % kLayerWidth, i / kLayerWidth);
        // We ask each triangle of the scene: the nearest must be the one that is named.
        const PreparedRay prepared(ray);
        Nearest offered(prepared);
        for (uint32_t m = 0; m < scene->soup.chunks.size(); ++m)
            for (uint32_t p = 0; p < scene->soup.chunks[m].size(); ++p)
                offered.offer(scene->soup.triangle({m, p}), {m, p});
        const double nearest = offered.hit().t;
        const TriangleId id = offered.hit().id;
        EXPECT_EQ(mesh[i], id.mesh) << i;
        EXPECT_EQ(prim[i], id.prim) << i;
        EXPECT_EQ(std::bit_cast<float>(depth[i]), float(nearest)) << i;
        dvec3 n;
        for (int axis = 0; axis < 3; ++axis)
            n[axis] = double(std::bit_cast<float>(normal[axis][i]));
        if (std::isinf(nearest)) {
            ++missed;
            EXPECT_EQ(n, dvec3(0));
            continue;
        }
        ++hit;
        const Triangle t = scene->soup.triangle(id);
        EXPECT_NEAR(glm::length(n), 1, 1e-6);
        EXPECT_LT(glm::dot(n, ray.dir), 0) << "towards the eye";
        EXPECT_NEAR(glm::dot(n, glm::normalize(t[1] - t[0])), 0, 1e-6);
        EXPECT_NEAR(glm::dot(n, glm::normalize(t[2] - t[0])), 0, 1e-6);
    }
    EXPECT_GT(hit, 100u);
    EXPECT_GT(missed, 0u);
}

std::vector<float> floats(const Layer& layer) {
    std::vector<float> values;
    for (const uint32_t word : layer.values)
        values.push_back(std::bit_cast<float>(word));
    return values;
}

/// A white square that covers the left half of a picture, and a green mirror that covers a quarter;
/// the rest is sky. An edge goes through the middle of pixels.
TEST(Aovs, AlbedosAreThoseOfSurfacesAndMeansOverTheSamplesOfAPixel) {
    Scene scene;
    Material white, mirror;
    white.color = {0.5f, 0.6f, 0.7f};
    mirror.optics = Optics{.boundary = Optics::Boundary::Mirror, .reflection = {0, 0.9f, 0.1f}};
    scene.materials = {white, mirror};
    const auto square = [](double left, double right, double bottom, double top) {
        const vec3 a(left, bottom, 0), b(right, bottom, 0), c(right, top, 0), d(left, top, 0);
        return Chunk::owning(dvec3(0), {a, b, c, a, c, d});
    };
    scene.add_mesh("white", 0, square(-2, 0.5, -2, 2));
    scene.add_mesh("mirror", 1, square(0.5, 9, 0, 9));
    Camera camera; // 4 x 4 pixels of size 1
    camera.window = ImageWindow{{0, 0, -1}, {4, 0, 0}, {0, 4, 0}, /* orthographic= */ true};
    camera.eye = {0, 0, 3};
    const auto backend = make_cpu_backend(scene.soup);
    for (const uint32_t samples : {1u, 16u, 64u}) {
        const auto layers = trace_aovs(scene, Pinhole(camera, 4, 4), Sight(scene), *backend,
                                       {.depth = true, .normal = true, .albedo = true}, samples);
        ASSERT_TRUE(layers);
        ASSERT_EQ(layers->size(), 7u);
        EXPECT_EQ((*layers)[5].name, "albedo.G");
        const std::vector<float> green = floats((*layers)[5]), z = floats((*layers)[3]);
        EXPECT_FLOAT_EQ(green[0], 0.6f);
        EXPECT_FLOAT_EQ(green[3], 0.9f);
        EXPECT_FLOAT_EQ(green[15], 1) << "the sky";
        EXPECT_FLOAT_EQ(z[0], 1);
        EXPECT_EQ(z[15], 0);
        // Half of the pixel at (2, 3) is white; a single ray meets the edge itself.
        if (samples > 1) {
            EXPECT_FLOAT_EQ(green[14], 0.8f);
            EXPECT_FLOAT_EQ(z[14], 0.5f) << "shorter than a normal";
        }
        EXPECT_FLOAT_EQ(floats((*layers)[0])[0], 3) << "the depth of the middle";
    }
}

TEST(Aovs, LeafAndPassesAreRefusedByABackendWithoutLeaves) {
    const Result<Scene> scene = make_test_scene("box");
    ASSERT_TRUE(scene);
    const auto backend = make_cpu_backend(scene->soup);
    Aovs aovs;
    aovs.passes = true;
    const auto layers = trace_aovs(*scene, Pinhole(Camera{dvec3(3, 2, 6), dvec3(0)}, 4, 4),
                                   Sight(*scene), *backend, aovs);
    ASSERT_FALSE(layers);
    EXPECT_EQ(layers.error().message,
              "leaf, passes and flagged can be told by --backend two-level alone");
}

} // namespace
} // namespace ovc
