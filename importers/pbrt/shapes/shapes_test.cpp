// SPDX-License-Identifier: Apache-2.0
// These tests compare PBRT's shapes with their equations, their areas and their sides.
#include "importers/pbrt/shapes/shapes.h"
#include "importers/test_files.h"

#include <functional>
#include <map>
#include <numbers>

namespace ovc {
namespace {

using std::numbers::pi;

std::vector<Triangle> shape(const std::string& text, std::optional<double> tolerance = {}) {
    const TestFolder folder;
    ImportOptions options;
    options.tolerance = tolerance;
    return triangles_of(load(folder.write("a.pbrt", "Shape " + text), options));
}

double area_of(const std::vector<Triangle>& triangles) {
    double area = 0;
    for (const Triangle& t : triangles)
        area += glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) / 2;
    return area;
}

Box bounds_of(const std::vector<Triangle>& triangles) {
    Box box;
    for (const Triangle& t : triangles)
        box.add(ovc::bounds_of(t));
    return box;
}

/// Counts each edge one way less the other. A count of 0 everywhere means a closed surface whose
/// triangles are wound alike.
bool is_closed(const std::vector<Triangle>& triangles) {
    std::map<std::array<double, 6>, int> edges;
    for (const Triangle& t : triangles)
        for (int i = 0; i < 3; ++i) {
            const dvec3 a = t[size_t(i)], b = t[size_t((i + 1) % 3)];
            ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
            --edges[{b.x, b.y, b.z, a.x, a.y, a.z}];
        }
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

/// An equation is negative inside. If its gradient is 1 long, it is a distance.
using Equation = std::function<double(const dvec3&)>;

void lies_on(const std::vector<Triangle>& triangles, const Equation& f, double tolerance,
             const char* name) {
    ASSERT_FALSE(triangles.empty()) << name;
    for (const Triangle& t : triangles) {
        for (const dvec3& corner : t)
            EXPECT_NEAR(f(corner), 0, 1e-6) << name;
        const dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
        EXPECT_NEAR(f(middle), 0, tolerance) << name;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(f(0.5 * (t[size_t(i)] + t[size_t((i + 1) % 3)])), 0, tolerance) << name;
        const dvec3 out = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
        EXPECT_GT(f(middle + 0.05 * out), f(middle - 0.05 * out)) << name << ": outwards";
        EXPECT_GT(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])), 0) << name;
    }
}

TEST(PbrtShapes, QuadricsLieOnTheirEquationsAndFaceOutwards) {
    const double tolerance = pbrt::kTolerance;
    const auto ball = [](const dvec3& p) { return glm::length(p) - 2; };
    const auto tube = [](const dvec3& p) { return std::hypot(p.x, p.y) - 2; };
    lies_on(shape("\"sphere\" \"float radius\" 2"), ball, 2 * tolerance, "sphere");
    lies_on(
        shape("\"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" .5 \"float phimax\" "
              "100"),
        ball, 2 * tolerance, "part of a sphere");
    lies_on(shape("\"cylinder\" \"float radius\" 2"), tube, 2 * tolerance, "cylinder");
    lies_on(shape("\"cylinder\" \"float radius\" 2 \"float phimax\" 10"), tube, 2 * tolerance,
            "a sliver of a cylinder");
    lies_on(
        shape("\"disk\" \"float radius\" 2 \"float height\" 3"),
        [](const dvec3& p) { return p.z - 3; }, 1e-9, "disk");
    lies_on(
        shape("\"cone\" \"float radius\" 2 \"float height\" 2"),
        [](const dvec3& p) { return std::hypot(p.x, p.y) - (2 - p.z); }, 2 * tolerance, "cone");
    lies_on(
        shape("\"paraboloid\" \"float radius\" 2 \"float zmax\" 4"),
        [](const dvec3& p) { return std::hypot(p.x, p.y) - std::sqrt(std::max(p.z, 0.0)); }, 0.06,
        "paraboloid");
    // pbrt lets a line that ends at z = 0 begin there.
    for (const char* points : {"\"point p1\" [1 0 0] \"point p2\" [.8 1 .8]",
                               "\"point p1\" [.8 1 .8] \"point p2\" [1 0 0]"})
        lies_on(
            shape(std::string("\"hyperboloid\" ") + points),
            [](const dvec3& p) {
                const double v = p.z / 0.8;
                return std::hypot(p.x, p.y) - std::hypot(1 - 0.2 * v, v);
            },
            0.02, points);
}

TEST(PbrtShapes, QuadricsLieWithinTheToleranceThatIsAskedFor) {
    const auto ball = [](const dvec3& p) { return glm::length(p) - 1; };
    const auto tube = [](const dvec3& p) { return std::hypot(p.x, p.y) - 1; };
    size_t fewer = 0;
    for (const double tolerance : {kMaxTolerance, 0.1, 0.01, 0.001, kMinTolerance}) {
        const auto sphere = shape("\"sphere\"", tolerance);
        EXPECT_GT(sphere.size(), 2 * fewer) << tolerance;
        fewer = sphere.size();
        double max_round = 0, max_flat = 0;
        for (const Triangle& t : sphere)
            max_round = std::max(max_round, -ball((t[0] + t[1] + t[2]) / 3.0));
        for (const Triangle& t : shape("\"cylinder\"", tolerance))
            max_flat = std::max(max_flat, -tube((t[0] + t[1] + t[2]) / 3.0));
        EXPECT_LE(max_round, tolerance);
        EXPECT_GE(max_round, tolerance / 4);
        EXPECT_LE(max_flat, tolerance);
        EXPECT_GE(max_flat, tolerance / 4);
    }
}

TEST(PbrtShapes, QuadricsHaveTheAreaAndTheBoundsTheyShould) {
    const double share = 2 * pbrt::kTolerance;
    const auto sphere = shape("\"sphere\" \"float radius\" 3");
    EXPECT_TRUE(is_closed(sphere));
    EXPECT_NEAR(area_of(sphere), 36 * pi, 36 * pi * share);
    EXPECT_EQ(bounds_of(sphere).lo, dvec3(-3));
    EXPECT_EQ(bounds_of(sphere).hi, dvec3(3));
    const auto half = shape("\"sphere\" \"float phimax\" 180");
    EXPECT_NEAR(area_of(half), 2 * pi, 2 * pi * share);
    EXPECT_EQ(bounds_of(half).lo.y, 0);
    const auto ring =
        shape("\"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float phimax\" 90");
    EXPECT_NEAR(area_of(ring), 3 * pi / 4, pi * share);
    EXPECT_EQ(bounds_of(ring).hi, dvec3(2, 2, 0));
    EXPECT_NEAR(area_of(shape("\"cylinder\" \"float zmin\" -2 \"float zmax\" 1")), 6 * pi,
                6 * pi * share);
    EXPECT_NEAR(area_of(shape("\"cone\"")), pi * std::sqrt(2), pi * 1.5 * share);
    // The area of a paraboloid is pi/6 ((1 + 4)^1.5 - 1).
    EXPECT_NEAR(area_of(shape("\"paraboloid\"")), pi / 6 * (std::pow(5, 1.5) - 1), 0.1);
}

TEST(PbrtShapes, QuadricsWithoutASurfaceAreLeftOut) {
    for (const char* text : {"\"sphere\" \"float radius\" 0", "\"sphere\" \"float phimax\" 0",
                             "\"paraboloid\" \"float zmax\" -1", "\"cone\" \"float height\" 1e999",
                             "\"disk\" \"float phimax\" -5"})
        EXPECT_TRUE(shape(text).empty()) << text;
}

TEST(PbrtShapes, LoopSubdivisionQuadruplesAndStaysClosed) {
    const std::string tetrahedron =
        "\"integer indices\" [0 1 2 1 0 3 2 1 3 0 2 3] \"point P\" [0 0 0 "
        "0 1 1 1 0 1 1 1 0]";
    double area = 1e9;
    for (int level = 0; level < 5; ++level) {
        const auto found = shape("\"loopsubdiv\" \"integer nlevels\" " + std::to_string(level) +
                                 " " + tetrahedron);
        EXPECT_EQ(found.size(), size_t(4) << (2 * level));
        EXPECT_TRUE(is_closed(found));
        // The limit surface is approached from inside.
        if (level > 1) {
            EXPECT_LT(std::abs(area_of(found) - area), area / 4);
        }
        area = area_of(found);
    }
    EXPECT_EQ(shape("\"loopsubdiv\" " + tetrahedron).size(), 256u) << "3 levels by default";
    EXPECT_EQ(shape("\"loopsubdiv\" \"integer levels\" 1 " + tetrahedron).size(), 16u);
}

TEST(PbrtShapes, LoopSubdivisionKeepsAFlatSheetFlat) {
    // The sheet's corners are creases that shrink; its plane and the straight sides stay.
    std::string points, indices;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            points += std::to_string(x) + " " + std::to_string(y) + " 7 ";
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            for (const int i : {0, 1, 5, 0, 5, 4})
                indices += std::to_string(4 * y + x + i) + " ";
    const auto found = shape("\"loopsubdiv\" \"integer nlevels\" 2 \"integer indices\" [" +
                             indices + "] \"point P\" [" + points + "]");
    EXPECT_EQ(found.size(), 18u * 16);
    const Box box = bounds_of(found);
    EXPECT_EQ(box.lo.z, 7);
    EXPECT_EQ(box.hi.z, 7);
    EXPECT_NEAR(box.lo.x, 0, 1e-6);
    EXPECT_NEAR(box.hi.y, 3, 1e-6);
}

TEST(PbrtShapes, LoopSubdivisionSurvivesMeshesThatAreNoSurface) {
    for (const char* indices :
         {"0 1 2 0 1 2 0 1 2", "0 1 2 0 1 3 0 1 4 1 0 2", "0 0 0", "0 1 1", "0 1 2 2 1 0"})
        EXPECT_FALSE(shape("\"loopsubdiv\" \"integer nlevels\" 3 \"integer indices\" [" +
                           std::string(indices) + "] \"point P\" [0 0 0 1 0 0 0 1 0 0 0 1 1 1 1]")
                         .empty())
            << indices;
}

TEST(PbrtShapes, HeightFieldsFillTheUnitSquare) {
    const auto found =
        shape("\"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [0 1 2 3 4 5]");
    EXPECT_EQ(found.size(), 4u);
    const Box box = bounds_of(found);
    EXPECT_EQ(box.lo, dvec3(0));
    EXPECT_EQ(box.hi, dvec3(1, 1, 5));
    EXPECT_EQ(found[0], (Triangle{dvec3(0, 0, 0), dvec3(0.5, 0, 1), dvec3(0.5, 1, 4)}));
    EXPECT_TRUE(
        shape("\"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [0 1]").empty());
}

TEST(PbrtShapes, BilinearPatchesAreCutAsTheyBend) {
    EXPECT_EQ(shape("\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]").size(), 2u);
    const auto bent =
        shape("\"bilinearmesh\" \"integer indices\" [0 1 2 3] \"point3 P\" [0 0 0 1 0 0 0 "
              "1 0 1 1 1]");
    EXPECT_GT(bent.size(), 8u);
    for (const Triangle& t : bent)
        for (const dvec3& p : t)
            EXPECT_NEAR(p.z, p.x * p.y, 1e-6);
}

TEST(PbrtShapes, BilinearPatchesHaveTheirNormals) {
    const TestFolder folder;
    const Result<Scene> scene = load(folder.write(
        "a.pbrt", "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"normal N\" "
                  "[-1 -1 1  1 -1 1  -1 1 1  1 1 1]"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Chunk& chunk = scene->soup.chunks.at(0);
    const std::vector<vec3>& normals = scene->meshes[0].normals;
    ASSERT_EQ(normals.size(), 3 * chunk.size());
    for (size_t i = 0; i < normals.size(); ++i) {
        const vec3 corner(chunk.triangle(uint32_t(i / 3))[i % 3]);
        const vec3 expected = glm::normalize(vec3(2.0f * vec2(corner) - 1.0f, 1));
        EXPECT_LT(glm::length(normals[i] - expected), 1e-3f) << i;
    }
}

TEST(PbrtShapes, PlyMeshesAreReadAndMoved) {
    const TestFolder folder;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face 1\nproperty list uchar int "
        "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    folder.write("one.ply", ply);
    folder.write("two.ply.gz", gzip(ply));
    const auto found = triangles_of(load(
        folder.write("a.pbrt", "Shape \"plymesh\" \"string filename\" \"one.ply\" Translate 0 0 5 "
                               "Shape \"plymesh\" \"string filename\" [\"two.ply\"]")));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0], (Triangle{dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)}));
    EXPECT_EQ(found[1], (Triangle{dvec3(0, 0, 5), dvec3(1, 0, 5), dvec3(0, 1, 5)}));
}

} // namespace
} // namespace ovc
