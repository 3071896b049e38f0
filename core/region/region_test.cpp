// SPDX-License-Identifier: Apache-2.0
#include "core/region/region.h"
#include "core/texture/pattern.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {

namespace {

/// Returns the faces of a box as triangles, counterclockwise seen from outside.
std::vector<dvec3> box_triangles(const dvec3& lo, const dvec3& hi) {
    std::vector<dvec3> corners;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            dvec3 p[4];
            for (int i = 0; i < 4; ++i) {
                p[i][axis] = high ? hi[axis] : lo[axis];
                p[i][u] = (i == 1 || i == 2) == high ? hi[u] : lo[u];
                p[i][v] = i >= 2 ? hi[v] : lo[v];
            }
            corners.insert(corners.end(), {p[0], p[1], p[2], p[0], p[2], p[3]});
        }
    return corners;
}

} // namespace

TEST(Region, ContainsWhatIsInsideOfAnyPart) {
    std::vector<dvec3> corners;
    for (int i = 0; i < 20; ++i) { // boxes that overlap
        const std::vector<dvec3> box =
            box_triangles(dvec3(0.5 * i, 0, 0), dvec3(0.5 * i + 1, 1, 1));
        corners.insert(corners.end(), box.begin(), box.end());
    }
    Region region;
    region.triangles.build(corners);
    ASSERT_TRUE(region.triangles.is_sound());
    region.rounds = {{{dvec3(0), 1, dvec3(0), 0, /* is_ball= */ true},
                      {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 5), dvec4(0, 0, 1, 0)}}};
    region.half_spaces = {{dvec3(0, 0, 1), -3}};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-7, 12);
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 p(coordinate(random), coordinate(random) / 2, coordinate(random) / 2);
        const bool in_boxes = p.x > 0 && p.x < 10.5 && p.y > 0 && p.y < 1 && p.z > 0 && p.z < 1;
        const bool expected = in_boxes || glm::length(p + dvec3(0, 5, 0)) < 1 || p.z < -3;
        EXPECT_EQ(region.contains(p), expected) << p.x << " " << p.y << " " << p.z;
        inside += expected;
    }
    EXPECT_GT(inside, 100);
}

TEST(Region, MayBeTurnedInsideOut) {
    std::vector<dvec3> corners = box_triangles(dvec3(0), dvec3(1));
    for (size_t i = 0; i < corners.size(); i += 3)
        std::swap(corners[i], corners[i + 1]);
    Region region;
    region.triangles.build(corners);
    region.inverted = 1;
    EXPECT_TRUE(region.contains({2, 0.5, 0.5}));
    EXPECT_FALSE(region.contains(dvec3(0.5)));
}

TEST(Region, ATreeWithAnotherNumberOfBoxesIsNotSound) {
    TriangleTree tree;
    EXPECT_TRUE(tree.is_sound());
    tree.build(box_triangles(dvec3(0), dvec3(1)));
    EXPECT_EQ(tree.boxes.size(), 7u); // twelve triangles in four leaves
    tree.boxes.pop_back();
    EXPECT_FALSE(tree.is_sound());
}

TEST(Region, ChoosesAStopOfAPattern) {
    Pattern pattern;
    pattern.kind = Pattern::Kind::Object;
    pattern.region.half_spaces = {{dvec3(1, 0, 0), 0}};
    EXPECT_EQ(evaluate({}, pattern, dvec3(-1)).value, 1);
    EXPECT_EQ(evaluate({}, pattern, dvec3(1)).value, 0);
}

} // namespace ovc
