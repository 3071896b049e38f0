// SPDX-License-Identifier: Apache-2.0
// Rays that change frames in pairs of floats are where exact arithmetic puts them, up to the bound
// of docs/design/numerics.md, "Pairs of floats".
#include "tests/warp/rebased.h"

#include "kdtree/test_soups.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ovc {
namespace {

/// 100 digits, which hold all that is added and multiplied here to 10^-60 at least.
using Exact = boost::multiprecision::cpp_bin_float_100;

constexpr double kUnit = 0x1p-24, kOff = 0x1p-30;

Exact value(const FloatPairValue& pair, int exponent = 0) {
    return ldexp(Exact(pair.hi) + Exact(pair.lo), exponent);
}
Exact largest(const std::array<Exact, 3>& v) {
    Exact most = 0;
    for (const Exact& component : v)
        most = std::max<Exact>(most, abs(component));
    return most;
}

/// A ray in the frame of a portal, exactly, and the part of it in the box.
struct ExactRay {
    std::array<Exact, 3> org, dir;
    Exact reach = 0, dir_reach = 0, begin, end, speed;
    bool ends_in_box = true; // at t_max

    ExactRay(const Ray& ray, const Portal& portal) : begin(ray.t_min), end(ray.t_max) {
        for (int row = 0; row < 3; ++row) {
            Exact size = 0, dir_size = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const Exact r(portal.rows[size_t(row)][axis]);
                const Exact from = Exact(ray.org[axis]) - Exact(portal.origin[axis]);
                org[size_t(row)] += r * from;
                dir[size_t(row)] += r * Exact(ray.dir[axis]);
                size += abs(Exact(r * from));
                dir_size += abs(Exact(r * Exact(ray.dir[axis])));
            }
            reach = std::max(reach, size);
            dir_reach = std::max(dir_reach, dir_size);
        }
        speed = largest(dir);
        for (size_t axis = 0; axis < 3; ++axis) {
            const Exact lo(portal.box.lo[int(axis)]), hi(portal.box.hi[int(axis)]);
            if (dir[axis] == 0) {
                if (org[axis] < lo || org[axis] > hi)
                    end = begin - 1;
                continue;
            }
            const Exact a = (lo - org[axis]) / dir[axis], b = (hi - org[axis]) / dir[axis];
            begin = std::max<Exact>(begin, std::min(a, b));
            if (std::max(a, b) < end)
                ends_in_box = false;
            end = std::min<Exact>(end, std::max(a, b));
        }
    }
};

/// Portals and rays that are hard in several ways: far away, grazing, of all lengths.
class Cases {
public:
    explicit Cases(uint32_t seed) : random_(seed) {}

    Portal portal() {
        Portal portal;
        const double scale = std::ldexp(1.5, int(random_.below(40)) - 20);
        dvec3 a = glm::normalize(random_.point(-1, 1));
        const dvec3 b = glm::normalize(glm::cross(a, random_.point(-1, 1)));
        portal.rows = {scale * a, scale * b, scale * glm::cross(a, b)};
        if (random_.below(3) == 0)
            portal.rows[0] += portal.rows[1] * random_(-9, 9); // sheared
        const double away = std::array{0.0, 3.0, 1e7}[random_.below(3)] / scale;
        portal.origin = random_.point(-1, 1) * away;
        for (int axis = 0; axis < 3; ++axis) {
            portal.box.lo[axis] = random_(-1, 0.5);
            portal.box.hi[axis] = portal.box.lo[axis] + random_(1e-6, 0.5);
        }
        return portal;
    }

    Ray ray(const Portal& portal) {
        const Box& box = portal.box;
        const dvec3 target = box.lo + (box.hi - box.lo) * random_.point(-0.05, 1.05);
        dvec3 dir = random_.point(-1, 1);
        for (int axis = 0; axis < 3; ++axis)
            if (random_.below(4) == 0)
                dir[axis] *= std::array{0.0, 1e-4, 1e-9, 1e-13}[random_.below(4)];
        if (dir == dvec3(0))
            dir.x = 1;
        const double distance = std::ldexp(random_(0.5, 1), int(random_.below(15)) - 2);
        const dvec3 org = target - dir * distance;
        const int exponent = int(random_.below(3)) * 700 - 700;
        const glm::dmat3 to_frame = glm::transpose(rows(portal));
        const auto to_world = [&](const dvec3& v) { return glm::inverse(to_frame) * v; };
        Ray ray;
        ray.org = portal.origin + to_world(org);
        ray.dir = to_world(dir);
        for (int axis = 0; axis < 3; ++axis)
            ray.dir[axis] = std::ldexp(ray.dir[axis], exponent);
        const double t = std::ldexp(distance, -exponent); // at the target
        ray.t_min = std::array{0.0, 0.9 * t, -t}[random_.below(3)];
        ray.t_max = std::array{double(INFINITY), t, 1.01 * t}[random_.below(3)];
        return ray;
    }
    float local_t() { return float(random_(0, 4)); }

private:
    static glm::dmat3 rows(const Portal& portal) {
        return {portal.rows[0], portal.rows[1], portal.rows[2]}; // as columns
    }

    test::Random random_;
};

void expect_right(const Rebased& local, const ExactRay& exact) {
    const Exact enter = value(local.enter, -local.exponent);
    const Exact speed = value(local.speed, local.exponent);
    ASSERT_LE(abs(Exact(speed / exact.speed - 1)), 0x1p-30);
    float longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Exact at = exact.org[size_t(axis)] + exact.dir[size_t(axis)] * enter;
        ASSERT_LE(abs(Exact(at - Exact(local.org[axis]))), kUnit * (1 + 0x1p-7) + kOff);
        ASSERT_LE(std::abs(local.org[axis]), 1 + 0x1p-7) << "within the box";
        const Exact unit = exact.dir[size_t(axis)] / exact.speed;
        ASSERT_LE(abs(Exact(unit - Exact(local.dir[axis]))), kUnit + kOff);
        longest = std::max(longest, std::abs(local.dir[axis]));
    }
    ASSERT_EQ(longest, 1.0f);
    const Exact late = (enter - exact.begin) * exact.speed;
    ASSERT_LE(late, kOff) << "it begins where the box or the ray does";
    ASSERT_LE(-late, Exact(local.early) + kOff) << "and not earlier than it says";
    const Exact length = (exact.end - enter) * exact.speed;
    ASSERT_GE(Exact(local.t_end), length * (1 - kOff) - kOff);
    if (exact.ends_in_box) {
        ASSERT_LE(Exact(local.t_end), length * (1 + 6 * kUnit) + kOff) << "it ends at t_max";
    }
}

TEST(Rebased, IsWhereExactArithmeticPutsIt) {
    Cases cases(1);
    size_t decided = 0, decidable = 0;
    for (int i = 0; i < 4000 && !testing::Test::HasFatalFailure(); ++i) {
        SCOPED_TRACE(i);
        const Portal portal = cases.portal();
        const RayState state{.ray = cases.ray(portal)};
        const ExactRay exact(state.ray, portal);
        const Rebased local = rebased(state, portal);
        const Exact reach = std::max<Exact>(
            exact.reach, exact.dir_reach * abs(Exact(value(local.enter, -local.exponent))));
        const bool is_near = reach < 4000;
        if (exact.end - exact.begin > kOff / exact.speed) {
            ASSERT_TRUE(local.meets);
            decidable += is_near;
            decided += is_near && local.decidable;
        }
        if (local.meets && local.decidable) {
            ASSERT_LT(reach, 4100);
            expect_right(local, exact);
        }
    }
    EXPECT_GT(decidable, 500u);
    EXPECT_EQ(decided, decidable);
}

TEST(Rebased, TimesOfTwoFramesAgree) {
    Cases cases(2);
    size_t asked = 0;
    for (int i = 0; i < 4000; ++i) {
        const Portal portal = cases.portal();
        Portal other = portal;
        for (dvec3& row : other.rows)
            row *= 0.37;
        other.origin += glm::dvec3(0.2) / portal.stretch();
        const RayState state{.ray = cases.ray(portal)};
        const Rebased from = rebased(state, portal), to = rebased(state, other);
        if (!from.meets || !to.meets || !from.decidable || !to.decidable)
            continue;
        const float t = cases.local_t();
        float error = 0;
        const float there = moved(t, from, to, error);
        const Exact exact = ((value(from.enter) - value(to.enter)) + Exact(t) / value(from.speed)) *
                            value(to.speed);
        // The error is to hold the rounding of a sum with it besides.
        ASSERT_LE(abs(Exact(Exact(there) - exact)), Exact(error) * 0.75) << i;
        ++asked;
    }
    EXPECT_GT(asked, 200u);
}

TEST(Rebased, WhatFloatsCannotHoldIsUndecidable) {
    Portal portal;
    portal.box = {dvec3(-1), dvec3(1)};
    const auto decidable = [&](const Ray& ray) {
        const Rebased local = rebased(RayState{.ray = ray}, portal);
        EXPECT_TRUE(local.meets);
        return local.decidable;
    };
    EXPECT_TRUE(decidable({dvec3(-4000, 0, 0), 0, dvec3(1, 0, 0)}));
    EXPECT_FALSE(decidable({dvec3(-5000, 0, 0), 0, dvec3(1, 0, 0)}));
    EXPECT_FALSE(decidable({dvec3(-1e30, 0, 0), 0, dvec3(1, 0, 0)}));
    EXPECT_FALSE(decidable({dvec3(-1e300, 0, 0), 0, dvec3(1, 0, 0)}));
    EXPECT_TRUE(decidable({dvec3(-3, 0, 0), 0, dvec3(1e270, 0, 0)}));
    EXPECT_FALSE(decidable({dvec3(-3, 0, 0), 0, dvec3(1e290, 0, 0)}));
    EXPECT_FALSE(decidable({dvec3(-3, 0, 0), 0, dvec3(1e-290, 0, 0)}));
    portal.rows = {dvec3(1e20, 0, 0), dvec3(0, 1e20, 0), dvec3(0, 0, 1e20)};
    EXPECT_FALSE(decidable({dvec3(-3e-20, 0, 0), 0, dvec3(1, 0, 0)}));
    EXPECT_FALSE(rebased(RayState{}, portal).meets) << "no ray";
}

} // namespace
} // namespace ovc
