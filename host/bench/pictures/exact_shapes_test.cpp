// SPDX-License-Identifier: Apache-2.0
// Compares distances and first hits with values computed by hand, and triangles with both.
#include "host/bench/pictures/exact_shapes.h"
#include "host/bench/pictures/tessellation.h"
#include "importers/readers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {
namespace {

TEST(ExactShapes, KnowTheDistanceToThem) {
    const ExactShape sphere = exact_sphere({1, 2, 3}, 2);
    EXPECT_DOUBLE_EQ(sphere.distance({1, 2, 8}), 3);
    EXPECT_DOUBLE_EQ(sphere.distance({1, 2, 3}), -2);
    const ExactShape torus = exact_torus({0, 1, 0}, 3, 1);
    EXPECT_DOUBLE_EQ(torus.distance({0, 1, 0}), 2);
    EXPECT_DOUBLE_EQ(torus.distance({0, 1, -3}), -1);
    EXPECT_DOUBLE_EQ(torus.distance({3 + 3, 1 + 4, 0}), 4); // a triangle of sides 3, 4, 5
    EXPECT_DOUBLE_EQ(torus.radius, 4);
    const ExactShape cone = exact_cone({0, 0, 0}, 4, 3, 0); // its side is 5 long
    EXPECT_DOUBLE_EQ(cone.distance({0, -2, 0}), 2);
    EXPECT_DOUBLE_EQ(cone.distance({0, 5, 0}), 2);
    EXPECT_DOUBLE_EQ(cone.distance({7, 0, 0}), 3);
    EXPECT_NEAR(cone.distance({2 + 3, 1.5 + 4, 0}), 5, 1e-15); // off the middle of the side
    EXPECT_NEAR(cone.distance({0, 0.25, 0}), -0.25, 1e-15);
    const ExactShape frustum = exact_cone({0, 0, 0}, 1, 2, 0.5);
    EXPECT_DOUBLE_EQ(frustum.distance({0.25, 3, 0}), 1);
    EXPECT_LT(frustum.distance({0.7, 1, 0}), 0);
    EXPECT_GT(frustum.distance({0.8, 1, 0}), 0);
}

TEST(ExactShapes, AreMetWhereTheFormulaSays) {
    const std::vector<ExactShape> shapes = {exact_sphere({0, 0, 0}, 1)};
    Ray ray;
    ray.dir = {0, 0, -2}; // t is in lengths of the direction
    for (const double x : {0.0, 0.3, 0.9, 0.999, 0.999999}) {
        ray.org = {x, 0, 5};
        EXPECT_NEAR(first_hit(shapes, ray, 100), (5 - std::sqrt(1 - x * x)) / 2, 1e-9) << x;
    }
    ray.org = {1.000001, 0, 5};
    EXPECT_EQ(first_hit(shapes, ray, 100), INFINITY);
    ray.org = {0, 0, 5};
    EXPECT_EQ(first_hit(shapes, ray, 1), INFINITY) << "beyond the end";
}

TEST(ExactShapes, TellHowFarAnswersAreOff) {
    const std::vector<ExactShape> shapes = {exact_sphere({0, 0, 0}, 2), exact_sphere({9, 0, 0}, 1)};
    std::vector<Ray> rays(3);
    rays[0].org = {0, 0, 10}; // hits the first at t = 8
    rays[1].org = {9, 0, 10}; // hits the second at t = 9
    rays[2].org = {5, 0, 10}; // passes between them
    for (Ray& ray : rays)
        ray.dir = {0, 0, -1};
    std::vector<Hit> hits(3);
    hits[0].t = 8, hits[0].id = {0, 0};
    hits[1].t = 9, hits[1].id = {0, 0};
    const std::vector<double> right = first_hits(shapes, rays, 100);
    const ShapeError none = shape_error(shapes, rays, hits, right);
    EXPECT_NEAR(none.largest_t, 0, 1e-12);
    EXPECT_NEAR(none.rms_distance, 0, 1e-12);
    EXPECT_EQ(none.unlike, 0u);
    hits[0].t = 8.08;
    const ShapeError some = shape_error(shapes, rays, hits, right);
    EXPECT_NEAR(some.largest_t, 0.01, 1e-12);
    EXPECT_NEAR(some.rms_t, 0.01 / std::sqrt(2), 1e-12);
    EXPECT_NEAR(some.largest_distance[0], 0.08 / 2, 1e-12) << "in radii";
    EXPECT_NEAR(some.largest_distance[1], 0, 1e-12);
    EXPECT_NEAR(some.rms_distance, 0.04 / std::sqrt(2), 1e-12);
    hits[1] = {};
    hits[2].t = 3, hits[2].id = {0, 0};
    EXPECT_EQ(shape_error(shapes, rays, hits, right).unlike, 2u);
}

/// The corners that the reader of scenes makes of the words lie on the formulas' surfaces.
TEST(ExactShapes, AreWhatTheirWordsSay) {
    const std::vector<ExactShape> shapes = example_shapes();
    for (const ExactShape& shape : shapes) {
        ImportOptions options;
        options.tolerance = 0.01;
        const Result<Scene> scene =
            parse_pov(povray_scene(std::span(&shape, 1)), "shapes.pov", options);
        ASSERT_TRUE(scene) << scene.error().message;
        double most = 0;
        for (const Chunk& chunk : scene->soup.chunks)
            for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
                const Triangle t = chunk.triangle(prim);
                for (const dvec3& corner : t)
                    EXPECT_NEAR(shape.distance(corner), 0, 1e-6) << shape.name;
                most = std::max(most, std::abs(shape.distance((t[0] + t[1] + t[2]) / 3.0)));
            }
        EXPECT_GT(most, 0.001) << shape.name;
        EXPECT_LT(most, 0.01 * shape.radius) << shape.name;
    }
}

} // namespace
} // namespace ovc
