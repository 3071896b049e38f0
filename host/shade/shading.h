// SPDX-License-Identifier: Apache-2.0
// Shading runs an integrator over many answers, on all cores. Spawned rays come out in the order of
// the answers, and it tells the film which rays are under way.
#pragma once

#include "host/shade/integrator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// One thread at a time may call it. It keeps its memory between calls.
class Shading {
public:
    Shading(const Integrator& integrator, Film& film);

    /// Returns how many answers shade() may get at once, so that they spawn a bounded number of
    /// rays.
    size_t max_answers() const { return max_answers_; }

    /// Shades `count` answers of `paths` from index `first` on, and appends to `spawned`. hits: as
    /// many as paths.
    void shade(const RayList<Path>& paths, std::span<const Hit> hits, size_t first, size_t count,
               Spawned& spawned);

    /// Adds the light of shadow rays that are not occluded; occluded[i] belongs to purposes[i].
    void arrive(std::span<const Shadow> purposes, std::span<const uint8_t> occluded);

    /// Does the same where light may pass the surface that was hit. It leaves the rays that go on
    /// in `shadows`, in their order.
    void pass(RayList<Shadow>& shadows, std::span<const Hit> hits);

private:
    void shade_block(const RayList<Path>& paths, std::span<const Hit> hits, size_t first,
                     size_t count, Spawned& spawned);

    const Integrator& integrator_;
    const size_t max_answers_;
    Film& film_;
    std::vector<Spawned> blocks_;
    std::vector<uint8_t> goes_on_;
};

} // namespace ovc
