// SPDX-License-Identifier: Apache-2.0
// far-terrain has no cracks: as exact coordinates say, across the borders of its chunks too.
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace ovc {
namespace {

using Point = std::array<double, 3>;
using Edge = std::pair<Point, Point>;

/// In the direction in which its triangle has it.
std::vector<Edge> directed_edges(const Soup& soup) {
    std::vector<Edge> edges;
    edges.reserve(3 * soup.triangle_count());
    for (const Chunk& chunk : soup.chunks)
        for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
            const Triangle t = chunk.triangle(prim);
            for (size_t k = 0; k < 3; ++k) {
                const dvec3 &a = t[k], &b = t[(k + 1) % 3];
                edges.push_back({{a.x, a.y, a.z}, {b.x, b.y, b.z}});
            }
        }
    return edges;
}

Scene make_scene() {
    Result<Scene> scene = make_test_scene("far-terrain");
    return std::move(*scene);
}

class FarTerrain : public testing::Test {
protected:
    const Scene scene_ = make_scene();
    const Soup& soup_ = scene_.soup;
    const Box bounds_ = [this] {
        Box bounds;
        hittable_triangles(soup_, nullptr, &bounds);
        return bounds;
    }();
};

TEST_F(FarTerrain, EveryInnerEdgeIsSharedByTwoTrianglesInOppositeDirections) {
    std::vector<Edge> edges = directed_edges(soup_);
    std::ranges::sort(edges);
    EXPECT_EQ(std::ranges::adjacent_find(edges), edges.end()) << "an edge twice in one direction";
    const auto on_border = [&](const Edge& e) {
        for (const size_t axis : {0, 2})
            for (const double side : {bounds_.lo[int(axis)], bounds_.hi[int(axis)]})
                if (e.first[axis] == side && e.second[axis] == side)
                    return true;
        return false;
    };
    double border = 0;
    uint64_t cracks = 0;
    for (const Edge& e : edges) {
        const bool shared = std::ranges::binary_search(edges, Edge(e.second, e.first));
        if (on_border(e))
            border += std::abs(e.first[0] - e.second[0]) + std::abs(e.first[2] - e.second[2]);
        cracks += shared == on_border(e);
    }
    EXPECT_EQ(cracks, 0u);
    EXPECT_EQ(border, 4 * bounds_.extent().x);
}

TEST_F(FarTerrain, EveryTriangleFacesUp) {
    // With the outline of a square and edges shared by two, they cover it exactly once.
    for (const Chunk& chunk : soup_.chunks)
        for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
            const Triangle t = chunk.triangle(prim);
            ASSERT_GT(glm::cross(t[1] - t[0], t[2] - t[0]).y, 0);
        }
}

TEST_F(FarTerrain, PositionsAreExact) {
    for (const Chunk& chunk : soup_.chunks)
        for (const vec3& offset : chunk.corners())
            ASSERT_EQ(chunk.origin() + dvec3(offset) - chunk.origin(), dvec3(offset));
}

TEST_F(FarTerrain, IsLargeAndFine) {
    EXPECT_GE(bounds_.extent().x, 1e7);
    EXPECT_GE(bounds_.extent().z, 1e7);
    const Triangle finest = soup_.triangle({0, soup_.chunks[0].size() - 1});
    EXPECT_EQ(bounds_of(finest).extent().x, 0x1p-10);
    EXPECT_EQ(bounds_of(finest).hi.x, bounds_.hi.x) << "at the far corner";
    EXPECT_EQ(bounds_of(finest).hi.z, bounds_.hi.z);
    EXPECT_LT(bounds_.hi.y, 5000);
    EXPECT_GT(bounds_.lo.y, -5000);
}

} // namespace
} // namespace ovc
