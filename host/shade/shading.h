// SPDX-License-Identifier: Apache-2.0
// Shading: an integrator's work over many answers, on all cores. What is spawned comes out in the
// order of the answers, and the film is told which rays are under way.
#pragma once

#include "host/shade/integrator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// For one thread at a time; keeps its memory between calls.
class Shading {
public:
    /// lights: how many shadow rays an answer may spawn.
    Shading(const Integrator& integrator, size_t lights, Film& film);

    /// So many answers at once spawn a bounded number of rays.
    size_t max_answers() const { return max_answers_; }

    /// Shades the answers of `paths` from `first` on; appends to `spawned`.
    void shade(const RayList<Path>& paths, std::span<const Hit> hits, size_t first, size_t count,
               Spawned& spawned);

    /// Shadow rays are answered; occluded[i] belongs to purposes[i].
    void arrive(std::span<const Shadow> purposes, std::span<const uint8_t> occluded);

    /// The same where light may pass what was hit: leaves those that go on, in their order.
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
