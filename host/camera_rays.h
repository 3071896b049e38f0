// SPDX-License-Identifier: Apache-2.0
// CameraRays: the camera's rays of a film's pixels that are not done, in an order in which
// neighbours go the same way.
#pragma once

#include "host/camera.h"
#include "host/film.h"
#include "host/integrator.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// Where in its pixel the i-th of `samples` camera rays goes through, from (0, 0) top left to
/// (1, 1): the middle, or a (0, 2)-sequence: any first power of two of them are stratified both
/// ways and in squares. Sobol 1967.
dvec2 sample_place(uint32_t i, uint32_t samples);

class CameraRays {
public:
    CameraRays(const Pinhole& pinhole, const Film& film);

    uint64_t size() const { return uint64_t(order_.size()) * samples_; }

    /// Appends to `paths` those from `first` on.
    void make(uint64_t first, size_t count, RayList<Path>& paths) const;

private:
    const Pinhole& pinhole_;
    const uint32_t samples_;
    std::vector<uint32_t> order_; // pixels
};

} // namespace ovc
