// SPDX-License-Identifier: Apache-2.0
// BuildProgress: how far the building of a structure has come, told to whoever waits for it, who
// may also stop it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>

namespace ovc {

/// Thrown through a build that was told to stop. What it had made is freed on the way.
struct Cancelled {};

/// Stages in a row, each a share of the whole and so many units of work. Functions that build take
/// a pointer to one; null: nobody waits.
class BuildProgress {
public:
    /// Called fifty times a second at most, from any thread, but never from two at once. done: from
    /// 0 to 1, never less than before. stage: what is being done, a literal. false: stop.
    using Report = std::function<bool(double done, const char* stage)>;

    explicit BuildProgress(Report report) : report_(std::move(report)) {}

    /// Begins the next stage. Throws Cancelled when told to stop. Not while others call add().
    void begin(const char* stage, double share, uint64_t work);

    /// So many units of the stage are done. Any thread. Throws Cancelled when told to stop, in
    /// every thread that calls it.
    void add(uint64_t units);

    /// All is done, whatever was left.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void tell(double done, const char* stage);

    const Report report_;
    std::mutex mutex_; // of the report, and of what is below it
    const char* stage_ = "";
    double before_ = 0; // what the stages before took of the whole
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

/// Looks whether to stop every `step` rounds of a loop on one thread, and counts them.
class LoopProgress {
public:
    explicit LoopProgress(BuildProgress* progress) : progress_(progress) {}

    /// After every round.
    void step() {
        if (++rounds_ == kStep)
            finish();
    }

    /// After the last one.
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
