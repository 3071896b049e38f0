// SPDX-License-Identifier: Apache-2.0
#include "core/texture/noise/noise.h"

#include "core/smooth_step.h"
#include "core/texture/noise/noise_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ovc {

namespace {

constexpr uint32_t kPeriod = 4096; // of the lattice, in each direction
constexpr int64_t kShift = 10000;  // from a coordinate to its place in the period

/// A shuffle of the numbers below kPeriod, by the random numbers of POV-Ray's rand() from 0 on.
constexpr std::array<uint16_t, kPeriod> shuffled() {
    std::array<uint16_t, kPeriod> numbers{};
    for (uint32_t i = 0; i < kPeriod; ++i)
        numbers[i] = uint16_t(i);
    uint32_t state = 0;
    for (uint32_t i = kPeriod; i-- > 0;) {
        state = state * 1812433253u + 12345u;
        std::swap(numbers[i], numbers[(state >> 16) % kPeriod]);
    }
    return numbers;
}

constexpr std::array<uint16_t, kPeriod> kShuffled = shuffled();

/// Returns the number of three coordinates within the period.
uint32_t shuffled_number(uint32_t x, uint32_t y, uint32_t z) {
    return kShuffled[kShuffled[kShuffled[x % kPeriod] ^ y % kPeriod] ^ z % kPeriod];
}

uint32_t lattice_number(int64_t x, int64_t y, int64_t z) {
    return shuffled_number(uint32_t(x + kShift), uint32_t(y + kShift), uint32_t(z + kShift));
}

/// The corners of the lattice's cell around a point.
struct Cell {
    explicit Cell(const dvec3& at) {
        // Beyond this doubles have no fraction left, and integers no room.
        const dvec3 near = glm::clamp(at, -1e15, 1e15);
        const dvec3 low = glm::floor(near);
        const dvec3 offset = is_finite(near) ? near - low : dvec3(0);
        const int64_t x = int64_t(is_finite(near) ? low.x : 0);
        const int64_t y = int64_t(is_finite(near) ? low.y : 0);
        const int64_t z = int64_t(is_finite(near) ? low.z : 0);
        for (int i = 0; i < 8; ++i) {
            const dvec3 corner(i & 1, i >> 1 & 1, i >> 2);
            from_corner[i] = offset - corner;
            const dvec3 t = dvec3(1) - glm::abs(from_corner[i]);
            weight[i] = smooth_step(t.x) * smooth_step(t.y) * smooth_step(t.z);
            kind[i] = lattice_number(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) % 256;
        }
    }

    /// Returns the noise whose values begin at `first` in kNoiseValues, of mean 0.
    double noise(size_t first) const {
        double sum = 0;
        for (int i = 0; i < 8; ++i) {
            const double* v = kNoiseValues.data() + kind[i] + first;
            sum += weight[i] * (0.5 * v[0] + glm::dot(dvec3(v[1], v[2], v[3]), from_corner[i]));
        }
        return sum;
    }

    dvec3 from_corner[8];
    double weight[8];
    uint32_t kind[8];
};

constexpr uint32_t kGradients = 2048; // and the period of their lattice

/// Slopes of length 1 and a shuffle of their numbers, by the random numbers of POV-Ray's rand()
/// from 1 on.
/// Based on: Perlin's program in Ebert and others, "Texturing and Modeling", chapter 2; the sizes,
/// and that only every second number is moved, follow from povray's values.
struct Gradients {
    Gradients() {
        uint32_t state = 1;
        const auto random = [&] {
            state = state * 1812433253u + 12345u;
            return state >> 16 & 0x7fff;
        };
        for (dvec3& slope : slopes) {
            do
                for (int i = 0; i < 3; ++i)
                    slope[i] = double(random() % (2 * kGradients)) / kGradients - 1;
            while (glm::dot(slope, slope) > 1);
            slope = glm::normalize(slope);
        }
        for (uint32_t i = 0; i <= kGradients; ++i)
            shuffled[i] = i;
        for (uint32_t i = kGradients; i > 0; i -= 2)
            std::swap(shuffled[i], shuffled[random() % kGradients]);
    }

    const dvec3& at(int64_t x, int64_t y, int64_t z) const {
        const auto number = [&](int64_t i) { return shuffled[size_t(i & (kGradients - 1))]; };
        return slopes[size_t(number(number(x) + y) + z) & (kGradients - 1)];
    }

    std::array<dvec3, kGradients> slopes;
    std::array<uint32_t, kGradients + 1> shuffled;
};

/// Returns Perlin's noise of 1985 without values, from about -1 to 1.
double gradient_noise(const dvec3& at) {
    static const Gradients kAll;
    // The lattice lies so far off that of whole numbers, as measured.
    constexpr double kGradientShift = 1664.0231572130614;
    const dvec3 place = is_finite(at) ? glm::clamp(at, -1e15, 1e15) + kGradientShift : dvec3(0);
    const dvec3 low = glm::floor(place), offset = place - low;
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        const dvec3 from_corner = offset - dvec3(corner);
        const dvec3 t = dvec3(1) - glm::abs(from_corner);
        const dvec3& slope = kAll.at(int64_t(low.x) + corner.x, int64_t(low.y) + corner.y,
                                     int64_t(low.z) + corner.z);
        sum +=
            smooth_step(t.x) * smooth_step(t.y) * smooth_step(t.z) * glm::dot(slope, from_corner);
    }
    return sum;
}

/// Corrected is (noise + kCorrection) / kRange, as measured.
constexpr double kCorrection = 1.05242, kRange = 2.041417;

} // namespace

uint32_t cell_number(int64_t x, int64_t y, int64_t z) {
    return shuffled_number(uint32_t(x), uint32_t(y), uint32_t(z));
}

double noise(const dvec3& at, NoiseKind kind) {
    if (kind == NoiseKind::Perlin) // the range is as measured
        return std::clamp(0.4925 + 0.795 * gradient_noise(at), 0.0, 1.0);
    const double value = Cell(at).noise(0);
    return std::clamp(kind == NoiseKind::Original ? value + 0.5 : (value + kCorrection) / kRange,
                      0.0, 1.0);
}

dvec3 vector_noise(const dvec3& at) {
    const Cell cell(at);
    return {cell.noise(0), cell.noise(4), cell.noise(8)};
}

dvec3 turbulence(const dvec3& at, const Octaves& octaves) {
    dvec3 sum(0), where = at;
    double share = 1;
    for (uint64_t i = 0; i < octaves.count; ++i) {
        sum += share * vector_noise(where);
        where *= octaves.lambda;
        share *= octaves.omega;
    }
    return sum;
}

double scalar_turbulence(const dvec3& at, const Octaves& octaves, NoiseKind kind) {
    const bool corrected = kind != NoiseKind::Original;
    double sum = 0, share = 1;
    dvec3 where = at;
    for (uint64_t i = 0; i < octaves.count; ++i) {
        double value = noise(where, kind);
        if (corrected) {
            value = 2 * value - 0.5;
            value = i == 0 ? std::clamp(value, 0.0, 1.0) : value; // only the first, as measured
        }
        sum += share * value;
        where *= octaves.lambda;
        share *= octaves.omega;
    }
    return sum;
}

} // namespace ovc
