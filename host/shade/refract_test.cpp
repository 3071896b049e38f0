// SPDX-License-Identifier: Apache-2.0
// Tests Snell's law against the textbook's formula in fifty digits: like and unlike media, grazing
// light, the critical angle.
#include "host/shade/refract.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ovc {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

constexpr double kUlp = 0x1p-53;
constexpr double kIndices[] = {1 + 1e-12, 1 - 1e-12, 1 + 1e-15, 1.0003, 1.5, 2.4, 1e3, 1e-3};
const dvec3 kNormal(0, 0, 1);

/// Returns the direction of light that comes down onto z = 0 at this cosine to the plane's normal.
dvec3 at_cosine(double cosine) {
    return {std::sqrt((1 - cosine) * (1 + cosine)), 0, -cosine};
}

/// Returns 1 - (from / to)^2 sin^2, the square of the refracted cosine, for any length of dir.
Real square_of(const dvec3& dir, double from, double to) {
    const Real x = dir.x, z = dir.z, eta = Real(from) / Real(to);
    return 1 - eta * eta * x * x / (x * x + z * z);
}

/// Returns the textbook's refracted direction, where square_of(...) > 0.
std::array<Real, 3> exactly(const dvec3& dir, double from, double to) {
    const Real x = dir.x, z = dir.z, eta = Real(from) / Real(to);
    return {eta * x, 0, -sqrt(square_of(dir, from, to) * (x * x + z * z))};
}

double error_of(const dvec3& found, const std::array<Real, 3>& exact) {
    Real squares = 0;
    for (int i = 0; i < 3; ++i)
        squares += (Real(found[i]) - exact[size_t(i)]) * (Real(found[i]) - exact[size_t(i)]);
    return double(sqrt(squares));
}

/// Returns a bound of the roundings of a few operations, with the amplification that no formula
/// avoids: near the critical angle a small turn of the arriving light turns the leaving light a
/// lot.
double tolerance(const dvec3& dir, double from, double to) {
    const double eta = from / to;
    const double cosine = double(sqrt(square_of(dir, from, to)));
    return 6 * kUlp * (1 + eta + eta * eta * -dir.z / cosine);
}

TEST(Refracted, IsSnellsLawToRoundingAtAnyIndexAndAngle) {
    for (const double ior : kIndices)
        for (const bool entering : {true, false})
            for (int i = 0; i <= 400; ++i) {
                const dvec3 dir = at_cosine(std::pow(10.0, -i * 0.03)); // down to 1e-12
                const double from = entering ? 1 : ior, to = entering ? ior : 1;
                const std::optional<dvec3> out = refracted(dir, kNormal, from, to);
                if (square_of(dir, from, to) <= 0)
                    continue; // the test TheCriticalAngleIsWhereItIs has these
                ASSERT_TRUE(out) << ior << ", cosine " << -dir.z;
                EXPECT_LE(error_of(*out, exactly(dir, from, to)), tolerance(dir, from, to))
                    << ior << ", cosine " << -dir.z;
            }
}

TEST(Refracted, TheCriticalAngleIsWhereItIs) {
    size_t reflected = 0, through = 0;
    for (const double ior : kIndices) {
        const double from = std::max(ior, 1.0), to = std::min(ior, 1.0);
        const Real sine = Real(to) / Real(from), critical = asin(sine);
        for (int exponent = -15; exponent <= -6; ++exponent)
            for (const double side : {-1.0, 1.0}) {
                const Real angle = critical + side * pow(Real(10), exponent);
                const dvec3 dir(double(sin(angle)), 0, -double(cos(angle)));
                const Real exact = square_of(dir, from, to);
                const std::optional<dvec3> out = refracted(dir, kNormal, from, to);
                through += out.has_value();
                reflected += !out;
                EXPECT_TRUE(!out || (is_finite(*out) && out->z <= 4 * kUlp))
                    << ior << " " << exponent;
                // Nearer to the critical angle than this, a rounding of the direction decides.
                const double doubt = 8 * kUlp * (from / to) * (from / to) * dir.z * dir.z;
                if (abs(exact) > doubt) {
                    EXPECT_EQ(out.has_value(), exact > 0) << ior << " " << exponent << " " << side;
                }
            }
    }
    EXPECT_GT(reflected, 40u);
    EXPECT_GT(through, 40u);
}

TEST(Refracted, NothingChangesWhereTheMediaAreOne) {
    for (const dvec3& dir : {dvec3(0.1, 0.2, -0.3), dvec3(3e40, 1, -1e-9), dvec3(0, 0, -1e-50)})
        EXPECT_EQ(refracted(dir, kNormal, 1, 1), dir);
    EXPECT_FALSE(refracted({1, 0, 0}, kNormal, 1, 1)) << "along the plane nothing crosses it";
}

TEST(Refracted, KeepsTheLengthOfTheDirection) {
    for (const double length : {1e-90, 0.25, 1.0, 1e90})
        for (const double ior : {1.5, 1e3}) {
            const std::optional<dvec3> out = refracted(length * at_cosine(0.4), kNormal, 1, ior);
            ASSERT_TRUE(out);
            EXPECT_NEAR(glm::length(*out) / length, 1, 4 * kUlp);
        }
}

TEST(Refracted, ComesBackTheWayItWent) {
    // Going out of a dense medium multiplies the angle by the index, and its rounding by another.
    for (const double ior : {1 + 1e-12, 1.5, 1e3}) {
        const dvec3 dir = at_cosine(0.6);
        const dvec3 inside = *refracted(dir, kNormal, 1, ior);
        const dvec3 back = *refracted(inside, kNormal, ior, 1);
        EXPECT_LT(glm::length(back - dir), 8 * kUlp * ior * ior) << ior;
    }
}

} // namespace
} // namespace ovc
