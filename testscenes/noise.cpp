// SPDX-License-Identifier: Apache-2.0
// Sine and value noise.
#include "testscenes/noise.h"

#include "testscenes/random.h"

#include <algorithm>
#include <cmath>

namespace ovc {

namespace {

/// sin(2 pi x) for |x| <= 1/4, by Taylor's series to the 13th power.
double sine_of_turns(double x) {
    const double a = 6.283185307179586 * x;
    const double b = a * a;
    return a *
           (1 - b / 6 * (1 - b / 20 * (1 - b / 42 * (1 - b / 72 * (1 - b / 110 * (1 - b / 156))))));
}

double value_at(int64_t x, int64_t y, int64_t z, uint64_t seed) {
    const uint64_t bits =
        mix_bits(seed ^ mix_bits(uint64_t(x) ^ mix_bits(uint64_t(y) ^ mix_bits(uint64_t(z)))));
    return double(bits >> 11) * 0x1p-52 - 1;
}

double fade(double x) {
    return x * x * x * (x * (x * 6 - 15) + 10);
}

double mix(double a, double b, double weight) {
    return a + (b - a) * weight;
}

} // namespace

dvec2 circle(double turns) {
    const double x = turns - std::floor(turns + 0.5); // [-1/2, 1/2)
    const double folded = x > 0.25 ? 0.5 - x : x < -0.25 ? -0.5 - x : x;
    const double quarter_on = std::abs(x) <= 0.25 ? 1 : -1;
    const double sine = sine_of_turns(folded);
    return {quarter_on * sine_of_turns(0.25 - std::abs(folded)), sine};
}

double noise(dvec2 p, uint64_t seed) {
    return noise(dvec3(p.x, p.y, 0), seed);
}

double noise(dvec3 p, uint64_t seed) {
    const dvec3 cell = glm::floor(p);
    const dvec3 f = p - cell;
    const int64_t x = int64_t(cell.x), y = int64_t(cell.y), z = int64_t(cell.z);
    const double fx = fade(f.x), fy = fade(f.y);
    const auto plane = [&](int64_t at) {
        return mix(mix(value_at(x, y, at, seed), value_at(x + 1, y, at, seed), fx),
                   mix(value_at(x, y + 1, at, seed), value_at(x + 1, y + 1, at, seed), fx), fy);
    };
    return f.z == 0 ? plane(z) : mix(plane(z), plane(z + 1), fade(f.z));
}

double fractal_noise(dvec2 p, int octaves, uint64_t seed) {
    return fractal_noise(dvec3(p.x, p.y, 0), octaves, seed);
}

double fractal_noise(dvec3 p, int octaves, uint64_t seed) {
    double sum = 0, height = 0.5;
    for (int octave = 0; octave < octaves; ++octave, p = p * 2.0, height *= 0.5)
        sum += height * noise(p, seed + uint64_t(octave));
    return sum;
}

} // namespace ovc
