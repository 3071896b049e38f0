// SPDX-License-Identifier: Apache-2.0
// Compares surely_coplanar(), whose integers wrap around, with exact arithmetic.
#include "core/exact/coplanar.h"

#include "core/exact/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ovc {
namespace {

class RandomDoubles {
public:
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (double(engine_() >> 11) * 0x1p-53);
    }
    uint64_t below(uint64_t n) { return engine_() % n; }

private:
    std::mt19937_64 engine_{7};
};

bool exactly_coplanar(const Triangle& a, const Triangle& b) {
    const Vec3Of<Exact> from = exact(a[0]);
    const Vec3Of<Exact> normal = cross(exact(a[1]) - from, exact(a[2]) - from);
    for (const dvec3& corner : b)
        if (dot(normal, exact(corner) - from).sign() != 0)
            return false;
    return true;
}

/// Returns six corners of the plane z = m x + n y, which are exact.
struct Plane {
    double m, n, size;
    int bits; // of x and y

    Triangle triangle(RandomDoubles& random) const {
        Triangle result;
        for (dvec3& corner : result) {
            const double x = rounded(random(-size, size)), y = rounded(random(-size, size));
            corner = {x, y, m * x + n * y};
        }
        return result;
    }
    double rounded(double x) const {
        const double unit = std::ldexp(size, -bits);
        return std::round(x / unit) * unit;
    }
};

TEST(Coplanar, WhatLiesInAPlaneOfFewBitsIsFound) {
    RandomDoubles random;
    for (const Plane plane : {Plane{1, 1, 1, 20}, Plane{1, -2, 0x1p-99, 20},
                              Plane{0.5, 3, 0x1p66, 30}, Plane{1, 0, 4, 40}, Plane{0, 0, 8, 50}})
        for (int i = 0; i < 1000; ++i) {
            const Triangle a = plane.triangle(random), b = plane.triangle(random);
            ASSERT_TRUE(exactly_coplanar(a, b));
            EXPECT_TRUE(surely_coplanar(a, b)) << plane.m << " " << plane.n << " " << plane.size;
        }
}

TEST(Coplanar, ABitBesideThePlaneIsNotInIt) {
    RandomDoubles random;
    for (const double size : {1.0, 1e-200, 1e-90, 1e90, 1e200, 1e-310})
        for (const int bits : {4, 23, 40, 52})
            for (int i = 0; i < 300; ++i) {
                const Plane plane{1, double(random.below(3)) - 1, size, bits};
                const Triangle a = plane.triangle(random);
                Triangle b = plane.triangle(random);
                double& z = b[random.below(3)].z;
                z = std::nextafter(z, random(-1, 1));
                if (surely_coplanar(a, b)) {
                    EXPECT_TRUE(exactly_coplanar(a, b)) << size << " " << bits;
                }
            }
}

TEST(Coplanar, AxisPlanesAreFoundAtAnySize) {
    RandomDoubles random;
    for (const double size : {1e-300, 0.3, 1e300}) {
        const Plane flat{0, 0, size, 52};
        Triangle a = flat.triangle(random), b = flat.triangle(random);
        for (dvec3& corner : a)
            corner.z = 0.3;
        for (dvec3& corner : b)
            corner.z = 0.3;
        EXPECT_TRUE(surely_coplanar(a, b));
        b[1].z = std::nextafter(0.3, 1.0);
        EXPECT_FALSE(surely_coplanar(a, b));
    }
}

/// Tests volumes that are not zero, but a multiple of 2^128 units.
TEST(Coplanar, WrappedVolumesAreNotTakenForZero) {
    const double far = 0x1p43; // the volume is 6 * 2^129 units
    const Triangle a = {dvec3(0), dvec3(far, 0, 0), dvec3(0, far, 0)};
    const Triangle b = {dvec3(1, 1, far), dvec3(2, 1, far), dvec3(1, 2, far)};
    EXPECT_FALSE(surely_coplanar(a, b));
}

} // namespace
} // namespace ovc
