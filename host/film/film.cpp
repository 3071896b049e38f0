// SPDX-License-Identifier: Apache-2.0
// Light is summed in fixed point, because a sum of whole numbers does not depend on their order.
#include "host/film/film.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

namespace ovc {

static constexpr double kOne = 0x1p28;
/// Brighter light is clamped to this, so that a million such samples stay below 2^63.
static constexpr float kBrightest = 32768;

/// Returns the light in units of 2^-28, rounded as llround() does, which is a call; NaN is dark.
static int64_t fixed(float light) {
    const double units = double(std::clamp(light, -kBrightest, kBrightest)) * kOne;
    return light == light ? int64_t(units + std::copysign(0.5, units)) : 0;
}

/// Returns how many pieces of 2^bits pixels cover so many.
static uint32_t pieces_of(uint32_t pixels, uint32_t bits) {
    return uint32_t((uint64_t(pixels) + (1u << bits) - 1) >> bits);
}

Film::Film(uint32_t width, uint32_t height, uint32_t samples)
    : width_(width),
      height_(height),
      samples_(samples),
      mean_scale_(1 / (kOne * samples)),
      across_bits_(height > 1 ? kTileBits / 2 : kTileBits), // pixels of a single row are points
      columns_(pieces_of(width, across_bits_)),
      rows_(pieces_of(height, kTileBits - across_bits_)),
      tiles_(map_pages(size_t(columns_) * rows_ * sizeof(Tile))) {
    assert(width > 0 && height > 0 && samples > 0);
}

void Film::add(const Place& at, const vec3& light) {
    Sums& sums = at.tile.sums[at.pixel];
    const bool alone = is_last(at); // additions that others cannot see cost less
    for (int channel = 0; channel < 3; ++channel) {
        if (light[channel] == 0)
            continue;
        const int64_t more = fixed(light[channel]);
        int64_t& sum = sums[size_t(channel)];
        if (alone)
            sum += more;
        else
            std::atomic_ref(sum).fetch_add(more, std::memory_order_relaxed);
    }
}

Film::Sums Film::sums(uint32_t pixel) const {
    const Place at = place(pixel);
    const auto of = [&](size_t channel) {
        return std::atomic_ref(at.tile.sums[at.pixel][channel]).load(std::memory_order_relaxed);
    };
    return {of(0), of(1), of(2)};
}

void Film::restore(uint32_t pixel, const Sums& sums) {
    restore({&pixel, 1}, {&sums, 1});
}

void Film::restore(std::span<const uint32_t> pixels, std::span<const Sums> sums) {
    assert(pixels.size() == sums.size());
    parallel_for(pixels.size(), 4096, [&](size_t first, size_t last) {
        uint64_t done_now = 0;
        for (size_t i = first; i < last; ++i) {
            const Place at = place(pixels[i]);
            for (size_t channel = 0; channel < 3; ++channel)
                std::atomic_ref(at.tile.sums[at.pixel][channel])
                    .store(sums[i][channel], std::memory_order_relaxed);
            const std::atomic_ref<uint32_t> rays(at.tile.answered[at.pixel]);
            done_now += rays.load(std::memory_order_relaxed) != samples_;
            rays.store(samples_, std::memory_order_release);
        }
        done_.fetch_add(done_now, std::memory_order_relaxed);
    });
}

Film::Sums Film::sums_of(const vec3& mean) const {
    const auto of = [&](float light) { return int64_t(samples_) * fixed(light); };
    return {of(mean.x), of(mean.y), of(mean.z)};
}

void Film::take(Film&& other) {
    assert(other.width_ == width_ && other.height_ == height_ && other.samples_ == samples_);
    std::swap(tiles_, other.tiles_);
    done_ = other.done_.exchange(done_);
}

// The sums stand before a byte for each pixel, 1 where it is done.

void Film::copy_tile(uint32_t number, std::span<std::byte, kTileBytes> bytes) const {
    const Tile& tile = tile_of(number);
    std::memcpy(bytes.data(), &tile.sums, sizeof(tile.sums));
    std::byte* const done = bytes.data() + sizeof(tile.sums);
    for (uint32_t i = 0; i < kTilePixels; ++i)
        done[i] = std::byte(tile.answered[i] == samples_);
}

void Film::restore_tile(uint32_t number, std::span<const std::byte, kTileBytes> bytes) {
    Tile& tile = tile_of(number);
    const std::byte* const done = bytes.data() + sizeof(tile.sums);
    uint64_t done_now = 0;
    for (uint32_t i = 0; i < kTilePixels; ++i) {
        if (done[i] == std::byte(0))
            continue;
        std::memcpy(&tile.sums[i], bytes.data() + i * sizeof(Sums), sizeof(Sums));
        done_now += tile.answered[i] != samples_;
        tile.answered[i] = samples_;
    }
    done_.fetch_add(done_now, std::memory_order_relaxed);
}

dvec3 Film::mean(uint32_t pixel) const {
    const Sums sum = sums(pixel);
    return mean_scale_ * dvec3(double(sum[0]), double(sum[1]), double(sum[2]));
}

PixelSource Film::pixels() const {
    return {width_, height_, [this](size_t first, std::span<vec4> pixels) {
                for (size_t i = 0; i < pixels.size(); ++i) {
                    const auto pixel = uint32_t(first + i);
                    pixels[i] = done(pixel) ? vec4(vec3(mean(pixel)), 1) : vec4(0);
                }
            }};
}

} // namespace ovc
