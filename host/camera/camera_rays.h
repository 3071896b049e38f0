// SPDX-License-Identifier: Apache-2.0
// CameraRays: the camera's rays of a film's pixels that are not done, in an order in which
// neighbours go the same way.
#pragma once

#include "host/camera/camera.h"
#include "host/render/film.h"
#include "host/shade/integrator.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Where in its pixel the i-th of `samples` camera rays goes through, from (0, 0) top left to
/// (1, 1): the middle, or a (0, 2)-sequence: any first power of two of them are stratified both
/// ways and in squares. Sobol 1967.
dvec2 sample_place(uint32_t i, uint32_t samples);

class CameraRays {
public:
    CameraRays(const Pinhole& pinhole, const Film& film);
    /// One through each of the points of the picture, in pixels from its top left corner, in their
    /// order; what each sees is a pixel of its own. The points outlive it.
    CameraRays(const Pinhole& pinhole, std::span<const dvec2> points);

    uint64_t size() const {
        return points_.empty() ? uint64_t(order_.size()) * samples_ : points_.size();
    }

    /// Appends to `paths` those from `first` on.
    void make(uint64_t first, size_t count, RayList<Path>& paths) const;

private:
    struct Place {
        uint32_t pixel, sample; // of the film
        uint32_t x, y;          // of the picture
        dvec2 within;           // that pixel of the picture
    };
    Place place(uint64_t i) const;

    const Pinhole& pinhole_;
    const uint32_t samples_;
    std::vector<uint32_t> order_;   // pixels
    std::span<const dvec2> points_; // empty: pixels
};

} // namespace ovc
