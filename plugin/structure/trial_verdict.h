// SPDX-License-Identifier: Apache-2.0
// TrialVerdict: whether a trial of two ways to answer ends in a change, and when the next one is
// due.
#pragma once

#include <algorithm>
#include <chrono>

namespace ovc {

class TrialVerdict {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr auto kFirstPause = std::chrono::milliseconds(50); // doubles up to the longest
    static constexpr auto kLongestPause = std::chrono::seconds(5);
    static constexpr double kGain = 1.1; // a change must be worth it

    /// Returns whether the other way takes over, by what both have done in a unit of time.
    bool changes(double in_use, double other) {
        const bool changes = other > kGain * in_use;
        pause_ = changes ? kFirstPause : std::min<Clock::duration>(2 * pause_, kLongestPause);
        return changes;
    }
    /// From the trial, or from the first call of all, to the next trial.
    Clock::duration pause() const { return pause_; }

private:
    Clock::duration pause_ = kFirstPause;
};

} // namespace ovc
