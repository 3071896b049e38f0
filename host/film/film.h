// SPDX-License-Identifier: Apache-2.0
// Film is the picture while it is made. Light arrives in any order and from any thread, and adds up
// to the same bits. A pixel is done when no ray of it is under way.
#pragma once

#include "core/file/image.h"

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

class Film {
public:
    /// samples: camera rays a pixel, at least 1.
    Film(uint32_t width, uint32_t height, uint32_t samples = 1);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t samples() const { return samples_; }

    /// Adds light that one of the pixel's camera rays gets; the picture has the mean of its camera
    /// rays. NaN counts as 0.
    void add(uint32_t pixel, const vec3& light);

    /// Counts more rays of the pixel as under way. Its camera rays are counted from the start.
    void open(uint32_t pixel, uint32_t rays = 1) {
        under_way_[pixel].fetch_add(rays, std::memory_order_relaxed);
    }
    /// Counts one ray of the pixel as answered. Open the rays that it spawned before.
    void close(uint32_t pixel) {
        assert(!done(pixel));
        if (under_way_[pixel].fetch_sub(1, std::memory_order_acq_rel) == 1)
            done_.fetch_add(1, std::memory_order_relaxed);
    }

    bool done(uint32_t pixel) const {
        return under_way_[pixel].load(std::memory_order_acquire) == 0;
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

    /// Returns the mean light of a pixel that is done.
    dvec3 mean(uint32_t pixel) const;
    /// Returns the picture. Pixels that are not done are black, with alpha 0.
    Image image() const;

private:
    uint32_t width_, height_, samples_;
    std::vector<std::array<std::atomic<int64_t>, 3>> sums_;
    std::vector<std::atomic<uint32_t>> under_way_; // rays of each pixel
    std::atomic<uint64_t> done_{0};                // pixels
};

} // namespace ovc
