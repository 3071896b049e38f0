// SPDX-License-Identifier: Apache-2.0
// Tests the triangles that shapes are cut into: closed shapes are closed, face outside and have the
// right volume, under any transformation.
#include "importers/pov/test_parse.h"
#include "importers/readers.h"
#include "importers/test_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

namespace ovc {
namespace {

using std::numbers::pi;

struct Solid {
    const char* name;
    const char* text;
    double volume;
};

const Solid kSolids[] = {
    {"sphere", "sphere { <1, 2, 3>, 2 }", 4 / 3.0 * pi * 8},
    {"box", "box { <2, 2, 2>, <0, -1, 1> }", 6},
    {"cylinder", "cylinder { <1, 0, 2>, <1, 3, 2>, 0.5 }", 0.75 * pi},
    {"slanting_cone", "cone { 0, 1, <1, 2, 2>, 0.25 }", pi * 3 / 3 * (1 + 0.25 + 0.0625)},
    {"pointed_cone", "cone { 0, 1, 3*y, 0 }", pi},
    {"torus", "torus { 3, 1 }", 2 * pi* pi * 3},
    {"superellipsoid", "superellipsoid { <1, 1> }", 4 / 3.0 * pi},
    {"lathe", "lathe { linear_spline 4, <0, 0>, <1, 0>, <1, 2>, <0, 2> }", 2 * pi},
    {"lathe_downwards", "lathe { linear_spline 4, <0, 2>, <1, 2>, <1, 0>, <0, 0> }", 2 * pi},
    {"lathe_in_pieces_downwards",
     "lathe { bezier_spline 12, <0, 2>, <0.3, 2>, <0.7, 2>, <1, 2>, <1, 2>, <1, 1.5>, <1, 0.5>, "
     "<1, 0>, <1, 0>, <0.7, 0>, <0.3, 0>, <0, 0> }",
     2 * pi},
    {"sor", "sor { 5, <1, -1>, <1, 0>, <1, 1>, <1, 2>, <1, 3> }", 2 * pi},
    {"ovus", "ovus { 1, 0.5 }", 4.91354},
    {"ovus_that_stands_on_its_point", "ovus { 0.5, 0.8 }", 2.27905},
    {"ovus_that_is_a_ball", "ovus { 0.5, 1 }", 4 / 3.0 * pi},
    {"superellipsoid_without_roundings", "superellipsoid { 0 }", 8},
    {"prism", "prism { 0, 2, 5, <0, 0>, <2, 0>, <2, 1>, <0, 1>, <0, 0> }", 4},
    {"prism_turned", "prism { 0, 2, 5, <0, 0>, <0, 1>, <2, 1>, <2, 0>, <0, 0> }", 4},
    {"prism_not_closed", "prism { 0, 2, 3, <0, 0>, <2, 0>, <0, 1> }", 2},
    {"prism_with_a_hole_not_closed",
     "prism { 0, 2, 9, <0, 0>, <4, 0>, <4, 4>, <0, 4>, <0, 0>, <1, 1>, <1, 3>, <3, 3>, <3, 1> }",
     24},
    {"prism_with_a_hole",
     "prism { 0, 2, 10, <0, 0>, <4, 0>, <4, 4>, <0, 4>, <0, 0>, <1, 1>, <1, 3>, <3, 3>, <3, 1>, "
     "<1, 1> }",
     24},
    {"prism_of_squares_that_cross",
     "prism { 0, 1, 10, <0, 0>, <2, 0>, <2, 2>, <0, 2>, <0, 0>, <1, 1>, <3, 1>, <3, 3>, <1, 3>, "
     "<1, 1> }",
     6},
    {"prism_of_squares_whose_sides_overlap",
     "prism { 0, 1, 10, <0, 0>, <2, 0>, <2, 2>, <0, 2>, <0, 0>, <1, 0>, <3, 0>, <3, 2>, <1, 2>, "
     "<1, 0> }",
     4},
    // Its five points; the pentagon between them is a hole.
    {"prism_of_a_pentagram",
     "prism { 0, 1, 6, <0.000000, 1.000000>, <-0.587785, -0.809017>, <0.951057, 0.309017>, "
     "<-0.951057, 0.309017>, <0.587785, -0.809017>, <0.000000, 1.000000> }",
     0.775677},
    {"sphere_sweep", "sphere_sweep { linear_spline 2, 0, 1, 2*y, 1 }", (4 / 3.0 + 2) * pi},
    {"scaled", "sphere { 0, 1 scale <1, 2, -3> rotate <10, 20, 30> translate 5 }", 8 * pi},
    {"inverse_twice", "box { 0, 1 inverse inverse }", 1},
    {"box_minus_boxes",
     "difference { box { 0, 3 } box { 1, <2, 2, 3> } box { <1, 1, 0>, <2, 2, 1> } }", 24},
    {"box_minus_union", "difference { box { 0, 3 } union { box { 1, 4 } box { <0, 2, 0>, 3 } } }",
     27 - 8 - 9 + 4},
    {"box_minus_difference",
     "difference { box { 0, 3 } difference { box { 1, 4 } box { 2, 5 } } scale <1, -1, 1> }", 20},
    {"inverse_union", "union { box { 0, 3 inverse } box { 1, 2 } inverse }", 26},
    {"inverse_group", "union { union { box { 0, 3 inverse } box { 1, 2 } } inverse }", 26},
    {"union_inverted_twice",
     "difference { box { 0, 3 } union { box { 1, 2 } box { <1, 1, 1.5>, 2 } inverse inverse } }",
     26},
    {"lens", "intersection { sphere { 0, 1 } sphere { x, 1 } rotate 33 }", pi * 5 / 12},
    {"merged", "merge { sphere { 0, 1 } sphere { x, 1 } }", 8 / 3.0 * pi - pi * 5 / 12},
    {"half_a_ball", "intersection { sphere { 0, 2 } plane { y, 0 } }", 2 / 3.0 * pi * 8},
    {"the_other_half", "difference { sphere { 0, 2 } plane { <1, 1, 1>, 0 } }", 2 / 3.0 * pi * 8},
    {"a_box_of_planes",
     "intersection { plane { x, 1 } plane { -x, 1 } plane { y, 2 } plane { y, 0 inverse } "
     "plane { z, 5 } plane { -z, -4 } }",
     4},
    {"a_tetrahedron_of_planes",
     "intersection { plane { <1, 1, 1>, 1 } plane { <-1, -1, 1>, 1 } plane { <1, -1, -1>, 1 } "
     "plane { <-1, 1, -1>, 1 } }",
     8 * std::sqrt(3.0)},
    {"a_height_field_in_a_box",
     "intersection { height_field { function 3, 3 { 0.25 + 0.5*x } } box { 0.125, <0.75, 2, 0.5> } "
     "}",
     0.625 * 0.375 * (0.25 + 0.5 * 0.4375 - 0.125)},
    {"a_height_field_above_its_water",
     "difference { box { <0.625, -1, 0.125>, <0.75, 1, 0.5> } height_field { function 3, 3 { 0.25 "
     "+ "
     "0.5*x } water_level 0.5 } }",
     0.125 * 0.375 * (1 - 0.25 - 0.5 * 0.6875)},
    {"a_lathe_is_filled_to_its_least_radius",
     "intersection { lathe { linear_spline 3, <0.5, -1>, <1, 0>, <0, 1> } "
     "box { <-2, -0.5, -2>, <2, 2, 2> } }",
     pi / 3 * (0.5 * (1 + 0.75 + 0.75 * 0.75) + 1)},
    {"a_lathe_in_pieces",
     "intersection { lathe { bezier_spline 8, <1, -1>, <1, -0.3>, <1, 0.3>, <1, 1>, <0.5, 1>, "
     "<0.5, 0.3>, <0.5, -0.3>, <0.5, -1> } box { <-2, -0.5, -2>, <2, 0.5, 2> } }",
     0.75 * pi},
    {"a_mesh_with_an_inside",
     "difference { box { -1, 1 } mesh { triangle { 0, <0, 3, 0>, <3, 0, 0> } "
     "triangle { 0, <3, 0, 0>, <0, 0, 3> } triangle { 0, <0, 0, 3>, <0, 3, 0> } "
     "triangle { <3, 0, 0>, <0, 3, 0>, <0, 0, 3> } inside_vector y } }",
     7},
};

class PovSolid : public testing::TestWithParam<Solid> {};

/// Returns the volume. Expects that every edge is met as often in one direction as in the other.
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
    const Result<Scene> scene = parsed_scene(GetParam().text);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_NEAR(volume_of_closed(scene), GetParam().volume, 0.004 * GetParam().volume);
}

TEST_P(PovSolid, NormalsPointOutside) {
    const Result<Scene> scene = parsed_scene(GetParam().text);
    ASSERT_TRUE(scene);
    for (size_t m = 0; m < scene->meshes.size(); ++m)
        for (size_t i = 0; i < scene->meshes[m].normals.size(); ++i) {
            const Triangle t = scene->soup.chunks[m].triangle(uint32_t(i / 3));
            const dvec3 flat = glm::cross(t[1] - t[0], t[2] - t[0]);
            if (glm::length(flat) <= 1e-8)
                continue; // rounding to floats may turn a solid's slivers round
            ASSERT_GT(glm::dot(flat, dvec3(scene->meshes[m].normals[i])), 0) << i;
        }
}

INSTANTIATE_TEST_SUITE_P(All, PovSolid, testing::ValuesIn(kSolids),
                         [](const auto& solid) { return std::string(solid.param.name); });

TEST(PovShapes, HeightsOfAPigmentAreItsGray) {
    // povray's trace() tells the same.
    const std::pair<const char*, double> kColors[] = {
        {"<1, 0, 0>", 0.297}, {"<0, 0.5, 0>", 0.2945}, {"<0, 0, 1>", 0.114}, {"0.5", 0.5}};
    for (const auto& [color, height] : kColors)
        for (const Triangle& t : triangles_of(parsed_scene(
                 std::string("height_field { function 3, 3 { pigment { rgb ") + color + " } } }")))
            for (size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(t[i].y, height, 1e-4) << color;
}

double area(const std::string& text) {
    double sum = 0;
    for (const Triangle& t : triangles_of(parsed_scene(text)))
        sum += 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
    return sum;
}

TEST(PovShapes, FlatOnesHaveTheirArea) {
    EXPECT_NEAR(area("disc { <1, 2, 3>, <1, 1, 0>, 2, 1 }"), 3 * pi, 0.01);
    EXPECT_NEAR(
        area("polygon { 10, <0, 0>, <3, 0>, <3, 3>, <0, 3>, <0, 0>, <1, 1>, <1, 2>, <2, 2>, "
             "<2, 1>, <1, 1> }"),
        8, 1e-9);
    EXPECT_NEAR(area("cylinder { 0, y, 1 open }"), 2 * pi, 0.01);
    EXPECT_NEAR(area("triangle { 0, 2*x, 2*y }"), 2, 1e-9);
}

TEST(PovShapes, ParametricOnesEndAtTheirContainer) {
    const std::string plane = "parametric { function { u } function { v } function { 0 } ";
    EXPECT_NEAR(area(plane + "<0, 0>, <2, 0.5> }"), 0.5, 1e-6);
    EXPECT_NEAR(area(plane + "<-1, -1>, <1, 1> contained_by { sphere { 0, 1 } } }"), pi, 0.01);
    EXPECT_NEAR(area("parametric { function { cos(u) * cos(v) } function { sin(v) }, "
                     "function { sin(u) * cos(v) }, <0, -pi/2>, <2*pi, pi/2> "
                     "contained_by { box { -2, <2, 0, 2> } } }"),
                2 * pi, 0.01);
}

TEST(PovShapes, ClippedOnesAreOpen) {
    EXPECT_NEAR(area("sphere { 0, 1 clipped_by { plane { y, 0 } } }"), 2 * pi, 0.01);
    EXPECT_NEAR(area("box { 0, 2 clipped_by { box { 1, 3 } } translate 5 }"), 3, 1e-5);
    EXPECT_NEAR(area("#declare B = box { 0, 1 } box { 0, 2 clipped_by { B scale 2 translate 1 } }"),
                3, 1e-5);
    EXPECT_NEAR(area("box { 0, 2 translate 5 clipped_by { box { 1, 3 } } }"), 0, 1e-9);
    EXPECT_NEAR(area("box { 0, 2 bounded_by { box { 1, 3 } } clipped_by { bounded_by } }"), 3,
                1e-5);
    EXPECT_NEAR(area("difference { box { 0, 2 } cylinder { <1, 1, -1>, <1, 1, 3>, 0.5 open } }"),
                24 - 0.5 * pi + 2 * pi, 0.01);
    EXPECT_NEAR(
        area("intersection { box { 0, 2 } cylinder { <1, 1, 0.5>, <1, 1, 1.5>, 0.5 open } }"), pi,
        0.01);
}

/// As povray 3.7.0.10 lights them.
TEST(PovShapes, TrianglesWithOneNormalAreFlat) {
    for (const bool differ : {false, true}) {
        const std::string last = differ ? "y + x/9" : "2*y";
        for (const std::string& mesh :
             {"mesh { smooth_triangle { 0, y, x, y, y, " + last + " } }",
              "mesh2 { vertex_vectors { 3, 0, x, y } normal_vectors { 3, y, y, " + last +
                  " } face_indices { 1, <0, 1, 2> } }"}) {
            const Result<Scene> scene = parsed_scene(mesh);
            ASSERT_TRUE(scene) << scene.error().message;
            const std::vector<vec3>& normals = scene->meshes.at(0).normals;
            const bool is_flat = normals.empty() || std::abs(normals[0].z) > 0.9f;
            EXPECT_EQ(is_flat, !differ) << mesh;
        }
    }
}

TEST(PovShapes, PartsOfSolidsKeepTheirLook) {
    const Result<Scene> scene =
        parsed_scene("difference { sphere { 0, 1 pigment { color rgb x } } box { 0, 2 } "
                     "pigment { color rgb y } interior { ior 1.5 } }");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->meshes.size(), 2u);
    for (size_t m = 0; m < 2; ++m) {
        const bool is_box = scene->materials[scene->meshes[m].material].color == vec3(0, 1, 0);
        EXPECT_EQ(scene->materials[scene->meshes[m].material].ior, 1.5);
        const Chunk& chunk = scene->soup.chunks[m];
        for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
            const Triangle t = chunk.triangle(prim);
            if (is_box) { // the box's faces face into the box, which is taken away
                const dvec3 flat = glm::cross(t[1] - t[0], t[2] - t[0]);
                EXPECT_GE(std::min({flat.x, flat.y, flat.z}), -1e-12);
            }
            for (size_t i = 0; !is_box && i < 3; ++i) // the sphere's normals between its corners
                EXPECT_GT(
                    glm::dot(dvec3(scene->meshes[m].normals[3 * prim + i]), glm::normalize(t[i])),
                    0.99999);
        }
    }
}

TEST(PovShapes, VerticesLieOnTheSphereWhereSomethingAsksForPlaces) {
    ImportOptions within;
    within.tolerance = 0.001;
    const std::string plain = "sphere { 0, 1 }";
    for (const Result<Scene>& scene :
         {parse_pov(plain, "x.pov", within), parsed_scene("sphere { 0, 1 pigment { bozo } }"),
          parsed_scene("sphere { 0, 1 normal { bumps } }"),
          parsed_scene("difference { sphere { 0, 1 } sphere { 9*x, 1 } }")})
        for (const Triangle& t : triangles_of(scene))
            for (const dvec3& corner : t)
                ASSERT_NEAR(glm::length(corner), 1, 1e-7);
}

/// Returns the area within the polygon of the outermost corners at y = 0, around the origin.
double area_at_the_equator(const std::vector<Triangle>& triangles) {
    std::map<int, dvec2> corners; // by their angles, in millionths of a turn
    for (const Triangle& t : triangles)
        for (const dvec3& corner : t)
            if (std::abs(corner.y) < 1e-9) {
                const dvec2 at(corner.z, corner.x);
                const double turns = std::atan2(at.y, at.x) / (2 * std::numbers::pi);
                dvec2& outermost = corners[int(std::round(1e6 * turns) + 1e6) % 1'000'000];
                if (glm::length(at) > glm::length(outermost))
                    outermost = at;
            }
    double sum = 0;
    dvec2 before = corners.empty() ? dvec2(0) : corners.rbegin()->second;
    for (const auto& [angle, at] : corners) {
        sum += 0.5 * (before.x * at.y - before.y * at.x);
        before = at;
    }
    return sum;
}

TEST(PovShapes, OutlinesAreAsLargeAsTheTrueOnes) {
    for (const auto& [words, area] :
         {std::pair("sphere { 0, 2 }", 4.0), std::pair("cylinder { 0, y, 3 }", 9.0),
          std::pair("cone { 0, 2, y, 1 open }", 4.0), std::pair("torus { 2, 1 }", 9.0),
          std::pair("lathe { linear_spline 2, <2, 0>, <3, 1> }", 4.0)}) {
        const double found = area_at_the_equator(triangles_of(parsed_scene(words)));
        EXPECT_NEAR(found / std::numbers::pi, area, 1e-5) << words;
    }
}

/// Returns how far the triangles, whose corners lie on the unit sphere or off it, reach inside it.
double max_off_the_ball(const std::vector<Triangle>& triangles) {
    double most = 0;
    for (const Triangle& t : triangles) {
        most = std::max(most, 1 - glm::length(t[0] + t[1] + t[2]) / 3);
        for (size_t i = 0; i < 3; ++i)
            most = std::max(most, 1 - glm::length(t[i] + t[(i + 1) % 3]) / 2);
    }
    return most;
}

/// In povray a surface leads into an interior or out of it, whichever way its triangles run.
TEST(PovShapes, MeshesWithAnInteriorFaceOutside) {
    const std::string outward =
        "triangle { 0, y, x } triangle { 0, x, z } triangle { 0, z, y } triangle { x, y, z }";
    const std::string inward =
        "triangle { 0, x, y } triangle { 0, z, x } triangle { 0, y, z } triangle { x, z, y }";
    for (const std::string& mesh : {outward, inward})
        for (const std::string interior : {"", "interior { ior 1.5 }"})
            for (const std::string placed : {"", "scale <-1, 1, 1>"}) {
                const double volume =
                    volume_of_closed(parsed_scene("mesh { " + mesh + interior + placed + " }"));
                const bool faces_inside = mesh == inward && interior.empty();
                EXPECT_NEAR(volume, (faces_inside ? -1 : 1) / 6.0, 1e-6)
                    << mesh << interior << placed;
            }
}

TEST(PovShapes, FacetsLieWithinTheTolerance) {
    const auto cut = [](std::optional<double> tolerance) {
        ImportOptions options;
        options.tolerance = tolerance;
        return triangles_of(parse_pov("sphere { 0, 1 }", "x.pov", options));
    };
    for (const double tolerance : {kMaxTolerance, 0.1, 0.01, 0.001, kMinTolerance}) {
        EXPECT_LE(max_off_the_ball(cut(tolerance)), tolerance + 1e-7) << tolerance;
        EXPECT_GE(max_off_the_ball(cut(tolerance)), tolerance / 4) << tolerance;
    }
    EXPECT_NEAR(max_off_the_ball(cut({})), 0.00046, 0.00001); // as docs/reference/pov.md says
    for (const Triangle& t : cut({}))
        for (const dvec3& corner : t)
            ASSERT_NEAR(glm::length(corner), 1.00023, 0.00001); // likewise
}

TEST(PovShapes, ManyRoundThingsAreCutMoreCoarsely) {
    const std::string loop = "#for (I, 1, 20000) sphere { I*x, 0.4 } #end";
    const size_t triangles = triangles_of(parsed_scene(loop)).size();
    EXPECT_LE(triangles, 3'000'000u);
    EXPECT_GE(triangles, 20'000u * 60);
}

TEST(PovShapes, PlanesKeepTheirPlaceNearTheScene) {
    const Result<Scene> scene = parsed_scene("sphere { <7, 8, 9>, 1 } plane { <1, 2, 3>, 4 }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->meshes.front().name, "plane") << "it hides what lies in it";
    const Chunk& plane = scene->soup.chunks.front();
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
        const Result<Scene> scene = parsed_scene(fmt::format("text {{ {} }}", c.text));
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
