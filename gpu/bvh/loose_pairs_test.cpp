// SPDX-License-Identifier: Apache-2.0
// Loose pairs keep their corners to half a step, and join triangles that are alone and in the
// frame.
#include "gpu/bvh/loose_pairs.h"

#include "core/ray.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TrianglePair alone(test::Random& random, uint32_t id) {
    TrianglePair pair{{}, id, kNone, 0 | 2 << 2};
    for (size_t i = 0; i < 3; ++i)
        pair.corners[i] = vec3(random.point(-0.999, 0.999));
    pair.corners[3] = pair.corners[1];
    return pair;
}

/// Returns the corners of a unit as layout.h defines them, read field by field.
std::array<dvec3, 6> corners_of(std::span<const uvec4, OVC_UNIT_TEXELS> unit) {
    const auto upper = [](uint32_t word) { return double(int32_t(word) >> 8) * OVC_LOOSE_STEP; };
    const auto low = [&](const uvec4& t) {
        return upper((t.x & 255) << 8 | (t.y & 255) << 16 | (t.z & 255) << 24);
    };
    std::array<dvec3, 6> corners;
    for (size_t i = 0; i < 4; ++i)
        corners[i] = {upper(unit[i].x), upper(unit[i].y), upper(unit[i].z)};
    corners[4] = {low(unit[0]), low(unit[1]), low(unit[2])};
    corners[5] = {low(unit[3]), upper(unit[2].w),
                  upper((unit[2].w & 255) << 24 | (unit[3].w & 65535) << 8)};
    return corners;
}

TEST(LoosePairs, KeepCornersToHalfAStep) {
    test::Random random(5);
    for (uint32_t i = 0; i < 5000; ++i) {
        const TrianglePair a = alone(random, 2 * i), b = alone(random, 2 * i + 1);
        std::array<uvec4, OVC_UNIT_TEXELS> unit;
        put_loose(a, b, unit);
        EXPECT_EQ(unit[0].w, 2 * i);
        EXPECT_EQ(unit[1].w, 2 * i + 1);
        EXPECT_EQ(unit[3].w & (OVC_PAIR | OVC_LOOSE_PAIR), OVC_PAIR | OVC_LOOSE_PAIR);
        const std::array<dvec3, 6> corners = corners_of(unit);
        for (size_t k = 0; k < 6; ++k) {
            const vec3& corner = k < 3 ? a.corners[k] : b.corners[k - 3];
            ASSERT_EQ(corners[k], dvec3(in_steps(corner))) << "corner " << k;
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_LE(std::abs(corners[k][axis] - double(corner[axis])), OVC_LOOSE_STEP / 2);
        }
    }
}

/// Returns a node over two boxes of side 0.1, `apart` from one another.
std::vector<BvhNode> two_boxes(float apart) {
    const Boxf one{vec3(0), vec3(0.1f)}, other{vec3(apart), vec3(apart + 0.1f)};
    Boxf both = one;
    both.add(other);
    return {{both, 2, 0}, {one, 0, 0}, {other, 0, 1}};
}

TEST(LoosePairs, JoinWhatIsNear) {
    test::Random random(6);
    const std::vector<TrianglePair> pairs{alone(random, 0), alone(random, 1)};
    std::vector<BvhNode> near = two_boxes(0), far = two_boxes(0.5f);
    EXPECT_EQ(join_loose(near, pairs), (std::vector<LoosePair>{{0, 1}}));
    EXPECT_TRUE(near[0].is_leaf());
    EXPECT_EQ(near[0].item, 2u);
    EXPECT_TRUE(join_loose(far, pairs).empty());
    EXPECT_FALSE(far[0].is_leaf());
}

/// Counts how often each triangle is in a leaf of the node, and checks that each box holds those of
/// the node's children.
void count_below(const std::vector<BvhNode>& nodes, uint32_t node,
                 const std::vector<LoosePair>& loose, std::vector<int>& count) {
    const BvhNode& n = nodes[node];
    if (n.is_leaf()) {
        if (n.item < count.size()) {
            ++count[n.item];
            return;
        }
        for (const uint32_t item : loose[n.item - count.size()])
            ++count[item];
        return;
    }
    for (const uint32_t child : {node + 1, n.right}) {
        Boxf both = n.box;
        both.add(nodes[child].box);
        EXPECT_EQ(both.lo, n.box.lo);
        EXPECT_EQ(both.hi, n.box.hi);
        count_below(nodes, child, loose, count);
    }
}

TEST(LoosePairs, LeaveEveryTriangleInOneLeaf) {
    for (const size_t triangles : {1, 2, 3, 5, 1000}) {
        test::Random random(triangles);
        std::vector<TrianglePair> pairs;
        std::vector<Boxf> boxes;
        for (uint32_t i = 0; i < triangles; ++i) {
            pairs.push_back(alone(random, i));
            const vec3 at(random.point(-0.9, 0.9));
            boxes.push_back({at, at + 0.3f});
        }
        std::vector<BvhNode> nodes = build_bvh(boxes);
        const std::vector<LoosePair> loose = join_loose(nodes, pairs);
        EXPECT_TRUE(triangles < 1000 || loose.size() > triangles / 4) << loose.size();
        std::vector<int> count(triangles, 0);
        count_below(nodes, 0, loose, count);
        EXPECT_EQ(count, std::vector<int>(triangles, 1));
    }
}

TEST(LoosePairs, LeaveWhatIsPairedOrBeyondTheFrame) {
    test::Random random(7);
    const std::vector<TrianglePair> pairs{alone(random, 0), alone(random, 1)};
    auto paired = pairs, beyond = pairs;
    paired[1].b = 2;
    beyond[0].corners[2].y = -1.5f;
    for (const auto& each : {paired, beyond}) {
        std::vector<BvhNode> nodes = two_boxes(0);
        EXPECT_TRUE(join_loose(nodes, each).empty());
        EXPECT_FALSE(nodes[0].is_leaf());
    }
}

} // namespace
} // namespace ovc
