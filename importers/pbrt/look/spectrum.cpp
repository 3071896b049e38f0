// SPDX-License-Identifier: Apache-2.0
// The CIE 1931 observer turns spectra into colors.
// Based on: Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
// Matching Functions"; Planck's law; sRGB's matrix (IEC 61966-2-1).
#include "importers/pbrt/look/spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::pbrt {

namespace {

double lobe(double nm, double peak, double below, double above) {
    const double t = (nm - peak) * (nm < peak ? below : above);
    return std::exp(-0.5 * t * t);
}

dvec3 observer(double nm) {
    return {1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

dvec3 rgb_of_xyz(const dvec3& c) {
    return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
            -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
            0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

/// Returns the observer's answer to power(nm).
template <class Power>
dvec3 integrate(Power&& power) {
    dvec3 sum(0);
    for (double nm = 380; nm <= 780; nm += 5)
        sum += power(nm) * observer(nm);
    return sum;
}

vec3 without_negatives(const dvec3& color) {
    return vec3(glm::max(color, dvec3(0)));
}

struct Metal {
    std::string_view symbol;
    vec3 color;
};

// The colors are linear sRGB, seen head on. They are from Lagarde 2011, "Feeding a Physically
// Based Shading Model"; brass from physicallybased.info; the oxides from their indices, 1.74 and
// 2.6.
constexpr Metal kMetals[] = {{"Ag", {0.972f, 0.960f, 0.915f}},  {"Al", {0.913f, 0.921f, 0.925f}},
                             {"Au", {1.000f, 0.766f, 0.336f}},  {"CuZn", {0.887f, 0.789f, 0.434f}},
                             {"Cu", {0.955f, 0.637f, 0.538f}},  {"Cr", {0.550f, 0.556f, 0.554f}},
                             {"MgO", {0.073f, 0.073f, 0.073f}}, {"TiO2", {0.198f, 0.198f, 0.198f}}};

struct Glass {
    std::string_view name;
    double ior;
};

constexpr Glass kGlasses[] = {{"BK7", 1.5168},   {"BAF10", 1.6700}, {"FK51A", 1.4866},
                              {"LASF9", 1.8503}, {"SF5", 1.6727},   {"SF10", 1.7283},
                              {"SF11", 1.7847}};

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Returns whether `symbol` stands in the name as a word.
bool names(std::string_view name, std::string_view symbol) {
    for (size_t at = name.find(symbol); at != name.npos; at = name.find(symbol, at + 1)) {
        const size_t end = at + symbol.size();
        if ((at == 0 || !is_letter(name[at - 1])) && (end == name.size() || !is_letter(name[end])))
            return true;
    }
    return false;
}

} // namespace

namespace {

/// Returns Planck's law at nm / kelvin, up to a factor.
double planck(double nm, double kelvin) {
    const double x = nm * 1e-9;
    return 1e-30 / (std::pow(x, 5) * std::expm1(1.438777e-2 / (x * kelvin)));
}

double within_range(double kelvin) {
    return std::clamp(kelvin, 500.0, 1e5);
}

/// Returns the color of a black body whose spectrum is 1 where it is largest, as in v2 and v3.
vec3 black_body_by_peak(double kelvin) {
    const double t = within_range(kelvin);
    const double peak = planck(2.8977721e6 / t, t); // Wien's law
    const dvec3 xyz = integrate([&](double nm) { return planck(nm, t) / peak; });
    const double white = integrate([](double) { return 1.0; }).y;
    return without_negatives(rgb_of_xyz(xyz / white));
}

} // namespace

vec3 black_body(double kelvin) {
    const double t = within_range(kelvin);
    const dvec3 xyz = integrate([&](double nm) { return planck(nm, t); });
    return without_negatives(rgb_of_xyz(xyz / xyz.y));
}

vec3 color_of_samples(std::span<const double> pairs) {
    const size_t count = pairs.size() / 2;
    assert(count > 0);
    const auto value_at = [&](double nm) {
        size_t i = 0;
        while (i < count && pairs[2 * i] < nm)
            ++i;
        if (i == 0 || i == count)
            return pairs[2 * std::min(i, count - 1) + 1];
        const double below = pairs[2 * i - 2], width = pairs[2 * i] - below;
        const double share = width > 0 ? (nm - below) / width : 0;
        return pairs[2 * i - 1] + share * (pairs[2 * i + 1] - pairs[2 * i - 1]);
    };
    const auto white = rgb_of_xyz(integrate([](double) { return 1.0; }));
    return without_negatives(rgb_of_xyz(integrate(value_at)) / white);
}

std::optional<vec3> color_of(const Parameter& parameter) {
    const std::vector<double>& n = parameter.numbers;
    switch (parameter.kind) {
    case Kind::Float:
    case Kind::Integer:
        return n.empty() ? std::nullopt : std::optional(vec3(float(n[0])));
    case Kind::Rgb:
        if (n.size() == 1)
            return vec3(float(n[0]));
        return n.size() < 3 ? std::nullopt
                            : std::optional(vec3(float(n[0]), float(n[1]), float(n[2])));
    case Kind::Xyz:
        return n.size() < 3 ? std::nullopt
                            : std::optional(without_negatives(rgb_of_xyz({n[0], n[1], n[2]})));
    case Kind::Blackbody:
        if (n.empty())
            return std::nullopt;
        return n.size() > 1 ? black_body_by_peak(n[0]) * float(n[1]) : black_body(n[0]);
    case Kind::Spectrum:
        if (n.size() == 1)
            return vec3(float(n[0]));
        return n.size() < 2 ? std::nullopt : std::optional(color_of_samples(n));
    default:
        return std::nullopt;
    }
}

std::optional<vec3> metal_color(std::string_view name) {
    for (const Metal& metal : kMetals)
        if (names(name, metal.symbol))
            return metal.color;
    return std::nullopt;
}

vec3 metal_color(const vec3& eta, const vec3& k) {
    const vec3 less = eta - vec3(1), more = eta + vec3(1);
    return (less * less + k * k) / (more * more + k * k);
}

std::optional<double> glass_ior(std::string_view name) {
    for (const Glass& glass : kGlasses)
        if (name == std::string("glass-").append(glass.name))
            return glass.ior;
    return std::nullopt;
}

} // namespace ovc::pbrt
