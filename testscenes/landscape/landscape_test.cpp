// SPDX-License-Identifier: Apache-2.0
// landscape-N: its tiles fit together, and a stream of them is the scene.
#include "testscenes/catalog.h"
#include "testscenes/landscape/landscape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace ovc {
namespace {

/// Keeps what it gets.
struct KeepingSink final : TriangleSink {
    std::vector<Corners> meshes;
    size_t parts = 0, max_parts = ~size_t(0);

    void begin_mesh() override { meshes.emplace_back(); }
    void go_on_with(size_t) override { ADD_FAILURE() << "it gives mesh after mesh"; }
    void drop_normals(size_t) override {}
    bool add_corners(std::span<const vec3> corners) override {
        EXPECT_EQ(corners.size() % 3, 0u);
        meshes.back().insert(meshes.back().end(), corners.begin(), corners.end());
        return ++parts < max_parts;
    }
    bool add_normals(std::span<const vec3>) override { return false; }
};

TEST(Landscape, HasAMillionTrianglesForEachOfItsSize) {
    for (const uint32_t millions : {1u, 2u, 7u, 250u, 1000u, 3989u, kMaxLandscape}) {
        const Landscape landscape(millions);
        const uint64_t a_tile = Landscape::kGroundTriangles + Landscape::kStoneTriangles;
        EXPECT_EQ(landscape.tiles() * a_tile, uint64_t(millions) * 1'000'000);
        EXPECT_EQ(landscape.ground(landscape.tiles() - 1).size(), 3u * Landscape::kGroundTriangles);
        EXPECT_EQ(landscape.stones(0).size(), 3u * Landscape::kStoneTriangles);
    }
}

TEST(Landscape, StreamsTheSceneOfTheCatalog) {
    const Result<Scene> scene = make_test_scene("landscape-1");
    ASSERT_TRUE(scene);
    KeepingSink sink;
    ASSERT_TRUE(Landscape(1).write(sink));
    ASSERT_EQ(sink.meshes.size(), scene->soup.chunks.size());
    for (size_t m = 0; m < sink.meshes.size(); ++m)
        EXPECT_TRUE(std::ranges::equal(sink.meshes[m], scene->soup.chunks[m].corners())) << m;
}

TEST(Landscape, StreamsByItsName) {
    KeepingSink sink;
    const Result<Scene> rest = stream_test_scene("landscape-1", sink);
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->name, "landscape-1");
    EXPECT_EQ(rest->meshes.size(), sink.meshes.size());
    EXPECT_EQ(rest->soup.triangle_count(), 0u);
    KeepingSink stops;
    stops.max_parts = 1;
    EXPECT_EQ(stream_test_scene("landscape-4000", stops).error().kind, ErrorKind::Cancelled);
    EXPECT_FALSE(stream_test_scene("landscape-4001", stops));
}

TEST(Landscape, EndsWhereTheSinkWantsNoMore) {
    KeepingSink sink;
    sink.max_parts = 3;
    EXPECT_FALSE(Landscape(1).write(sink));
    EXPECT_EQ(sink.parts, 3u);
}

TEST(Landscape, NeighboursShareTheCornersOfTheirGround) {
    const auto on_border = [](const Corners& corners, int axis, float at) {
        std::vector<std::tuple<float, float, float>> found;
        for (const vec3& corner : corners)
            if (corner[axis] == at)
                found.emplace_back(corner.x, corner.y, corner.z);
        std::ranges::sort(found);
        const auto rest = std::ranges::unique(found);
        found.erase(rest.begin(), rest.end());
        return found;
    };
    for (const uint32_t millions : {1u, kMaxLandscape}) {
        const Landscape landscape(millions);
        const uint32_t tile = landscape.tiles() / 2, below = tile + landscape.columns();
        const Corners here = landscape.ground(tile);
        const vec3 far = here[2]; // of the first cell; the last corner of all is the tile's own
        ASSERT_TRUE(far.x > here[0].x && far.z > here[0].z);
        for (const auto& [axis, other] : {std::pair(0, tile + 1), std::pair(2, below)}) {
            const float border = here[0][axis] + 1;
            const auto mine = on_border(here, axis, border);
            EXPECT_EQ(mine.size(), Landscape::kCells + 1);
            EXPECT_EQ(mine, on_border(landscape.ground(other), axis, border));
        }
    }
}

TEST(Landscape, StonesAreClosed) {
    const Corners stones = Landscape(kMaxLandscape).stones(12345);
    std::map<std::array<float, 6>, int> edges; // each is met once in each direction
    for (size_t i = 0; i < stones.size(); ++i) {
        const vec3& a = stones[i];
        const vec3& b = stones[i % 3 == 2 ? i - 2 : i + 1];
        edges[{a.x, a.y, a.z, b.x, b.y, b.z}] += 1;
    }
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_TRUE(edges.contains({edge[3], edge[4], edge[5], edge[0], edge[1], edge[2]}));
    }
}

TEST(Landscape, IsHeldUpToASizeOnly) {
    EXPECT_FALSE(make_test_scene("landscape-0"));
    EXPECT_FALSE(make_test_scene("landscape-" + std::to_string(kMaxLandscapeHeld + 1)));
}

} // namespace
} // namespace ovc
