// SPDX-License-Identifier: Apache-2.0
// What shapes are cut into: closed where they are closed, outward, of the right volume, under any
// transformation.
#include "importers/readers.h"
#include "importers/test_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

namespace ovc {
namespace {

constexpr double kPi = std::numbers::pi;

struct Solid {
    const char* name;
    const char* text;
    double volume;
};

const Solid kSolids[] = {
    {"sphere", "sphere { <1, 2, 3>, 2 }", 4 / 3.0 * kPi * 8},
    {"box", "box { <2, 2, 2>, <0, -1, 1> }", 6},
    {"cylinder", "cylinder { <1, 0, 2>, <1, 3, 2>, 0.5 }", 0.75 * kPi},
    {"slanting_cone", "cone { 0, 1, <1, 2, 2>, 0.25 }", kPi * 3 / 3 * (1 + 0.25 + 0.0625)},
    {"pointed_cone", "cone { 0, 1, 3*y, 0 }", kPi},
    {"torus", "torus { 3, 1 }", 2 * kPi* kPi * 3},
    {"superellipsoid", "superellipsoid { <1, 1> }", 4 / 3.0 * kPi},
    {"lathe", "lathe { linear_spline 4, <0, 0>, <1, 0>, <1, 2>, <0, 2> }", 2 * kPi},
    {"sor", "sor { 5, <1, -1>, <1, 0>, <1, 1>, <1, 2>, <1, 3> }", 2 * kPi},
    {"prism", "prism { 0, 2, 5, <0, 0>, <2, 0>, <2, 1>, <0, 1>, <0, 0> }", 4},
    {"prism_turned", "prism { 0, 2, 5, <0, 0>, <0, 1>, <2, 1>, <2, 0>, <0, 0> }", 4},
    {"prism_with_a_hole",
     "prism { 0, 2, 10, <0, 0>, <4, 0>, <4, 4>, <0, 4>, <0, 0>, <1, 1>, <1, 3>, <3, 3>, <3, 1>, "
     "<1, 1> }",
     24},
    {"scaled", "sphere { 0, 1 scale <1, 2, -3> rotate <10, 20, 30> translate 5 }", 8 * kPi},
    {"inverse_twice", "box { 0, 1 inverse inverse }", 1},
};

class PovSolid : public testing::TestWithParam<Solid> {};

/// The volume; every edge must be met as often one way as the other.
double volume_of_closed(const Result<Scene>& scene) {
    using Point = std::array<double, 3>;
    std::map<std::pair<Point, Point>, int> edges;
    double volume = 0;
    for (const Triangle& t : triangles_of(scene)) {
        volume += glm::dot(t[0], glm::cross(t[1], t[2])) / 6;
        for (size_t i = 0; i < 3; ++i) {
            const dvec3 &a = t[i], &b = t[(i + 1) % 3];
            ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
            --edges[{{b.x, b.y, b.z}, {a.x, a.y, a.z}}];
        }
    }
    for (const auto& [edge, balance] : edges)
        EXPECT_EQ(balance, 0) << edge.first[0] << " " << edge.first[1] << " " << edge.first[2];
    return volume;
}

TEST_P(PovSolid, IsClosedAndOutwardAndHasItsVolume) {
    const Result<Scene> scene = parse_pov(GetParam().text, "x.pov", {});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_NEAR(volume_of_closed(scene), GetParam().volume, 0.003 * GetParam().volume);
}

TEST_P(PovSolid, NormalsPointOutside) {
    const Result<Scene> scene = parse_pov(GetParam().text, "x.pov", {});
    ASSERT_TRUE(scene);
    for (size_t m = 0; m < scene->meshes.size(); ++m)
        for (size_t i = 0; i < scene->meshes[m].normals.size(); ++i) {
            const Triangle t = scene->soup.chunks[m].triangle(uint32_t(i / 3));
            const dvec3 flat = glm::cross(t[1] - t[0], t[2] - t[0]);
            ASSERT_GT(glm::dot(flat, dvec3(scene->meshes[m].normals[i])), 0) << i;
        }
}

INSTANTIATE_TEST_SUITE_P(All, PovSolid, testing::ValuesIn(kSolids),
                         [](const auto& solid) { return std::string(solid.param.name); });

double area(const std::string& text) {
    double sum = 0;
    for (const Triangle& t : triangles_of(parse_pov(text, "x.pov", {})))
        sum += 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
    return sum;
}

TEST(PovShapes, FlatOnesHaveTheirArea) {
    EXPECT_NEAR(area("disc { <1, 2, 3>, <1, 1, 0>, 2, 1 }"), 3 * kPi, 0.01);
    EXPECT_NEAR(
        area("polygon { 10, <0, 0>, <3, 0>, <3, 3>, <0, 3>, <0, 0>, <1, 1>, <1, 2>, <2, 2>, "
             "<2, 1>, <1, 1> }"),
        8, 1e-9);
    EXPECT_NEAR(area("cylinder { 0, y, 1 open }"), 2 * kPi, 0.01);
    EXPECT_NEAR(area("triangle { 0, 2*x, 2*y }"), 2, 1e-9);
}

TEST(PovShapes, VerticesLieOnTheSphere) {
    for (const Triangle& t : triangles_of(parse_pov("sphere { 0, 1 }", "x.pov", {})))
        for (const dvec3& corner : t)
            ASSERT_NEAR(glm::length(corner), 1, 1e-7);
}

TEST(PovShapes, ManyRoundThingsAreCutMoreCoarsely) {
    const std::string loop = "#for (I, 1, 20000) sphere { I*x, 0.4 } #end";
    const size_t triangles = triangles_of(parse_pov(loop, "x.pov", {})).size();
    EXPECT_LE(triangles, 3'000'000u);
    EXPECT_GE(triangles, 20'000u * 60);
}

TEST(PovShapes, PlanesKeepTheirPlaceNearTheScene) {
    const Result<Scene> scene =
        parse_pov("sphere { <7, 8, 9>, 1 } plane { <1, 2, 3>, 4 }", "x.pov", {});
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->meshes.back().name, "plane");
    const Chunk& plane = scene->soup.chunks.back();
    const dvec3 normal = glm::normalize(dvec3(1, 2, 3));
    EXPECT_NEAR(glm::dot(plane.origin(), normal), 4, 1e-12);
    for (uint32_t prim = 0; prim < plane.size(); ++prim) {
        const Triangle t = plane.triangle(prim);
        EXPECT_EQ(t[0], plane.origin());
        EXPECT_GT(glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), normal), 0);
        EXPECT_GT(glm::length(t[1] - t[0]), 1e4);
    }
}

/// The boxes are what povray 3.7.0.10 prints for min_extent and max_extent, less its padding.
TEST(PovText, StandsWherePovRaySetsIt) {
    const struct {
        const char* text;
        dvec3 lo, hi;
    } cases[] = {
        {"ttf \"timrom.ttf\" \"AVia\" 0.3, 0", {0, -0.016, 0}, {1.956, 0.696, 0.3}},
        {"ttf \"timrom.ttf\" \"AV\" 0.3, <0.1, 0.2, 0.05>", {0, 0, 0}, {1.378, 0.88, 0.3}},
        {"ttf \"timrom.ttf\" \"a a\" -0.3, 0", {0, -0.01, -0.3}, {1.106, 0.469, 0}},
        {"ttf \"timrom.ttf\" \"\\u0041\\u00e9\" 0.3, 0", {0, 0, 0}, {1.25, 0.696, 0.3}},
        {"internal 1 \"Pi\" 0.3, 0", {0, 0, 0}, {0.814, 0.696, 0.3}},
        {"internal 2 \"Pi\" 0.3, 0", {0, 0, 0}, {0.702, 0.728, 0.3}},
        {"internal 3 \"Pi\" 0.3, 0", {0, -0.00097, 0}, {0.8203, 0.72998, 0.3}},
        {"internal 4 \"Pi\" 0.3, 0", {0, 0.00196, 0}, {1.373, 1.00196, 0.3}},
    };
    for (const auto& c : cases) {
        const Result<Scene> scene = parse_pov(fmt::format("text {{ {} }}", c.text), "x.pov", {});
        if (!scene && scene.error().message.find("found no file") != std::string::npos)
            GTEST_SKIP() << "povray's fonts are not installed";
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_GT(volume_of_closed(scene), 0.01) << c.text;
        Box box;
        for (const Triangle& t : triangles_of(scene))
            for (const dvec3& corner : t)
                box.add(corner);
        EXPECT_LT(glm::length(box.lo - c.lo), 0.001) << c.text << box.lo.x << " " << box.lo.y;
        EXPECT_LT(glm::length(box.hi - c.hi), 0.001) << c.text << box.hi.x << " " << box.hi.y;
    }
}

} // namespace
} // namespace ovc
