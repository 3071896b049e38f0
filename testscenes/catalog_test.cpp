// SPDX-License-Identifier: Apache-2.0
// The catalog: every scene builds, is the same everywhere, and is what its description says.
#include "testscenes/catalog.h"
#include "testscenes/closed_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <ostream>
#include <stdexcept>
#include <string>

namespace ovc {
namespace {

Scene make(const std::string& name) {
    Result<Scene> scene = make_test_scene(name);
    if (!scene)
        throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

/// FNV-1a over 32-bit words: all corners, origins, transforms, holes, and which material a mesh
/// has.
class Hash {
public:
    void add(uint32_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }
    void add(double value) {
        const uint64_t bits = std::bit_cast<uint64_t>(value);
        add(uint32_t(bits));
        add(uint32_t(bits >> 32));
    }
    uint64_t value() const { return value_; }

private:
    uint64_t value_ = 0xcbf29ce484222325u;
};

uint64_t hash(const Scene& scene) {
    Hash h;
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const Chunk& chunk = scene.soup.chunks[m];
        h.add(scene.meshes[m].material);
        for (int axis = 0; axis < 3; ++axis)
            h.add(chunk.origin()[axis]);
        if (const Transform* transform = chunk.transform())
            for (const auto& row : transform->rows)
                for (const double entry : row)
                    h.add(entry);
        for (const vec3& corner : chunk.corners())
            for (int axis = 0; axis < 3; ++axis)
                h.add(std::bit_cast<uint32_t>(corner[axis]));
        for (const vec2& uv : scene.meshes[m].uv)
            for (int axis = 0; axis < 2; ++axis)
                h.add(std::bit_cast<uint32_t>(uv[axis]));
    }
    for (const Cutout& cutout : scene.cutouts)
        for (const uint8_t opacity : cutout.opacity)
            h.add(uint32_t(opacity));
    return h.value();
}

struct Sample {
    const char* name;
    uint64_t triangles;
    uint64_t hash; // a change is a change of the scene: every picture and measurement of it is new
};

/// Each entry of the catalog at its smallest or a small size.
constexpr Sample kSamples[] = {
    {"dragons-1", 1076214, 0x81c164dedf8f8247},
    {"powerplant-200000", 200000, 0x5f58e50b18c9f4fb},
    {"powerplant-600001", 600000, 0x659dcaf242efec1},
    {"plants-1", 175221, 0x8743bc96b3d823e4},
    {"terrain-1", 2, 0x952ac25a51d027d8},
    {"terrain-64", 8192, 0x572b4fee2859fa98},
    {"landscape-1", 1000000, 0x3a3caac62fe79bcb},
    {"sphere-0", 20, 0xde27547eb5d06a37},
    {"sphere-3", 1280, 0x89338c6c67343787},
    {"knot", 873600, 0x82ea6ba2d992ff19},
    {"soup-1", 1000, 0x7dd5499d4622b217},
    {"city", 717978, 0xd52fceda6866f325},
    {"mirrors", 81922, 0x6d08983876b79f76},
    {"glass", 41472, 0x13ff34bdbb2f366b},
    {"box", 30, 0xa3188fbfd523c5bc},
    {"far-terrain", 274160, 0xba45980e69015acb},
    {"leaf-canopy", 200302, 0xb59ed3aa7c50d328},
    {"leaf-canopy-modelled", 2200302, 0xff5776582d194cd6},
    {"cloth", 131082, 0xc3e65f48f8642c0a},
    {"grass-in-wind", 1377002, 0x5263c31d742c9cd0},
};

/// GoogleTest prints this in the names of failing tests.
void PrintTo(const Sample& sample, std::ostream* out) {
    *out << sample.name;
}

class CatalogScene : public testing::TestWithParam<Sample> {};

TEST_P(CatalogScene, IsTheSameOnEveryMachine) {
    const Scene scene = make(GetParam().name);
    EXPECT_EQ(scene.soup.triangle_count(), GetParam().triangles);
    const uint64_t found = hash(scene);
    EXPECT_EQ(found, GetParam().hash) << "now 0x" << std::hex << found;
}

TEST_P(CatalogScene, IsTheSameForAnyNumberOfThreads) {
    // The test before has made it with as many threads as there are.
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(hash(make(GetParam().name)), GetParam().hash);
}

TEST_P(CatalogScene, HasNoTriangleThatCannotBeHit) {
    const Scene scene = make(GetParam().name);
    Dropped dropped;
    hittable_triangles(scene.soup, &dropped, nullptr);
    EXPECT_EQ(dropped.not_finite, 0u);
    EXPECT_EQ(dropped.degenerate, 0u);
}

TEST_P(CatalogScene, IsReadyToRender) {
    const Scene scene = make(GetParam().name);
    EXPECT_EQ(scene.name, GetParam().name);
    ASSERT_EQ(scene.meshes.size(), scene.soup.chunks.size());
    ASSERT_TRUE(scene.camera);
    EXPECT_FALSE(scene.lights.empty());
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        EXPECT_GT(scene.soup.chunks[m].size(), 0u) << scene.meshes[m].name;
        ASSERT_LT(scene.meshes[m].material, scene.materials.size());
    }
    for (const Material& material : scene.materials)
        for (const float share :
             {material.color.x, material.color.y, material.color.z, material.mirror,
              material.transmission, 1 - material.mirror - material.transmission}) {
            EXPECT_GE(share, 0) << material.name;
            EXPECT_LE(share, 1) << material.name;
        }
}

INSTANTIATE_TEST_SUITE_P(All, CatalogScene, testing::ValuesIn(kSamples), [](const auto& sample) {
    std::string name = sample.param.name;
    std::erase(name, '-');
    return name;
});

TEST(Catalog, HasASampleOfEveryEntryHere) {
    for (const CatalogEntry& entry : catalog()) {
        if (entry.name == "plants" || entry.name == "powerplant" || entry.name == "dragonball" ||
            entry.name.starts_with("fractal"))
            continue; // large: each has a test of its own
        const std::string_view stem =
            entry.name.ends_with("-N") ? entry.name.substr(0, entry.name.size() - 1) : entry.name;
        const auto is_sample = [&](const Sample& s) {
            return std::string_view(s.name).starts_with(stem);
        };
        EXPECT_TRUE(std::ranges::any_of(kSamples, is_sample)) << entry.name;
        EXPECT_FALSE(entry.description.empty()) << entry.name;
    }
}

TEST(Catalog, CountsAreThoseItsDescriptionsName) {
    EXPECT_EQ(make("terrain-100").soup.triangle_count(), 20000u);
    EXPECT_EQ(make("sphere-4").soup.triangle_count(), 5120u);
    EXPECT_EQ(make("knot").soup.triangle_count(), 873600u);
    EXPECT_EQ(make("soup-7").soup.triangle_count(), 7000u);
    EXPECT_EQ(make("mirrors").soup.triangle_count(), 81922u);
    EXPECT_EQ(make("glass").soup.triangle_count(), 41472u);
    EXPECT_EQ(make("box").soup.triangle_count(), 30u);
    EXPECT_NEAR(double(make("city").soup.triangle_count()), 718000, 5000);
}

TEST(Catalog, CountsAreThoseOfTheThesis) {
    EXPECT_EQ(make("dragons-2").soup.triangle_count(), 1'947'628u);
    EXPECT_EQ(make("dragons-21").soup.triangle_count(), 18'504'494u);
    EXPECT_EQ(make("powerplant").soup.triangle_count(), 12'748'510u);
    EXPECT_EQ(make("powerplant").lights.size(), 6u);
}

TEST(Catalog, TheFractalIsOneMeshInManyPlaces) {
    const Scene scene = make("fractal");
    EXPECT_EQ(scene.soup.chunks.size(), 25'250u);
    EXPECT_EQ(scene.soup.triangle_count(), 753'662'000u);
    EXPECT_EQ(make("fractal-10").soup.triangle_count(), 298'480u);
    for (const Chunk& chunk : scene.soup.chunks)
        ASSERT_TRUE(chunk.mesh_key() == scene.soup.chunks.front().mesh_key() && chunk.transform());
    for (uint32_t prim = 0; prim < scene.soup.chunks.front().size(); ++prim)
        for (const uint32_t ball : {0u, 7u, 25'249u})
            ASSERT_EQ(triangle_fault(scene.soup.triangle({ball, prim})), TriangleFault::None);
}

TEST(Catalog, APathHasTheFramesThatItsEntryNames) {
    for (const CatalogEntry& entry : catalog()) {
        std::string name(entry.name);
        if (name.ends_with("-N"))
            name.replace(name.size() - 1, 1, name.starts_with("powerplant") ? "200000" : "7");
        const Result<CameraPath> path = test_scene_path(name);
        EXPECT_EQ(path ? path->size() : 0, entry.frames) << name;
    }
    EXPECT_EQ(test_scene_path("box").error().message,
              "the test scene box has no camera path of its own");
    EXPECT_EQ(test_scene_path("dragons-22").error().message,
              "test scene \"dragons-22\": the N of dragons-N must be from 1 to 21");
    EXPECT_FALSE(test_scene_path("nothing"));
}

TEST(Catalog, APathGoesWithoutJumps) {
    for (const char* name :
         {"dragons-1", "dragons-21", "dragonball", "plants", "powerplant", "powerplant-200000"}) {
        const CameraPath path = *test_scene_path(name);
        double length = 0, longest = 0;
        for (size_t i = 0; i < path.size(); ++i) {
            EXPECT_TRUE(is_finite(path[i].eye) && is_finite(path[i].target)) << name << " " << i;
            EXPECT_GT(glm::length(path[i].target - path[i].eye), 0.5) << name << " " << i;
            const double step = i > 0 ? glm::length(path[i].eye - path[i - 1].eye) : 0;
            length += step;
            longest = std::max(longest, step);
        }
        EXPECT_LT(longest, 6 * length / double(path.size())) << name;
    }
}

TEST(Catalog, PlantsGrowWithTheirSize) {
    uint64_t before = 0;
    for (const int size : {1, 4, 16}) {
        const uint64_t count = make("plants-" + std::to_string(size)).soup.triangle_count();
        EXPECT_GT(count, before);
        EXPECT_GT(double(count), 0.5e5 * size) << size;
        EXPECT_LT(double(count), 2e5 * size) << size;
        before = count;
    }
}

TEST(Catalog, PlantsIsLargeAndWhole) {
    const Scene scene = make("plants");
    EXPECT_GE(scene.soup.triangle_count(), 5'000'000u);
    EXPECT_LE(scene.soup.triangle_count(), 8'000'000u);
    Dropped dropped;
    hittable_triangles(scene.soup, &dropped, nullptr);
    EXPECT_EQ(dropped.total(), 0u);
    const auto is_mirror = [](const Material& m) { return m.mirror > 0.5f; };
    EXPECT_TRUE(std::ranges::any_of(scene.materials, is_mirror)) << "the water";
}

// --- closed surfaces --------------------------------------------------------------------------

TEST(ClosedScenes, EveryEdgeIsMetOnceInEachDirection) {
    for (const char* name : {"sphere-0", "sphere-1", "sphere-5", "knot"}) {
        const Scene scene = make(name);
        ASSERT_EQ(scene.soup.chunks.size(), 1u);
        EXPECT_EQ(open_edges(scene.soup.chunks[0].corners()), 0u) << name;
        EXPECT_GT(enclosed_volume(scene.soup.chunks[0].corners()), 0.1) << name << " is inside out";
    }
}

TEST(ClosedScenes, GlassIsClosedAndItsTrianglesFaceOutwards) {
    const Scene scene = make("glass");
    for (size_t m = 2; m < scene.soup.chunks.size(); ++m) {
        EXPECT_EQ(open_edges(scene.soup.chunks[m].corners()), 0u) << scene.meshes[m].name;
        const std::span<const vec3> corners = scene.soup.chunks[m].corners();
        for (size_t i = 0; i < corners.size(); i += 3)
            ASSERT_GT(glm::dot(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]),
                               corners[i]),
                      0);
    }
}

TEST(ClosedScenes, MirrorsAreBallsOnAFloor) {
    const Scene scene = make("mirrors");
    for (size_t m = 1; m < scene.soup.chunks.size(); ++m)
        EXPECT_EQ(open_edges(scene.soup.chunks[m].corners()), 0u) << scene.meshes[m].name;
}

// --- names ------------------------------------------------------------------------------------

TEST(CatalogNames, WrongOnesAreAnsweredWithOneSentence) {
    const struct {
        const char* name;
        const char* message;
    } cases[] = {
        {"plnats", "no test scene is called \"plnats\"; did you mean \"plants\"?"},
        {"terain-64", "no test scene is called \"terain-64\"; did you mean \"terrain-N\"?"},
        {"terrain", "no test scene is called \"terrain\"; did you mean \"terrain-N\"?"},
        {"knots", "no test scene is called \"knots\"; did you mean \"knot\"?"},
        {"sphere-11", "test scene \"sphere-11\": the N of sphere-N must be from 0 to 10"},
        {"plants-0", "test scene \"plants-0\": the N of plants-N must be from 1 to 200"},
        {"soup-99999999999999999999999",
         "test scene \"soup-99999999999999999999999\": the N of soup-N must be from 1 to 20000"},
    };
    for (const auto& c : cases) {
        const Result<Scene> scene = make_test_scene(c.name);
        ASSERT_FALSE(scene) << c.name;
        EXPECT_EQ(scene.error().message, c.message);
    }
}

TEST(CatalogNames, AreTellableFromFiles) {
    for (const char* name : {"plants", "plants-3", "sphere-0", "sphere-99", "soup-007", "knot"})
        EXPECT_TRUE(is_test_scene(name)) << name;
    for (const char* name : {"", "-", "plants-", "plants-x", "plants-1.5", "plants--1", "sphere",
                             "knot-1", "Plants", "plants.ply", "sphere-N", "box "})
        EXPECT_FALSE(is_test_scene(name)) << name;
}

TEST(CatalogNames, UnpleasantOnesAreErrors) {
    for (const std::string& name : {std::string(), std::string(10000, '7'), std::string("\0x", 2)})
        EXPECT_FALSE(make_test_scene(name));
}

} // namespace
} // namespace ovc
