// SPDX-License-Identifier: Apache-2.0
// CameraRays makes the camera's rays of a film's pixels that are not done, in an order in which
// neighbours go the same way.
#pragma once

#include "host/camera/camera.h"
#include "host/film/film.h"
#include "host/film/pixel_filter.h"
#include "host/shade/integrator.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// Returns the place in its pixel, from (0, 0) top left to (1, 1), of the i-th of `samples` camera
/// rays, at least 1. A single one is in the middle; several are a (0, 2)-sequence, of which any
/// first power of two are stratified both ways and in squares. Sobol 1967.
dvec2 sample_place(uint32_t i, uint32_t samples);

/// Returns the ray through a point of the picture, in pixels from its top left corner.
Ray ray_through(const Pinhole& pinhole, const dvec2& point);

/// The way in which a pixel's camera rays are spread over it, and over the lens.
struct CameraSampling {
    FilterOptions filter{};
    uint64_t seed = 0;          // of places on the lens, and of random places in pixels
    bool random_places = false; // other ones in each pixel; false: sample_place() in all of them
    uint32_t first_sample = 0;  // the number of a pixel's first ray
};

class CameraRays {
public:
    /// The pinhole must outlive it; the film need not.
    CameraRays(const Pinhole& pinhole, const Film& film, const CameraSampling& sampling = {});
    /// Makes rays through points of the picture, which are in pixels from its top left corner: as
    /// many for each pixel of the film that is not done as it has samples, in their order. Those of
    /// a pixel follow one another. The points must outlive it.
    CameraRays(const Pinhole& pinhole, const Film& film, std::span<const dvec2> points);
    /// Makes so many rays for each of these pixels of a film, in their order: through the pixel, or
    /// through its points where there are points.
    CameraRays(const Pinhole& pinhole, uint32_t samples, std::vector<uint32_t> pixels,
               std::span<const dvec2> points, const CameraSampling& sampling = {});

    uint64_t size() const { return uint64_t(order_.size()) * samples_; }

    /// Appends `count` rays from index `first` on to `paths`; first + count <= size().
    void make(uint64_t first, size_t count, RayList<Path>& paths) const;

private:
    struct Place {
        uint32_t pixel, sample; // of the film
        uint32_t x, y;          // the pixel of the picture
        dvec2 within;           // the place within that pixel
        dvec2 lens;             // the place on the lens, in the unit disk
    };
    Place place(uint32_t pixel, uint32_t sample) const;
    Place sampled(uint32_t pixel, uint32_t sample) const;

    const Pinhole& pinhole_;
    const Cone cone_;
    const uint32_t samples_;
    const CameraSampling sampling_;
    const PixelFilter filter_;
    std::vector<uint32_t> order_;   // pixels of the film
    std::span<const dvec2> points_; // empty: rays through pixels
};

} // namespace ovc
