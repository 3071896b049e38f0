// SPDX-License-Identifier: Apache-2.0
// Exact: schoolbook arithmetic on limbs.
#include "core/exact/exact.h"

#include "core/exact/double_parts.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr int kLimbBits = 64;

} // namespace

Exact::Exact(double x) {
    assert(std::isfinite(x));
    const DoubleParts parts(x);
    if (parts.mantissa == 0)
        return;
    const int power = parts.power + 17 * kLimbBits; // above 0, so that / and % round down
    exponent_ = power / kLimbBits - 17;
    const Wide shifted = Wide(parts.mantissa) << power % kLimbBits;
    negative_ = x < 0;
    limbs_[0] = uint64_t(shifted);
    limbs_[1] = uint64_t(shifted >> kLimbBits);
    size_ = 2;
    trim();
}

Exact& Exact::operator=(const Exact& other) {
    for (int i = 0; i < other.size_; ++i)
        limbs_[size_t(i)] = other.limbs_[size_t(i)];
    size_ = other.size_;
    exponent_ = other.exponent_;
    negative_ = other.negative_;
    return *this;
}

Exact Exact::operator-() const {
    Exact result = *this;
    result.negative_ = !negative_;
    return result;
}

void Exact::trim() {
    while (size_ > 0 && limbs_[size_t(size_ - 1)] == 0)
        --size_;
    int zeros = 0;
    while (zeros < size_ && limbs_[size_t(zeros)] == 0)
        ++zeros;
    if (zeros == 0)
        return;
    size_ -= zeros;
    exponent_ += zeros;
    for (int i = 0; i < size_; ++i)
        limbs_[size_t(i)] = limbs_[size_t(i + zeros)];
}

/// Replaces a magnitude that a subtraction has borrowed for by 2^(64 size) minus it.
void Exact::complement() {
    uint64_t carry = 1;
    for (int i = 0; i < size_; ++i) {
        const uint64_t limb = ~limbs_[size_t(i)] + carry;
        carry &= limb == 0;
        limbs_[size_t(i)] = limb;
    }
    negative_ = !negative_;
}

Exact Exact::sum(const Exact& other, bool other_negative) const {
    Exact result;
    const int low = std::min(exponent_, other.exponent_);
    const int high = std::max(end(), other.end());
    assert(high - low < kMaxLimbs);
    result.size_ = high - low;
    result.exponent_ = low;
    result.negative_ = negative_;
    uint64_t carry = 0;
    const bool adds = negative_ == other_negative;
    for (int place = low; place < high; ++place) {
        const Wide a = limb_at(place), b = other.limb_at(place);
        const Wide total = adds ? a + b + carry : a - b - carry;
        result.limbs_[size_t(place - low)] = uint64_t(total);
        carry = uint64_t(total >> kLimbBits) & 1;
    }
    if (carry && adds)
        result.limbs_[size_t(result.size_++)] = carry;
    else if (carry)
        result.complement();
    result.trim();
    return result;
}

Exact Exact::operator*(const Exact& other) const {
    Exact result;
    if (size_ == 0 || other.size_ == 0)
        return result;
    assert(size_ + other.size_ <= kMaxLimbs);
    result.size_ = size_ + other.size_;
    result.exponent_ = exponent_ + other.exponent_;
    result.negative_ = negative_ != other.negative_;
    for (int k = 0; k < other.size_; ++k)
        result.limbs_[size_t(k)] = 0;
    for (size_t i = 0; i < size_t(size_); ++i) {
        uint64_t carry = 0;
        for (size_t k = 0; k < size_t(other.size_); ++k) {
            const Wide total = Wide(limbs_[i]) * other.limbs_[k] + result.limbs_[i + k] + carry;
            result.limbs_[i + k] = uint64_t(total);
            carry = uint64_t(total >> kLimbBits);
        }
        result.limbs_[i + size_t(other.size_)] = carry;
    }
    result.trim();
    return result;
}

double Exact::leading(int& exponent) const {
    assert(size_ > 0);
    const double top = std::ldexp(double(limbs_[size_t(size_ - 1)]), kLimbBits) +
                       (size_ > 1 ? double(limbs_[size_t(size_ - 2)]) : 0.0);
    const double mantissa = std::frexp(top, &exponent);
    exponent += (end() - 2) * kLimbBits;
    return mantissa;
}

double Exact::quotient(const Exact& numerator, const Exact& denominator) {
    assert(denominator.size_ > 0);
    if (numerator.size_ == 0)
        return 0;
    constexpr double largest = std::numeric_limits<double>::max();
    Exact n = numerator, d = denominator;
    n.negative_ = d.negative_ = false;
    int up = 0, down = 0;
    const double ratio = n.leading(up) / d.leading(down);
    double rounded = std::min(std::ldexp(ratio, up - down), largest);
    // That is within some units in the last place. To tell whether the quotient is nearer to a
    // neighbour, twice the quotient is compared with the sum of the two.
    const auto nearer_to = [&](double neighbour) {
        const int side = (n + n - d * (Exact(rounded) + Exact(neighbour))).sign();
        const bool odd = std::bit_cast<uint64_t>(rounded) & 1;
        return side == 0 ? odd : (side > 0) == (neighbour > rounded);
    };
    while (rounded < largest && nearer_to(std::nextafter(rounded, largest)))
        rounded = std::nextafter(rounded, largest);
    while (rounded > 0 && nearer_to(std::nextafter(rounded, 0.0)))
        rounded = std::nextafter(rounded, 0.0);
    return numerator.negative_ != denominator.negative_ ? -rounded : rounded;
}

} // namespace ovc
