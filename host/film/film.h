// SPDX-License-Identifier: Apache-2.0
// Film is the picture while it is made. Light arrives in any order and from any thread, and adds up
// to the same bits. A pixel is done when no ray of it is under way.
#pragma once

#include "core/file/pixel_source.h"
#include "core/system/system_pages.h"

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

class Film {
public:
    /// A tile has so many pixels, as many across as down; those of films of one row lie in a row.
    /// It is whole pages of memory: processes that render different tiles share none.
    static constexpr uint32_t kTilePixels = 1024;

    /// samples: camera rays a pixel, at least 1. Memory is taken tile by tile, as their pixels are
    /// written, so that a film of which a process renders some tiles takes little more.
    Film(uint32_t width, uint32_t height, uint32_t samples = 1);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t samples() const { return samples_; }

    /// Adds light that one of the pixel's camera rays gets, for a ray of the pixel that is under
    /// way; the picture has the mean of its camera rays. NaN counts as 0.
    void add(uint32_t pixel, const vec3& light) { add(place(pixel), light); }

    /// Counts more rays of the pixel as under way. Its camera rays are counted from the start.
    void open(uint32_t pixel, uint32_t rays = 1) {
        answered(place(pixel)).fetch_sub(rays, std::memory_order_relaxed);
    }
    /// Counts one ray of the pixel as answered. Open the rays that it spawned before.
    void close(uint32_t pixel);

    class Answers;

    bool done(uint32_t pixel) const {
        return answered(place(pixel)).load(std::memory_order_acquire) == samples_;
    }
    uint64_t pixels_done() const { return done_.load(std::memory_order_relaxed); }

    /// The exact sums of the light that has arrived, in units of 2^-28; a file keeps them for a
    /// later run.
    using Sums = std::array<int64_t, 3>;
    Sums sums(uint32_t pixel) const;
    /// Marks the pixel as done, with these sums. Call it before any ray of the pixel is answered.
    void restore(uint32_t pixel, const Sums& sums);
    /// The same for several pixels, each named once. sums: one for each.
    void restore(std::span<const uint32_t> pixels, std::span<const Sums> sums);
    /// Returns the sums of a pixel that has this mean light.
    Sums sums_of(const vec3& mean) const;
    /// Takes all that the other film has, which is as large and has as many samples. No ray of
    /// either is under way.
    void take(Film&& other);

    /// Returns how many tiles there are, which are numbered row by row.
    uint32_t tile_count() const { return columns_ * rows_; }
    /// The size of a tile, as bytes between processes of one program.
    static constexpr size_t kTileBytes = kTilePixels * (sizeof(Sums) + 1);
    /// Writes which of the tile's pixels are done, and the sums of these. No ray of the tile is
    /// under way.
    void copy_tile(uint32_t tile, std::span<std::byte, kTileBytes> bytes) const;
    /// Restores the pixels of the tile that are done in what copy_tile() wrote. Call it before any
    /// ray of them is answered.
    void restore_tile(uint32_t tile, std::span<const std::byte, kTileBytes> bytes);

    /// Returns the mean light of a pixel that is done.
    dvec3 mean(uint32_t pixel) const;
    /// Returns the picture, which the film outlives. Pixels that are not done are black, with
    /// alpha 0.
    PixelSource pixels() const;
    /// Returns the same as an image.
    Image image() const { return image_of(pixels()); }

private:
    static constexpr uint32_t kTileBits = 10;
    struct Tile {
        std::array<Sums, kTilePixels> sums;
        /// How many more of a pixel's rays were answered than opened: samples() once it is done. It
        /// begins at 0, so that nothing has to be written before.
        std::array<uint32_t, kTilePixels> answered;
    };
    static_assert(kTilePixels == 1u << kTileBits && sizeof(Tile) % 4096 == 0);
    struct Place {
        Tile& tile;
        uint32_t pixel; // of the tile
    };
    Place place(uint32_t pixel) const;
    void add(const Place& at, const vec3& light);
    Tile& tile_of(uint32_t number) const {
        assert(number < tile_count());
        return static_cast<Tile*>(tiles_.get())[number];
    }

    static std::atomic_ref<uint32_t> answered(const Place& at) {
        return std::atomic_ref(at.tile.answered[at.pixel]);
    }
    /// Returns whether no other ray of the pixel is under way, so that nobody else writes to it.
    bool is_last(const Place& at) const {
        return answered(at).load(std::memory_order_acquire) + 1 == samples_;
    }

    const uint32_t width_, height_, samples_;
    const double mean_scale_;       // makes the mean light of a pixel's sums
    const uint32_t across_bits_;    // a tile is 2^across_bits_ pixels wide
    const uint32_t columns_, rows_; // of tiles
    SystemPages tiles_;
    std::atomic<uint64_t> done_{0}; // pixels
};

/// The answers of one task. How many pixels they finish is added to the film's count in the end, so
/// that tasks do not wait for each other's.
class Film::Answers {
public:
    explicit Answers(Film& film) : film_(film) {}
    ~Answers() { film_.done_.fetch_add(done_, std::memory_order_relaxed); }
    Answers(const Answers&) = delete;

    /// Does what Film::close() does.
    void close(uint32_t pixel) { close(film_.place(pixel)); }
    /// Adds the light that one ray of the pixel has found, and counts it as answered.
    void close(uint32_t pixel, const vec3& light) {
        const Place at = film_.place(pixel);
        film_.add(at, light);
        close(at);
    }

private:
    void close(const Place& at) {
        assert(answered(at).load() != film_.samples_);
        if (!film_.is_last(at)) {
            done_ += answered(at).fetch_add(1, std::memory_order_acq_rel) + 1 == film_.samples_;
            return;
        }
        answered(at).store(film_.samples_, std::memory_order_release); // costs less
        ++done_;
    }

    Film& film_;
    uint64_t done_ = 0; // pixels
};

inline void Film::close(uint32_t pixel) {
    Answers(*this).close(pixel);
}

inline Film::Place Film::place(uint32_t pixel) const {
    assert(pixel < size_t(width_) * height_);
    const uint32_t x = pixel % width_, y = pixel / width_;
    const uint32_t down_bits = kTileBits - across_bits_;
    return {tile_of((y >> down_bits) * columns_ + (x >> across_bits_)),
            (y & ((1u << down_bits) - 1)) << across_bits_ | (x & ((1u << across_bits_) - 1))};
}

} // namespace ovc
