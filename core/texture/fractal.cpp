// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.4.7.1.11) gives the formulas; what it leaves open, such as
// when an orbit ends, was found by asking povray for values.
#include "core/texture/fractal.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace ovc {

namespace {

using Complex = std::complex<double>;

double square(const Complex& z) {
    return z.real() * z.real() + z.imag() * z.imag();
}

Complex product(const Complex& a, const Complex& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex power(const Complex& z, int exponent) {
    Complex result = z;
    for (int i = 1; i < exponent; ++i)
        result = product(result, z);
    return result;
}

/// Returns the next point of the orbit in one of the magnet sets.
Complex magnet(int kind, const Complex& z, const Complex& c) {
    const Complex one = c - 1.0, two = c - 2.0;
    Complex ratio;
    if (kind == 1) {
        ratio = (product(z, z) + one) / (2.0 * z + two);
    } else {
        const Complex both = product(one, two), squared = product(z, z);
        ratio = (product(squared, z) + 3.0 * product(one, z) + both) /
                (3.0 * squared + 3.0 * product(two, z) + both + 1.0);
    }
    return product(ratio, ratio);
}

struct Orbit {
    Complex last;
    double nearest; // the least square of a distance from 0
    int steps;      // before the one that escaped
    bool escaped;
};

Orbit orbit(const std::array<double, 10>& p, const dvec3& at) {
    using P = FractalParameter;
    const Complex here(at.x, at.y);
    const bool is_julia = p[P::kIsJulia] != 0;
    const int exponent = int(p[P::kExponent]);
    const Complex c = is_julia ? Complex(p[P::kX], p[P::kY]) : here;
    const bool from_origin = exponent < 0 && !is_julia; // which then is no point of the orbit
    Complex z = from_origin ? Complex(0) : here;
    double nearest = from_origin ? double(INFINITY) : square(z);
    const int max = int(std::clamp(p[P::kIterations], 1.0, kMaxFractalIterations));
    for (int i = 0; i < max; ++i) {
        z = exponent < 0 ? magnet(-exponent, z, c) : power(z, exponent) + c;
        const double away = square(z);
        nearest = std::min(nearest, away);
        const bool escaped =
            exponent < 0 ? away > 1e4 || square(z - 1.0) < 1e-4 || std::isnan(away) : away > 4;
        if (escaped)
            return {z, nearest, i, true};
    }
    return {z, nearest, max, false};
}

double part_of_last(const Complex& z, int kind) {
    switch (kind) {
    case 2:
        return z.real();
    case 3:
        return z.imag();
    case 4:
        return z.real() * z.real();
    case 5:
        return z.imag() * z.imag();
    default:
        return 1;
    }
}

double inside(const std::array<double, 10>& p, const Orbit& orbit) {
    using P = FractalParameter;
    const int kind = int(p[P::kInterior]);
    const double factor = p[P::kInteriorFactor];
    if (kind == 6) // povray multiplies the second square alone
        return part_of_last(orbit.last, 4) + factor * part_of_last(orbit.last, 5);
    return factor * (kind == 1 ? std::sqrt(orbit.nearest) : part_of_last(orbit.last, kind));
}

double outside(const std::array<double, 10>& p, const Orbit& orbit) {
    using P = FractalParameter;
    const double factor = p[P::kExteriorFactor];
    switch (const int kind = int(p[P::kExterior]); kind) {
    case 1:
        return orbit.steps / p[P::kIterations];
    case 6:
        return factor * std::sqrt(square(orbit.last));
    case 7:
        return factor >= 1 ? std::fmod(orbit.steps, std::floor(factor)) / factor : 0;
    case 8:
        return factor >= 1 ? std::fmod(orbit.steps, std::floor(factor) + 1) / factor : 0;
    default:
        return factor * part_of_last(orbit.last, kind);
    }
}

} // namespace

double fractal(const std::array<double, 10>& parameters, const dvec3& at) {
    const Orbit found = orbit(parameters, at);
    const double value = found.escaped ? outside(parameters, found) : inside(parameters, found);
    return std::isfinite(value) ? value : 0;
}

} // namespace ovc
