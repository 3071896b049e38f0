// SPDX-License-Identifier: Apache-2.0
// Tests volumes by formulas, closed results, coinciding faces, and random trees against the answers
// of every operand by itself.
#include "importers/csg/csg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

namespace ovc::csg {
namespace {

using std::numbers::pi;

Operand box(const dvec3& lo, const dvec3& hi) {
    Operand operand;
    const auto corner = [&](int i) {
        return dvec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    };
    constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : kQuads) {
        operand.triangles.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
        operand.triangles.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
    }
    return operand;
}

Operand sphere(const dvec3& center, double radius, int segments = 48) {
    Operand operand;
    const auto at = [&](int row, int column) {
        const double up = pi * (2.0 * row / segments - 0.5);
        const double around = 2 * pi * (column % segments) / segments;
        if (row == 0 || 2 * row == segments)
            return center + dvec3(0, row == 0 ? -radius : radius, 0);
        return center + radius * dvec3(std::cos(up) * std::cos(around), std::sin(up),
                                       -std::cos(up) * std::sin(around));
    };
    for (int row = 0; 2 * row < segments; ++row)
        for (int i = 0; i < segments; ++i) {
            if (row > 0)
                operand.triangles.push_back({at(row, i), at(row, i + 1), at(row + 1, i + 1)});
            if (2 * row + 2 < segments)
                operand.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row + 1, i)});
        }
    return operand;
}

Operand inverse(Operand operand) {
    operand.inverse = true;
    return operand;
}

/// Returns a tree of one node with all operands under it.
Tree flat(Kind kind, std::vector<Operand> operands) {
    Tree tree;
    Node root{kind, 0, {}};
    for (uint32_t i = 0; i < operands.size(); ++i) {
        tree.nodes.push_back({Kind::Operand, i, {}});
        root.children.push_back(i);
    }
    tree.nodes.push_back(root);
    tree.operands = std::move(operands);
    return tree;
}

double volume(const std::vector<Part>& parts) {
    double sum = 0;
    for (const Part& part : parts)
        sum += glm::dot(part.corners[0], glm::cross(part.corners[1], part.corners[2])) / 6;
    return sum;
}

double area(const std::vector<Part>& parts) {
    double sum = 0;
    for (const Part& part : parts)
        sum += 0.5 * glm::length(glm::cross(part.corners[1] - part.corners[0],
                                            part.corners[2] - part.corners[0]));
    return sum;
}

/// Returns the number of edges that triangles run along more often one way than the other.
size_t open_edges(const std::vector<Part>& parts) {
    using Corner = std::array<double, 3>;
    std::map<std::pair<Corner, Corner>, int> edges;
    for (const Part& part : parts)
        for (size_t i = 0; i < 3; ++i) {
            const dvec3 &a = part.corners[i], &b = part.corners[(i + 1) % 3];
            ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
            --edges[{{b.x, b.y, b.z}, {a.x, a.y, a.z}}];
        }
    size_t open = 0;
    for (const auto& [edge, balance] : edges)
        open += balance > 0;
    return open;
}

struct Case {
    const char* name;
    Tree tree;
    double volume, area;
};

const Case kCases[] = {
    {"a_corner_cut_off",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(2)), inverse(box(dvec3(1), dvec3(3)))}), 7, 24},
    {"a_hole_through",
     flat(Kind::Intersection,
          {box(dvec3(0), dvec3(3)), inverse(box(dvec3(1, 1, -1), dvec3(2, 2, 4)))}),
     24, 54 - 2 + 12},
    {"a_hole_that_ends_on_both_faces",
     flat(Kind::Intersection,
          {box(dvec3(0), dvec3(3)), inverse(box(dvec3(1, 1, 0), dvec3(2, 2, 3)))}),
     24, 54 - 2 + 12},
    {"a_notch_flush_with_two_faces",
     flat(Kind::Intersection,
          {box(dvec3(0), dvec3(3)), inverse(box(dvec3(0, 1, 2), dvec3(1, 2, 3)))}),
     26, 54 + 2},
    {"a_cavity",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(3)), inverse(box(dvec3(1), dvec3(2)))}), 26, 60},
    {"itself_taken_away",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(3)), inverse(box(dvec3(0), dvec3(3)))}), 0, 0},
    {"itself_and_itself",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(3)), box(dvec3(0), dvec3(3))}), 27, 54},
    {"side_by_side_merged",
     flat(Kind::Merge, {box(dvec3(0), dvec3(1)), box(dvec3(1, 0, 0), dvec3(2, 1, 1))}), 2, 10},
    {"along_an_edge_merged",
     flat(Kind::Merge, {box(dvec3(0), dvec3(1)), box(dvec3(1, 1, 0), dvec3(2, 2, 1))}), 2, 12},
    {"at_a_corner_merged", flat(Kind::Merge, {box(dvec3(0), dvec3(1)), box(dvec3(1), dvec3(2))}), 2,
     12},
    {"flush_merged",
     flat(Kind::Merge, {box(dvec3(0), dvec3(2)), box(dvec3(0.5, 0.5, 1), dvec3(1.5, 1.5, 2))}), 8,
     24},
    {"apart_intersected",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(1)), box(dvec3(2), dvec3(3))}), 0, 0},
    {"touching_intersected",
     flat(Kind::Intersection, {box(dvec3(0), dvec3(1)), box(dvec3(1, 0, 0), dvec3(2, 1, 1))}), 0,
     0},
};

class Csg : public testing::TestWithParam<Case> {};

TEST_P(Csg, HasItsVolumeAndAreaAndIsClosed) {
    const std::vector<Part> parts = evaluate(GetParam().tree);
    EXPECT_NEAR(volume(parts), GetParam().volume, 1e-9);
    EXPECT_NEAR(area(parts), GetParam().area, 1e-9);
    EXPECT_EQ(open_edges(parts), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, Csg, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(CsgRound, ALensHasItsVolume) {
    const int segments = 96;
    const double d = 1, r = 1; // The middles of the two unit spheres are 1 apart.
    const double lens = pi * (2 * r - d) * (2 * r - d) * (d * d + 4 * d * r) / (12 * d);
    const Operand a = sphere(dvec3(0), 1, segments), b = sphere(dvec3(1, 0, 0), 1, segments);
    const auto common = evaluate(flat(Kind::Intersection, {a, b}));
    const auto rest = evaluate(flat(Kind::Intersection, {a, inverse(b)}));
    const auto both = evaluate(flat(Kind::Merge, {a, b}));
    EXPECT_NEAR(volume(common), lens, 0.005 * lens);
    const double whole = volume(evaluate(flat(Kind::Union, {a})));
    // The volumes of the faceted solids add up exactly.
    EXPECT_NEAR(volume(rest), whole - volume(common), 1e-9);
    EXPECT_NEAR(volume(both), 2 * whole - volume(common), 1e-9);
    for (const auto* parts : {&common, &rest, &both})
        EXPECT_EQ(open_edges(*parts), 0u);
}

TEST(CsgRound, ASphereHalvedThroughItsCornersIsClosed) {
    // The plane of the cut runs along a ring of the sphere's edges.
    const Operand ball = sphere(dvec3(0), 1, 32);
    const auto half =
        evaluate(flat(Kind::Intersection, {ball, box(dvec3(-2, 0, -2), dvec3(2, 2, 2))}));
    EXPECT_EQ(open_edges(half), 0u);
    EXPECT_NEAR(volume(half), 0.5 * volume(evaluate(flat(Kind::Union, {ball}))), 1e-9);
}

TEST(CsgRound, IntegersStayIntegers) {
    // A checker on a floor at a whole number shows which side of it corners are on.
    for (int i = 0; i < 20; ++i) {
        const double far = 1000 + 12.34567 * i;
        const Tree tree = flat(Kind::Intersection, {box({-far, -3 * far, -100}, {500, 0, far}),
                                                    inverse(box({-1, -2, -5}, {1, 1, 20}))});
        int on_floor = 0;
        for (const Part& part : evaluate(tree))
            for (const dvec3& corner : part.corners)
                if (std::abs(corner.y + 2) < 0.01) {
                    EXPECT_EQ(corner.y, -2) << i;
                    ++on_floor;
                }
        EXPECT_GE(on_floor, 6) << i;
    }
}

TEST(CsgRound, PartsLieOnTheTriangleTheyAreOf) {
    const Tree tree =
        flat(Kind::Intersection, {sphere(dvec3(0), 1), inverse(sphere(dvec3(0.5, 0.25, 0), 0.75))});
    for (const Part& part : evaluate(tree)) {
        const auto& whole = tree.operands[part.operand].triangles[part.triangle];
        const dvec3 normal = glm::normalize(glm::cross(whole[1] - whole[0], whole[2] - whole[0]));
        for (const dvec3& corner : part.corners)
            ASSERT_NEAR(glm::dot(corner - whole[0], normal), 0, 1e-10);
        ASSERT_EQ(part.turned, part.operand == 1);
    }
}

TEST(CsgRules, AUnionKeepsItsInnerSurfacesAndAClipShowsNone) {
    const std::vector<Operand> two = {box(dvec3(0), dvec3(2)), box(dvec3(1), dvec3(3))};
    EXPECT_NEAR(area(evaluate(flat(Kind::Union, two))), 48, 1e-9);
    EXPECT_NEAR(area(evaluate(flat(Kind::Merge, two))), 42, 1e-9);
    // Three squares of the first box are left.
    EXPECT_NEAR(area(evaluate(flat(Kind::Clip, two))), 3, 1e-9);
}

TEST(CsgRules, WhatIsNotSolidHasNoInside) {
    Operand sheet;
    sheet.triangles = {{dvec3(-5, 0.5, -5), dvec3(-5, 0.5, 5), dvec3(5, 0.5, 0)}};
    sheet.solid = false;
    const auto parts = evaluate(flat(Kind::Intersection, {box(dvec3(0), dvec3(1)), sheet}));
    // The part of the sheet in the box is left, and no part of the box.
    EXPECT_NEAR(area(parts), 1, 1e-9);
}

/// On a coarse grid, nearly all faces, edges and corners of boxes coincide. The volume of the
/// result is the number of cells inside.
TEST(CsgRandom, BoxesOnACoarseGridCountAsCellsDo) {
    std::mt19937 random(7);
    const auto number = [&](int below) { return int(random() % unsigned(below)); };
    for (int round = 0; round < 300; ++round) {
        Tree tree;
        std::vector<std::pair<dvec3, dvec3>> boxes;
        const int count = 2 + number(5);
        for (int i = 0; i < count; ++i) {
            const dvec3 lo(number(4), number(4), number(4));
            const dvec3 hi = lo + dvec3(1 + number(3), 1 + number(3), 1 + number(3));
            boxes.push_back({lo, hi});
            tree.operands.push_back(box(lo, hi));
            tree.operands.back().inverse = i > 0 && number(2);
            tree.nodes.push_back({Kind::Operand, uint32_t(i), {}});
        }
        // Random pairs are joined. The first box, which is finite, bounds the whole.
        std::vector<uint32_t> open;
        for (uint32_t i = 1; i < uint32_t(count); ++i)
            open.push_back(i);
        while (open.size() > 1) {
            const uint32_t a = open.back();
            open.pop_back();
            tree.nodes.push_back({number(2) ? Kind::Merge : Kind::Intersection, 0, {a, open[0]}});
            open[0] = uint32_t(tree.nodes.size() - 1);
        }
        tree.nodes.push_back({Kind::Intersection, 0, {0, open[0]}});
        std::function<bool(uint32_t, const dvec3&)> inside = [&](uint32_t n, const dvec3& p) {
            const Node& node = tree.nodes[n];
            if (node.kind == Kind::Operand) {
                const auto& [lo, hi] = boxes[node.operand];
                const bool in = glm::all(glm::lessThan(lo, p)) && glm::all(glm::lessThan(p, hi));
                return in != tree.operands[node.operand].inverse;
            }
            bool all = true, any = false;
            for (const uint32_t child : node.children) {
                const bool in = inside(child, p);
                all = all && in;
                any = any || in;
            }
            return node.kind == Kind::Merge ? any : all;
        };
        double expected = 0;
        for (int x = 0; x < 8; ++x)
            for (int y = 0; y < 8; ++y)
                for (int z = 0; z < 8; ++z)
                    expected += inside(uint32_t(tree.nodes.size() - 1), dvec3(x, y, z) + 0.5);
        const std::vector<Part> parts = evaluate(tree);
        ASSERT_NEAR(volume(parts), expected, 1e-9) << round;
        ASSERT_EQ(open_edges(parts), 0u) << round;
    }
}

TEST(CsgRandom, SpheresAndBoxesAddUp) {
    std::mt19937 random(11);
    const auto number = [&] { return double(random()) / double(std::mt19937::max()); };
    for (int round = 0; round < 40; ++round) {
        const Operand a = sphere(dvec3(number(), number(), number()), 0.5 + number(), 16);
        const Operand b = round % 2
                              ? sphere(dvec3(number(), 0, number()), 0.5 + number(), 20)
                              : box(dvec3(-number()), dvec3(number(), number(), 2 * number()));
        const auto common = evaluate(flat(Kind::Intersection, {a, b}));
        const auto a_only = evaluate(flat(Kind::Intersection, {a, inverse(b)}));
        const auto b_only = evaluate(flat(Kind::Intersection, {b, inverse(a)}));
        const auto merged = evaluate(flat(Kind::Merge, {a, b}));
        const double whole_a = volume(evaluate(flat(Kind::Union, {a})));
        ASSERT_NEAR(volume(common) + volume(a_only), whole_a, 1e-9) << round;
        ASSERT_NEAR(volume(common) + volume(a_only) + volume(b_only), volume(merged), 1e-9);
        for (const auto* parts : {&common, &a_only, &b_only, &merged})
            ASSERT_EQ(open_edges(*parts), 0u) << round;
    }
}

} // namespace
} // namespace ovc::csg
