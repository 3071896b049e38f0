// SPDX-License-Identifier: Apache-2.0
// DoubleDouble keeps the bounds that its header states, compared with rational arithmetic.
#include "core/exact/double_double.h"

#include "tests/exact.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

using test::Rational;

Rational exact(const DoubleDouble& x) {
    return Rational(x.hi) + Rational(x.lo);
}

/// Makes doubles of many magnitudes, often with few bits, so that sums cancel.
class CancellingNumbers {
public:
    double next() {
        const double mantissa = double(engine_() >> 11) * 0x1p-52 - 1;
        return std::ldexp(engine_() % 4 ? mantissa : std::round(mantissa * 8) / 8,
                          int(engine_() % 60) - 30);
    }
    /// Returns hi + lo, which now and then is close to minus `other`.
    DoubleDouble near(const DoubleDouble& other) {
        if (engine_() % 3)
            return two_sum(next(), next() * 0x1p-50);
        return two_sum(-other.hi, other.lo * next());
    }

private:
    std::mt19937_64 engine_{5};
};

TEST(DoubleDouble, KeepsItsBounds) {
    constexpr double v = 0x1p-53;
    CancellingNumbers numbers;
    for (int i = 0; i < 30000; ++i) {
        const DoubleDouble a = two_sum(numbers.next(), numbers.next() * 0x1p-50);
        const DoubleDouble b = numbers.near(a);
        ASSERT_EQ(exact(two_sum(a.hi, b.hi)), Rational(a.hi) + Rational(b.hi));
        ASSERT_EQ(exact(two_product(a.hi, b.hi)), Rational(a.hi) * Rational(b.hi));
        const Rational sizes = abs(exact(a)) + abs(exact(b));
        const Rational product = abs(exact(a) * exact(b));
        ASSERT_LE(abs(exact(a + b) - (exact(a) + exact(b))), Rational(4 * v * v) * sizes);
        ASSERT_LE(abs(exact(a * b) - exact(a) * exact(b)), Rational(9 * v * v) * product);
        ASSERT_LE(abs(exact(a * b.hi) - exact(a) * Rational(b.hi)),
                  Rational(4 * v * v) * abs(exact(a) * Rational(b.hi)));
        for (const DoubleDouble& x : {a + b, a * b, a * b.hi})
            ASSERT_EQ(x.hi, x.hi + x.lo) << "hi is the sum rounded";
    }
}

} // namespace
} // namespace ovc
