// SPDX-License-Identifier: Apache-2.0
// BuildProgress: tells the caller of a build how far the build has come, and lets the caller stop
// it.
#pragma once

#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

namespace ovc {

/// Thrown through a build that its caller has stopped. Unwinding frees whatever the build had made.
struct Cancelled {};

/// The stages of a build in a row: each is a share of the whole and takes a number of units of
/// work. Functions that build take a pointer to one; null means that nobody wants reports.
class BuildProgress {
public:
    /// Called at the beginning of each stage, at the end, and in between at most fifty times a
    /// second; from any thread, but never from two at once. done goes from 0 to 1 and never
    /// decreases. stage is a string literal that names the work under way. Returning false stops
    /// the build.
    using Report = std::function<bool(double done, const char* stage)>;

    explicit BuildProgress(Report report) : report_(std::move(report)) { assert(report_); }

    /// Begins the next stage, which is `share` of the whole and takes `work` units. Throws
    /// Cancelled when told to stop. No other thread may call add() meanwhile.
    void begin(const char* stage, double share, uint64_t work);

    /// Counts `units` of the stage as done. Any thread may call this. Throws Cancelled when told to
    /// stop, in every thread that calls it.
    void add(uint64_t units);

    /// Reports that all is done, whatever units were left. Throws Cancelled when told to stop.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void tell(double done, const char* stage);

    const Report report_;
    std::mutex mutex_; // guards the report and the next four members
    const char* stage_ = "";
    double before_ = 0; // the share of the stages before this one
    double share_ = 0;
    double told_ = 0;
    std::atomic<uint64_t> work_{1};
    std::atomic<uint64_t> done_{0};
    std::atomic<Clock::rep> next_{0}; // when to report again
    std::atomic<bool> cancelled_{false};
};

inline void begin(BuildProgress* progress, const char* stage, double share, uint64_t work) {
    if (progress)
        progress->begin(stage, share, work);
}

inline void add(BuildProgress* progress, uint64_t units) {
    if (progress)
        progress->add(units);
}

/// Counts the rounds of a loop on one thread, and every kStep rounds adds them to the progress and
/// so looks whether to stop.
class LoopProgress {
public:
    explicit LoopProgress(BuildProgress* progress) : progress_(progress) {}

    /// Call this after every round.
    void step() {
        if (++rounds_ == kStep)
            finish();
    }

    /// Call this after the last round.
    void finish() {
        add(progress_, rounds_);
        rounds_ = 0;
    }

private:
    static constexpr uint32_t kStep = 4096;

    BuildProgress* progress_;
    uint32_t rounds_ = 0;
};

} // namespace ovc
