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

/// Returns the value of pairs (nm, value) at a wavelength. ends: it is 0 beyond them.
double value_at(std::span<const double> pairs, double nm, bool ends) {
    const size_t count = pairs.size() / 2;
    size_t i = 0;
    while (i < count && pairs[2 * i] < nm)
        ++i;
    if (i == count || (i == 0 && pairs[0] > nm))
        return ends ? 0 : pairs[2 * std::min(i, count - 1) + 1];
    if (i == 0)
        return pairs[1];
    const double below = pairs[2 * i - 2], width = pairs[2 * i] - below;
    const double share = width > 0 ? (nm - below) / width : 0;
    return pairs[2 * i - 1] + share * (pairs[2 * i + 1] - pairs[2 * i - 1]);
}

/// Returns the power of D65 at nm, up to a factor.
double daylight(double nm) {
    // From 380 nm on in steps of 10, from CIE 15.
    static constexpr double kPower[] = {
        49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.87, 117.01, 117.81, 114.86, 115.92,
        108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
        90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61,
        74.35,  61.60,  69.89,  75.09,  63.59,  46.42,  66.81,  63.38};
    const double at = std::clamp((nm - 380) / 10, 0.0, double(std::size(kPower) - 1));
    const size_t below = std::min(size_t(at), std::size(kPower) - 2);
    return kPower[below] + (at - double(below)) * (kPower[below + 1] - kPower[below]);
}

struct Illuminant {
    std::string_view name;
    double x, y; // CIE 1931
};

// From CIE 15, except D50, which is as pbrt-v4 shows its table of it; ACES' white from SMPTE ST
// 2065-1.
constexpr Illuminant kIlluminants[] = {
    {"stdillum-A", 0.44758, 0.40745},   {"stdillum-D50", 0.3371, 0.3584},
    {"stdillum-D65", 0.31272, 0.32903}, {"stdillum-F1", 0.31310, 0.33727},
    {"stdillum-F2", 0.37208, 0.37529},  {"stdillum-F3", 0.40910, 0.39430},
    {"stdillum-F4", 0.44018, 0.40329},  {"stdillum-F5", 0.31379, 0.34531},
    {"stdillum-F6", 0.37790, 0.38835},  {"stdillum-F7", 0.31292, 0.32933},
    {"stdillum-F8", 0.34588, 0.35875},  {"stdillum-F9", 0.37417, 0.37281},
    {"stdillum-F10", 0.34609, 0.35986}, {"stdillum-F11", 0.38052, 0.37713},
    {"stdillum-F12", 0.43695, 0.40441}, {"illum-acesD60", 0.32168, 0.33767}};

struct Metal {
    std::string_view symbol;
    vec3 color, coated;
};

// The colors are linear sRGB, seen head on in white light, as measured in pictures of pbrt-v4, of
// gold as far as sRGB has them; chrome, which v4 does not name, is from Lagarde 2011, "Feeding a
// Physically Based Shading Model"; coated, as if its eta were 1.
constexpr Metal kMetals[] = {{"Ag", {0.972f, 0.960f, 0.911f}, {0.942f, 0.927f, 0.873f}},
                             {"Al", {0.913f, 0.922f, 0.920f}, {0.859f, 0.871f, 0.872f}},
                             {"Au", {1.000f, 0.782f, 0.342f}, {0.988f, 0.724f, 0.252f}},
                             {"CuZn", {0.910f, 0.778f, 0.421f}, {0.856f, 0.709f, 0.344f}},
                             {"Cu", {0.956f, 0.638f, 0.536f}, {0.916f, 0.547f, 0.441f}},
                             {"Cr", {0.550f, 0.556f, 0.554f}, {0.472f, 0.478f, 0.476f}},
                             {"MgO", {0.072f, 0.073f, 0.075f}, {0.044f, 0.045f, 0.045f}},
                             {"TiO2", {0.232f, 0.245f, 0.271f}, {0.128f, 0.137f, 0.157f}}};

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

/// Returns CIE 15's daylight of that temperature, and below 4,000 K that of a black body, as XYZ.
static dvec3 daylight_of(double kelvin) {
    const double t = std::clamp(kelvin, 500.0, 25000.0);
    if (t < 4000) {
        const dvec3 xyz = integrate([&](double nm) { return planck(nm, t); });
        return xyz / xyz.y;
    }
    const double per = 1 / t;
    const double x = t <= 7000 ? ((-4.607e9 * per + 2.9678e6) * per + 99.11) * per + 0.244063
                               : ((-2.0064e9 * per + 1.9018e6) * per + 247.48) * per + 0.23704;
    const double y = (-3 * x + 2.87) * x - 0.275;
    return {x / y, 1, (1 - x - y) / y};
}

/// Bradford's transform: responses of cones are divided by those to the white.
vec3 white_balance(double kelvin) {
    const dmat3 to_cones(dvec3(0.8951, -0.7502, 0.0389), dvec3(0.2664, 1.7135, -0.0685),
                         dvec3(-0.1614, 0.0367, 1.0296));
    const dvec3 white = to_cones * daylight_of(6504);
    const dvec3 balanced = white * white / (to_cones * daylight_of(kelvin));
    return without_negatives(rgb_of_xyz(glm::inverse(to_cones) * balanced));
}

vec3 color_of_samples(std::span<const double> pairs, bool is_v4) {
    assert(pairs.size() >= 2);
    const auto light_at = [&](double nm) { return is_v4 ? daylight(nm) : 1.0; };
    const auto white = rgb_of_xyz(integrate(light_at));
    const auto seen =
        integrate([&](double nm) { return light_at(nm) * value_at(pairs, nm, /* ends= */ is_v4); });
    return without_negatives(rgb_of_xyz(seen) / white);
}

std::optional<vec3> illuminant(const Parameter& parameter) {
    if (parameter.numbers.size() > 1) {
        const dvec3 xyz =
            integrate([&](double nm) { return value_at(parameter.numbers, nm, /* ends= */ true); });
        return xyz.y > 0 ? std::optional(without_negatives(rgb_of_xyz(xyz / xyz.y))) : vec3(0);
    }
    for (const Illuminant& named : kIlluminants)
        if (!parameter.strings.empty() && parameter.strings[0] == named.name)
            return without_negatives(
                rgb_of_xyz({named.x / named.y, 1, (1 - named.x - named.y) / named.y}));
    return std::nullopt;
}

std::optional<vec3> color_of(const Parameter& parameter, bool is_v4) {
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
        return n.size() < 2 ? std::nullopt : std::optional(color_of_samples(n, is_v4));
    default:
        return std::nullopt;
    }
}

static std::optional<vec3> color_of_metal(std::string_view name, vec3 Metal::*color) {
    for (const Metal& metal : kMetals)
        if (names(name, metal.symbol))
            return metal.*color;
    return std::nullopt;
}

std::optional<vec3> metal_color(std::string_view name) {
    return color_of_metal(name, &Metal::color);
}

std::optional<vec3> coated_metal_color(std::string_view name) {
    return color_of_metal(name, &Metal::coated);
}

vec3 metal_color(const vec3& eta, const vec3& k) {
    const vec3 less = eta - vec3(1), more = eta + vec3(1);
    return (less * less + k * k) / (more * more + k * k);
}

/// Light goes up and down within the coat.
vec3 coated_metal_color(const vec3& eta, const vec3& k, double coat) {
    const float root = float((coat - 1) / (coat + 1)), mirrored = root * root;
    const vec3 metal = metal_color(eta / float(coat), k / float(coat));
    return vec3(mirrored) + (1 - mirrored) * (1 - mirrored) * metal / (vec3(1) - mirrored * metal);
}

std::optional<double> glass_ior(std::string_view name) {
    for (const Glass& glass : kGlasses)
        if (name == std::string("glass-").append(glass.name))
            return glass.ior;
    return std::nullopt;
}

} // namespace ovc::pbrt
