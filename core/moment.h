// SPDX-License-Identifier: Apache-2.0
// Moment: the place of a picture in a sequence, by which things move.
#pragma once

#include <cassert>
#include <cstdint>

namespace ovc {

/// A still picture is of no sequence, and shows what the first of one would.
struct Moment {
    double clock = 0; // 0 in the first frame to 1 in the last
    bool in_sequence = false;
    uint32_t frame = 0, first = 0, last = 0; // numbers of frames

    static Moment of_frame(uint32_t frame, uint32_t first, uint32_t last) {
        assert(first <= frame && frame <= last);
        const double clock = first == last ? 0 : double(frame - first) / double(last - first);
        return {clock, true, frame, first, last};
    }

    /// Returns how much the clock goes on from one number to the next.
    double clock_step() const { return first == last ? 0 : 1 / double(last - first); }

    bool operator==(const Moment&) const = default;
};

} // namespace ovc
