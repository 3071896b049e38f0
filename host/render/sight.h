// SPDX-License-Identifier: Apache-2.0
// Sight tells a backend which hits count for the rays of a picture.
#pragma once

#include "core/scene.h"
#include "core/sieve.h"
#include "host/shade/integrator.h"

#include <span>
#include <vector>

namespace ovc {

/// It may be used by many threads at once.
class Sight {
public:
    /// The scene must outlive it.
    explicit Sight(const Scene& scene);

    /// Returns the sieves of rays with these purposes, which lie in `room` and in this; none where
    /// all rays see the whole scene.
    Sieves of(std::span<const Path> paths, std::vector<uint32_t>& room) const;
    Sieves of(std::span<const Shadow> shadows, std::vector<uint32_t>& room) const;
    Sieves of_camera(size_t rays, std::vector<uint32_t>& room) const;

private:
    const bool has_masks_;
};

} // namespace ovc
