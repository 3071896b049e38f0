// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/shapes/polynomial.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <queue>

namespace ovc::pov {

void Polynomial::add(const Term& term) {
    highest = std::max({highest, term.powers[0], term.powers[1], term.powers[2]});
    assert(highest <= kMaxOrder);
    terms.push_back(term);
}

double Polynomial::operator()(const dvec3& p) const {
    std::array<dvec3, kMaxOrder + 1> powers; // of the coordinates
    powers[0] = dvec3(1);
    for (int k = 1; k <= highest; ++k)
        powers[size_t(k)] = powers[size_t(k) - 1] * p;
    double sum = 0;
    for (const Term& term : terms) {
        double product = term.factor;
        for (int i = 0; i < 3; ++i)
            product *= powers[size_t(term.powers[i])][i];
        sum += product;
    }
    return sum;
}

namespace {

/// Returns the range of x ^ exponent for x in [lo, hi].
Range power(double lo, double hi, int exponent) {
    assert(exponent >= 0);
    if (exponent == 0)
        return {1, 1};
    double a = lo, b = hi;
    for (int i = 1; i < exponent; ++i) {
        a *= lo;
        b *= hi;
    }
    if (exponent % 2 == 0 && lo < 0 && hi > 0)
        return {0, std::max(a, b)};
    return {std::min(a, b), std::max(a, b)};
}

} // namespace

Range Polynomial::range_over(const Box& box) const {
    std::array<std::array<Range, 3>, kMaxOrder + 1> powers; // of the coordinates
    for (int k = 0; k <= highest; ++k)
        for (int i = 0; i < 3; ++i)
            powers[size_t(k)][size_t(i)] = power(box.lo[i], box.hi[i], k);
    Range sum{0, 0};
    for (const Term& term : terms) {
        Range product{term.factor, term.factor};
        for (size_t i = 0; i < 3; ++i) {
            const Range& r = powers[size_t(term.powers[i])][i];
            const double all[4] = {product.lo * r.lo, product.lo * r.hi, product.hi * r.lo,
                                   product.hi * r.hi};
            product = {*std::min_element(all, all + 4), *std::max_element(all, all + 4)};
        }
        sum.lo += product.lo;
        sum.hi += product.hi;
    }
    return sum;
}

size_t factors_of(int order) {
    return size_t(order + 1) * size_t(order + 2) * size_t(order + 3) / 6;
}

Polynomial polynomial_of(int order, const std::vector<double>& factors) {
    assert(factors.size() == factors_of(order));
    Polynomial polynomial;
    size_t next = 0;
    for (int x = order; x >= 0; --x)
        for (int y = order - x; y >= 0; --y)
            for (int z = order - x - y; z >= 0; --z)
                if (const double factor = factors[next++]; factor != 0)
                    polynomial.add({factor, {x, y, z}});
    return polynomial;
}

namespace {

/// Returns an upper bound on how far the set below 0 reaches along an axis, where way is 1 or -1.
/// Boxes are halved, the farthest first, until the farthest one is small.
double farthest(const Polynomial& polynomial, const Box& whole, int axis, int way) {
    assert(way == 1 || way == -1);
    constexpr int kMaxBoxes = 400; // along a flat surface many boxes reach equally far
    const auto reach = [&](const Box& box) { return way > 0 ? box.hi[axis] : -box.lo[axis]; };
    const auto nearer = [&](const Box& a, const Box& b) { return reach(a) < reach(b); };
    std::priority_queue<Box, std::vector<Box>, decltype(nearer)> open(nearer);
    open.push(whole);
    const dvec3 enough = whole.extent() / 64.0;
    for (int i = 0; i < kMaxBoxes && !open.empty(); ++i) {
        const Box box = open.top();
        const dvec3 sizes = box.extent() / enough;
        const int longest = major_axis(sizes);
        if (sizes[longest] <= 1)
            return reach(box);
        open.pop();
        for (const int half : {0, 1}) {
            Box part = box;
            (half ? part.lo : part.hi)[longest] = box.center()[longest];
            if (!(polynomial.range_over(part).lo > 0))
                open.push(part);
        }
    }
    return open.empty() ? -std::numeric_limits<double>::infinity() : reach(open.top());
}

} // namespace

Box tightened(const Polynomial& polynomial, const Box& box) {
    Box now = box;
    for (int round = 0; round < 12; ++round) {
        Box next = now;
        for (int axis = 0; axis < 3; ++axis) {
            next.hi[axis] = farthest(polynomial, next, axis, 1);
            next.lo[axis] = -farthest(polynomial, next, axis, -1);
            if (!(next.lo[axis] <= next.hi[axis]))
                return Box();
        }
        const bool is_steady = glm::all(glm::greaterThanEqual(next.extent(), 0.8 * now.extent()));
        now = next;
        if (is_steady)
            break;
    }
    return now;
}

} // namespace ovc::pov
