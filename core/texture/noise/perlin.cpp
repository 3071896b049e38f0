// SPDX-License-Identifier: Apache-2.0
#include "core/texture/noise/perlin.h"

#include "core/smooth_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ovc {

namespace {

/// Perlin's permutation, which is a part of what improved noise is.
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

uint32_t permuted(int64_t number) {
    return kPermutation[size_t(number & 255)];
}

/// Returns the product of the offset and the gradient of the number: one of the twelve directions
/// to the middles of a cube's edges, four of which have two numbers. The last four numbers are
/// shared out as in pbrt, where 13 and 14 are not those of Perlin's program.
double along_gradient(uint32_t number, const dvec3& off) {
    const uint32_t h = number & 15;
    const bool is_level = h == 12 || h == 13;
    const double u = h < 8 || is_level ? off.x : off.y;
    const double v = h < 4 || is_level ? off.y : off.z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

/// Returns 6 t^5 - 15 t^4 + 10 t^3.
double fade(double t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

/// The frequency of an octave over that of the one before. Zeros of different octaves then fall
/// onto different points.
constexpr double kLacunarity = 1.99;
/// About the mean magnitude of improved noise.
constexpr double kMeanMagnitude = 0.2;

/// Returns how many octaves the footprint has room for.
double kept_octaves(const NoiseSum& sum) {
    const double octaves = std::clamp(sum.octaves, 0.0, kMaxNoiseOctaves);
    const double square =
        std::max(glm::dot(sum.sides[0], sum.sides[0]), glm::dot(sum.sides[1], sum.sides[1]));
    return square > 0 ? std::clamp(-1 - 0.5 * std::log2(square), 0.0, octaves) : octaves;
}

} // namespace

double improved_noise(const dvec3& at) {
    const dvec3 near = is_finite(at) ? glm::clamp(at, -1e15, 1e15) : dvec3(0);
    const dvec3 low = glm::floor(near), off = near - low;
    const dvec3 weight(fade(off.x), fade(off.y), fade(off.z));
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        const uint32_t number =
            permuted(permuted(permuted(int64_t(low.x) + corner.x) + int64_t(low.y) + corner.y) +
                     int64_t(low.z) + corner.z);
        const dvec3 share = glm::mix(1.0 - weight, weight, dvec3(corner));
        sum += share.x * share.y * share.z * along_gradient(number, off - dvec3(corner));
    }
    return sum;
}

double noise_sum(const dvec3& at, const NoiseSum& sum) {
    const double kept = kept_octaves(sum), whole = std::floor(kept);
    double total = 0, frequency = 1, share = 1;
    for (int i = 0; i < int(whole); ++i, frequency *= kLacunarity, share *= sum.roughness)
        total += share * improved_noise(frequency * at);
    return total + share * smooth_step(0.3, 0.7, kept - whole) * improved_noise(frequency * at);
}

double turbulence_sum(const dvec3& at, const NoiseSum& sum) {
    const double kept = kept_octaves(sum), whole = std::floor(kept);
    double total = 0, frequency = 1, share = 1;
    for (int i = 0; i < int(whole); ++i, frequency *= kLacunarity, share *= sum.roughness)
        total += share * std::abs(improved_noise(frequency * at));
    const double last = smooth_step(0.3, 0.7, kept - whole);
    total += share * glm::mix(kMeanMagnitude, std::abs(improved_noise(frequency * at)), last);
    for (int i = int(whole) + 1; i < int(std::min(sum.octaves, kMaxNoiseOctaves)); ++i)
        total += (share *= sum.roughness) * kMeanMagnitude;
    return total;
}

double windy_sum(const dvec3& at, const std::array<dvec3, 2>& sides) {
    const double wind = noise_sum(0.1 * at, {3, 0.5, {0.1 * sides[0], 0.1 * sides[1]}});
    return std::abs(wind) * noise_sum(at, {6, 0.5, sides});
}

} // namespace ovc
