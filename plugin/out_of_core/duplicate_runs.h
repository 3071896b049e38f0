// SPDX-License-Identifier: Apache-2.0
// DuplicateRuns: the duplicates that cells have found, in the scratch space until they are saved.
#pragma once

#include "core/duplicates.h"
#include "core/function_ref.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

class DuplicateRuns {
public:
    /// scratch: outlives this.
    explicit DuplicateRuns(ScratchSpace& scratch) : scratch_(scratch) {}

    /// Some duplicates, sorted, in the scratch space.
    struct Run {
        uint64_t offset = 0;
        uint64_t pairs = 0;
        uint64_t checksum = 0;
    };

    /// Puts those of a cell, which are sorted, to the scratch space.
    Run put(std::span<const Duplicates::Pair> pairs);
    /// Adds a run that was put there, by this or by an earlier build.
    void add(const Run& run);

    /// Calls visit() with the next duplicates until there are no more: all of them, sorted, each
    /// once, though several cells may have found it. Throws a Failure where the scratch space gives
    /// other bytes than it got.
    void for_each(FunctionRef<void(std::span<const Duplicates::Pair>)> visit) const;

private:
    ScratchSpace& scratch_;
    std::vector<Run> runs_; // none is empty
};

} // namespace ovc
