// SPDX-License-Identifier: Apache-2.0
// Compares Exact with rational arithmetic, over all exponents that doubles have.
#include "core/exact/exact.h"

#include "tests/exact.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

using test::Rational;

class Numbers {
public:
    explicit Numbers(uint64_t seed) : engine_(seed) {}

    uint64_t below(uint64_t n) { return engine_() % n; }
    /// Returns a full mantissa or few bits; now and then with any exponent, denormals among them.
    double next() {
        const int exponent = below(4) ? int(below(60)) - 30 : int(below(2090)) - 1074;
        const double mantissa = double(engine_() >> 11) * 0x1p-52 - 1;
        return std::ldexp(below(3) ? mantissa : std::round(mantissa * 8) / 8, exponent);
    }

private:
    std::mt19937_64 engine_;
};

int sign(const Rational& x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

TEST(Exact, SumsAndProductsHaveNoRounding) {
    for (uint64_t seed = 0; seed < 4000; ++seed) {
        Numbers numbers(seed);
        const double a = numbers.next(), b = numbers.next(), c = numbers.next(),
                     d = numbers.below(3) || !std::isfinite(a * c) ? numbers.next() : -a * c;
        const Exact exact = (Exact(a) - Exact(b)) * Exact(c) + (Exact(b) * Exact(c) + Exact(d));
        const Rational truth = Rational(a) * Rational(c) + Rational(d);
        ASSERT_EQ(exact.sign(), sign(truth)) << "seed " << seed;
        ASSERT_EQ(Exact::quotient(exact, Exact(1)), test::rounded(truth)) << "seed " << seed;
        ASSERT_EQ((exact - exact).sign(), 0);
        ASSERT_EQ((-exact + exact).sign(), 0);
        ASSERT_EQ((-exact).sign(), -exact.sign());
    }
}

TEST(Exact, QuotientsAreTheNearestDoubles) {
    for (uint64_t seed = 0; seed < 4000; ++seed) {
        Numbers numbers(seed);
        const double a = numbers.next(), b = numbers.next();
        double c = numbers.next();
        if (c == 0)
            c = 1;
        const Rational truth = (Rational(a) + Rational(b)) / Rational(c);
        ASSERT_EQ(Exact::quotient(Exact(a) + Exact(b), Exact(c)), test::rounded(truth))
            << "seed " << seed;
    }
}

TEST(Exact, QuotientsOfTwoNeighboursMiddlesGoToTheEvenOne) {
    for (const double x : {1.0, 1.5, 0x1.fffffffffffffp0, 0x1p-1022, 0x1p-1074, 3 * 0x1p-1074,
                           0x1.0000000000001p300}) {
        const double next = std::nextafter(x, 1e308);
        const Exact sum = Exact(x) + Exact(next);
        const double even = std::bit_cast<uint64_t>(x) % 2 == 0 ? x : next;
        EXPECT_EQ(Exact::quotient(sum, Exact(2)), even) << x;
        EXPECT_EQ(Exact::quotient(-sum, Exact(2)), -even) << x;
    }
    EXPECT_EQ(Exact::quotient(Exact(0x1p-1074), Exact(2)), 0);
    EXPECT_EQ(Exact::quotient(Exact(1), Exact(0x1p-1074)), std::numeric_limits<double>::max());
    EXPECT_FALSE(std::signbit(Exact::quotient(Exact(), Exact(-3))));
}

TEST(Exact, HoldsTwoSolutionsMultipliedWhateverTheirExponents) {
    const double extremes[] = {0x1p-1074, 0x1.fffffffffffffp1023, 1, -0x1.123456789abcdp-1000};
    Exact product(1);
    Rational truth(1);
    for (int i = 0; i < 6; ++i) {
        product = product * (Exact(extremes[i % 4]) - Exact(extremes[(i + 1) % 4]));
        truth *= Rational(extremes[i % 4]) - Rational(extremes[(i + 1) % 4]);
    }
    EXPECT_EQ(product.sign(), sign(truth));
    EXPECT_EQ(Exact::quotient(product, product), 1);
    EXPECT_EQ(Exact::quotient(product * Exact(3), product), 3);
}

} // namespace
} // namespace ovc
