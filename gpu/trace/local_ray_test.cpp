// SPDX-License-Identifier: Apache-2.0
// A ray in the frame of the top-level tree is in the same place as the ray itself, up to the
// roundings that docs/design/numerics.md allows.
#include "gpu/trace/local_ray.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {
namespace {

constexpr double kRounding = 1.125 * OVC_BOUND_UNIT; // of a float in [-1, 1], and of doubles before

Leaf leaf_of(const dvec3& center, double size) {
    const Box bounds{center - dvec3(size), center + dvec3(size)};
    return scene_leaf(bounds);
}

/// Returns a point of the local ray, in the world.
dvec3 world(const Leaf& leaf, const LocalRay& ray, double t) {
    return (dvec3(ray.org) + t * dvec3(ray.dir)) / leaf.frame.scale + leaf.frame.origin;
}

TEST(LocalRay, IsWhereTheRayIs) {
    test::Random random(7);
    for (const double size : {1e-9, 0.3, 4e7})
        for (const double away : {0.0, 1.0, 1e5}) {
            const dvec3 center = random.point(-1, 1) * size * away;
            const Leaf leaf = leaf_of(center, size);
            for (int i = 0; i < 2000; ++i) {
                const dvec3 target = center + random.point(-0.9, 0.9) * size;
                const dvec3 org = target + random.point(-5, 5) * size;
                const double t_target = random(0.1, 10);
                const Ray ray{org, 0, (target - org) / t_target};
                LocalTime time;
                const LocalRay local = local_ray(leaf, ray, 5, i % 2 == 0, time);
                ASSERT_GE(local.t_end, 0.0f);
                ASSERT_EQ(local.asks, 5u | (i % 2 == 0 ? OVC_RAY_ANY_HIT : 0u));
                ASSERT_EQ(
                    std::max({std::abs(local.dir.x), std::abs(local.dir.y), std::abs(local.dir.z)}),
                    1.0f);
                const double t_local = (t_target - time.enter) * time.speed;
                ASSERT_LE(t_local, double(local.t_end));
                // The error is the origin's rounding, and that of the direction over the way.
                const double most = (kRounding + OVC_BOUND_UNIT * (t_local + 1)) / leaf.frame.scale;
                const dvec3 off = world(leaf, local, t_local) - ray.at(t_target);
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_LE(std::abs(off[axis]), most) << size << " " << away;
            }
        }
}

TEST(LocalRay, IsWhereTheRayIsBehindAPortal) {
    test::Random random(8);
    for (const double size : {1e-9, 0.3, 4e7})
        for (int i = 0; i < 4000; ++i) {
            const Leaf leaf = leaf_of(random.point(-1, 1) * size, size);
            Transform transform;
            for (auto& row : transform.rows)
                row = {random(-1, 1), random(-1, 1), random(-1, 1), random(-3, 3) * size};
            if (!is_well_placed(leaf.box, &transform))
                continue;
            const Portal portal = portal_into(leaf.frame, leaf.box, &transform);
            const dvec3 target = transform(leaf.frame.origin + random.point(-0.9, 0.9) * size);
            const dvec3 org = target + random.point(-5, 5) * size;
            const double t_target = random(0.1, 10);
            const Ray ray{org, 0, (target - org) / t_target};
            LocalTime time;
            const LocalRay local = local_ray(portal, ray, 5, false, time);
            ASSERT_GE(local.t_end, 0.0f);
            const double t_local = (t_target - time.enter) * time.speed;
            ASSERT_LE(t_local, double(local.t_end));
            const double most = kRounding + OVC_BOUND_UNIT * (t_local + 1);
            const dvec3 off =
                dvec3(local.org) + t_local * dvec3(local.dir) - portal.to_local(ray.at(t_target));
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_LE(std::abs(off[axis]), most) << size;
        }
}

// From 1e15 sizes of the mesh away, along two of its axes, doubles cannot tell where a ray comes to
// it, nor that it misses it.
TEST(LocalRay, FromFarAwayMayMeetWhatItSeemsToMiss) {
    test::Random random(9);
    const Leaf leaf = leaf_of(dvec3(0), 1);
    const Transform transform{{{{1, 0, 0, 7}, {0, 1e-4, 0, -3}, {0, 0, 1e-4, 2}}}};
    const Portal portal = portal_into(leaf.frame, leaf.box, &transform);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 target = transform(random.point(-1, 1));
        const dvec3 org = target + 1e11 * random.point(-1, 1);
        LocalTime time;
        const LocalRay local = local_ray(portal, Ray{org, 0, target - org}, 0, false, time);
        ASSERT_NE(local.t_end, OVC_NO_RAY);
    }
}

// The second and the third row are multiples of the first, rounded: the determinant is nothing but
// roundings, and by chance as large as if the matrix could be inverted.
TEST(WellPlaced, NothingIsWhereTheMatrixIsSingularButForRoundings) {
    test::Random random(10);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 first = std::exp2(30 * random(-1, 1)) * random.point(-1, 1);
        Transform transform{};
        for (auto& row : transform.rows) {
            const dvec3 v = random(-1, 1) * first;
            row = {v.x, v.y, v.z, random(-1, 1)};
        }
        EXPECT_FALSE(inverse_matrix(transform));
        EXPECT_FALSE(is_well_placed({dvec3(-1), dvec3(1)}, &transform));
    }
}

TEST(WellPlaced, PointsComeBackToWhereTheyWere) {
    test::Random random(11);
    int placed = 0;
    for (int i = 0; i < 1000; ++i) {
        Transform transform{};
        for (auto& row : transform.rows)
            row = {random(-1, 1), random(-1, 1), random(-1, 1), random(-100, 100)};
        if (!is_well_placed({dvec3(-1), dvec3(1)}, &transform))
            continue;
        ++placed;
        const dvec3 point = random.point(-1, 1);
        EXPECT_LT(glm::length((*inverse(transform))(transform(point)) - point), 0x1p-30);
    }
    EXPECT_GT(placed, 950);
}

/// Returns a transform of any kind, which may stretch and shift by up to 2^range.
Transform any_transform(test::Random& random, int range) {
    Transform transform;
    for (auto& row : transform.rows) {
        const double stretch = std::exp2(random(-range, range));
        row = {random(-1, 1) * stretch, random(-1, 1) * stretch, random(-1, 1) * stretch,
               random(-1, 1) * std::exp2(random(-range, range))};
    }
    return transform;
}

TEST(WellMoved, CornersLieBehindAPortalWhereTheirMeshCameToRest) {
    test::Random random(9);
    int moved = 0, refused = 0;
    double largest = 0;
    for (int i = 0; i < 40000; ++i) {
        const Box mesh{random.point(-2, -1), random.point(1, 2)};
        const Transform from = any_transform(random, 6), to = any_transform(random, 12);
        const Leaf scene = scene_leaf(placed_box(mesh, &from));
        if (!is_well_placed(mesh, &from) || !is_well_placed(mesh, &to))
            continue;
        if (!is_well_moved(from, to, scene.grid)) {
            ++refused;
            continue;
        }
        ++moved;
        const Transform way = then(*inverse(from), to);
        const Portal portal = portal_into(scene.frame, scene.grid, &way);
        for (int k = 0; k < 10; ++k) {
            const dvec3 corner = glm::mix(mesh.lo, mesh.hi, random.point(0, 1));
            const dvec3 off = portal.to_local(to(corner)) - scene.frame.to_local(from(corner));
            largest = std::max(largest, max_component(glm::abs(off)));
        }
    }
    EXPECT_LE(largest, 0x1p-30);
    EXPECT_GT(moved, 1000);
    EXPECT_GT(refused, 100);
}

TEST(LocalRay, ThatMissesTheBoxOrHasNoLengthIsNoRay) {
    const Leaf leaf = leaf_of(dvec3(0), 1);
    LocalTime time;
    const auto t_end = [&](const Ray& ray) { return local_ray(leaf, ray, 0, false, time).t_end; };
    EXPECT_EQ(t_end({dvec3(5, 0, 0), 0, dvec3(0, 0, 1)}), OVC_NO_RAY);
    EXPECT_EQ(t_end({dvec3(0, 0, 9), 0, dvec3(0, 0, 1)}), OVC_NO_RAY);
    EXPECT_EQ(t_end({dvec3(0), 0, dvec3(0, 0, 1), -1}), OVC_NO_RAY);
    EXPECT_GE(t_end({dvec3(0), 0, dvec3(0, 0, 1), 0}), 0.0f);
}

TEST(LocalRay, FromTooFarAwayIsForDoublesToDecide) {
    const Leaf leaf = leaf_of(dvec3(0), 1);
    LocalTime time;
    const Ray ray{dvec3(0, 0, -1e9), 0, dvec3(0, 0, 1)};
    EXPECT_EQ(local_ray(leaf, ray, 0, false, time).t_end, OVC_UNDECIDABLE);
}

} // namespace
} // namespace ovc
