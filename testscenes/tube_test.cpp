// SPDX-License-Identifier: Apache-2.0
// Tubes: the count asked for, closed, outwards, with normals; and splines.
#include "testscenes/tube.h"

#include "testscenes/closed_test.h"
#include "testscenes/noise.h"
#include "testscenes/sphere.h"
#include "testscenes/spline.h"

#include <gtest/gtest.h>

#include <limits>

namespace ovc {
namespace {

Surface ball(const TubeGrid& grid, bool with_normals) {
    Surface surface;
    add_tube(surface, grid, with_normals, [&](uint32_t ring, double turns) {
        const dvec2 latitude = circle(0.5 * ring / (grid.along + 1) - 0.25), c = circle(turns);
        return dvec3(latitude.x * c.x, latitude.x * c.y, latitude.y);
    });
    return surface;
}

TEST(Tube, HasTheTrianglesAskedForAndIsClosed) {
    for (const double ratio : {0.05, 0.5, 1.0, 7.0, 1000.0})
        for (uint64_t triangles = kMinTubeTriangles; triangles < 1000; triangles += 14) {
            const TubeGrid grid = tube_grid(triangles, ratio);
            ASSERT_EQ(grid.triangles(), triangles) << ratio;
            const Surface surface = ball(grid, false);
            ASSERT_EQ(surface.corners.size(), 3 * triangles);
            ASSERT_EQ(open_edges(surface.corners), 0u) << triangles << " " << ratio;
            ASSERT_GT(enclosed_volume(surface.corners), 0) << triangles << " " << ratio;
        }
}

TEST(Tube, ALargeOneIsCloseToTheSphere) {
    const Surface surface = ball(tube_grid(50'002, 0.5), true);
    EXPECT_NEAR(enclosed_volume(surface.corners), 4.18879, 0.005);
    ASSERT_EQ(surface.normals.size(), surface.corners.size());
    for (size_t i = 0; i < surface.normals.size(); ++i) // of a unit ball: the corner itself
        ASSERT_LT(glm::length(surface.normals[i] - glm::normalize(surface.corners[i])), 0.01f) << i;
}

TEST(SmoothNormals, AreThoseOfTheSphere) {
    const Corners corners = make_sphere(4);
    const std::vector<vec3> normals = smooth_normals(corners);
    ASSERT_EQ(normals.size(), corners.size());
    for (size_t i = 0; i < normals.size(); ++i) {
        ASSERT_NEAR(glm::length(normals[i]), 1, 1e-6);
        ASSERT_LT(glm::length(normals[i] - corners[i]), 0.02f) << i;
    }
}

TEST(SmoothNormals, EndForCornersThatAreNoNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Corners corners(9, vec3(nan));
    corners[4] = vec3(1, nan, std::numeric_limits<float>::infinity());
    EXPECT_EQ(smooth_normals(corners).size(), 9u);
    EXPECT_TRUE(smooth_normals({}).empty());
}

TEST(Spline, BeginsAndEndsAtItsPointsAndStaysBetween) {
    const double points[] = {1, 5, -2, 7};
    EXPECT_DOUBLE_EQ(spline_at<double>(points, 0), 1);
    EXPECT_DOUBLE_EQ(spline_at<double>(points, 1), 7);
    for (int i = 0; i <= 1000; ++i) {
        const double value = spline_at<double>(points, i / 1000.0);
        EXPECT_GE(value, -2);
        EXPECT_LE(value, 7);
        const double next = spline_at<double>(points, (i + 1) / 1000.0);
        EXPECT_LT(std::abs(next - value), 0.05) << i;
    }
    const double one[] = {3};
    EXPECT_DOUBLE_EQ(spline_at<double>(one, 0.4), 3);
}

} // namespace
} // namespace ovc
