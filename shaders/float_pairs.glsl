// SPDX-License-Identifier: Apache-2.0
// Arithmetic on pairs of floats, with 48 bits of precision, for devices on which doubles are slow.
// With u = 2^-24, and unless a number is below 2^-99: a sum of pairs is off by at most 3 u^2 of
// itself, a product by 7 u^2, a quotient by 40 u^2 (docs/design/numerics.md, "Pairs of floats").
// That holds where floats are rounded to nearest and `precise` is obeyed, which
// gpu/tuning/float_pair_check.h asks of a driver.
// Based on: Joldes, Muller and Popescu 2017, "Tight and rigorous error bounds for basic building
// blocks of double-word arithmetic" (algorithms 6 and 10); Dekker 1971 (products of floats).

struct FloatPair {
    float hi; // the pair's value, rounded to nearest
    float lo; // the rest
};

// Returns a + b, exactly.
FloatPair two_sum(float a, float b) {
    precise float sum = a + b;
    precise float of_b = sum - a;
    precise float of_a = sum - of_b;
    precise float rest = (a - of_a) + (b - of_b);
    return FloatPair(sum, rest);
}
// The same for |a| >= |b|, or a = 0.
FloatPair fast_two_sum(float a, float b) {
    precise float sum = a + b;
    precise float of_b = sum - a;
    precise float rest = b - of_b;
    return FloatPair(sum, rest);
}
// Returns the same number as the sum of two floats of 12 bits.
FloatPair split(float a) {
    precise float far = 4097.0 * a;
    precise float beside = far - a;
    precise float hi = far - beside;
    precise float lo = a - hi;
    return FloatPair(hi, lo);
}
// Returns a * b, exactly. Not by fma(), which drivers may compute by two roundings (llvmpipe does).
FloatPair two_product(float a, float b) {
    precise float product = a * b;
    FloatPair x = split(a), y = split(b);
    precise float rest = ((x.hi * y.hi - product) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo;
    return FloatPair(product, rest);
}

FloatPair negated(FloatPair a) { return FloatPair(-a.hi, -a.lo); }
FloatPair sum(FloatPair a, FloatPair b) {
    FloatPair s = two_sum(a.hi, b.hi);
    FloatPair t = two_sum(a.lo, b.lo);
    precise float c = s.lo + t.hi;
    FloatPair v = fast_two_sum(s.hi, c);
    precise float w = t.lo + v.lo;
    return fast_two_sum(v.hi, w);
}
FloatPair difference(FloatPair a, FloatPair b) { return sum(a, negated(b)); }
FloatPair product(FloatPair a, FloatPair b) {
    FloatPair c = two_product(a.hi, b.hi);
    precise float rest = a.hi * b.lo + a.lo * b.hi;
    precise float low = c.lo + rest;
    return fast_two_sum(c.hi, low);
}
FloatPair quotient(FloatPair a, FloatPair b) {
    precise float first = a.hi / b.hi;
    FloatPair rest = difference(a, product(b, FloatPair(first, 0.0)));
    precise float second = rest.hi / b.hi;
    return fast_two_sum(first, second);
}

// The three floats that a double consists of: 24 bits, 24 bits and 5 bits.
struct Parts {
    float hi;
    float middle;
    float lo;
};

// A number that is larger than this is taken for this: it is beyond what pairs decide.
const float OVC_MAX_PART = 1.0e34;

// Returns 2^exponent, -126 <= exponent <= 127.
float power_of_two(int exponent) { return intBitsToFloat((exponent + 127) << 23); }

// Returns the parts of the double (low word, high word), times 2^shift. Below 2^-99 it is 0.
Parts parts_of(uvec2 words, int shift) {
    int biased = int(words.y >> 20) & 0x7ff;
    int exponent = biased - 1023 + shift;
    float sign = (words.y & 0x80000000u) != 0u ? -1.0 : 1.0;
    if (biased == 0 || exponent < -99)
        return Parts(0.0, 0.0, 0.0);
    if (biased == 0x7ff || exponent > 112)
        return Parts(sign * OVC_MAX_PART, 0.0, 0.0);
    // Whole numbers of 24 bits at most are floats, and so are products with powers of two.
    uint hi = 0x800000u | ((words.y & 0xfffffu) << 3) | (words.x >> 29);
    uint middle = (words.x >> 5) & 0xffffffu;
    float unit = sign * power_of_two(exponent - 23);
    const float below = 5.9604644775390625e-8; // 2^-24
    precise Parts parts = Parts(float(hi) * unit, float(middle) * below * unit,
                                float(words.x & 0x1fu) * 0.03125 * below * unit);
    return parts;
}

// The same without its last 5 bits: off by less than 2 u^2 of itself, towards 0.
FloatPair pair_of(uvec2 words, int shift) {
    Parts parts = parts_of(words, shift);
    return fast_two_sum(parts.hi, parts.middle);
}

// Returns the difference of two doubles, off by 9 u^2 of itself, however close they are.
FloatPair difference(uvec2 a, uvec2 b) {
    Parts from = parts_of(a, 0), take = parts_of(b, 0);
    FloatPair s = two_sum(from.hi, -take.hi);
    FloatPair t = two_sum(from.middle, -take.middle);
    precise float last = from.lo - take.lo;
    return sum(sum(s, t), FloatPair(last, 0.0));
}
