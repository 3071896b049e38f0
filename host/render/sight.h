// SPDX-License-Identifier: Apache-2.0
// Sight tells a backend which hits count for the rays of a picture: by masks, who sees a mesh at
// all; by a filter, what is there of it.
#pragma once

#include "core/scene.h"
#include "core/sieve.h"
#include "host/shade/cutouts.h"
#include "host/shade/integrator.h"

#include <span>
#include <vector>

namespace ovc {

/// It may be used by many threads at once.
class Sight {
public:
    /// The scene must outlive it. with_cutouts: if false, surfaces have no holes.
    explicit Sight(const Scene& scene, bool with_cutouts = true);
    Sight(const Sight&) = delete;

    /// Returns the sieves of rays with these purposes, which lie in `room` and in this; none where
    /// all rays see the whole scene.
    Sieves of(std::span<const Path> paths, std::vector<uint32_t>& room) const;
    Sieves of(std::span<const Shadow> shadows, std::vector<uint32_t>& room) const;
    Sieves of_camera(size_t rays, std::vector<uint32_t>& room) const;

private:
    std::span<HitFilter* const> filter(HitFilter* const& one) const {
        return {&one, one ? size_t(1) : 0};
    }

    const Scene& scene_;
    const bool has_masks_;
    Cutouts by_paths_, by_shadow_rays_;
    HitFilter* const path_filter_; // null: no surface has holes
    HitFilter* const shadow_filter_;
};

} // namespace ovc
