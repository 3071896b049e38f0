// SPDX-License-Identifier: Apache-2.0
// GlThread: the one thread on which a device's context is current. It leaves the host's own context
// and threads alone.
#pragma once

#include "core/system/parallel.h"
#include "gpu/budget/shared_budget.h"
#include "gpu/gl/debug_output.h"
#include "gpu/gl/egl_context.h"
#include "gpu/gl/kernel.h"

#include <atomic>
#include <cassert>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace ovc {

/// The limits of a device and its scenes.
struct DeviceLimits {
    uint64_t gpu_memory_bytes = 0; // of all scenes together; 0: each has a budget of its own
    uint32_t threads = 0;          // the cores that a software renderer may use; 0: all
    LoopThreads* loops = nullptr;  // of the device; outlives it. Null: those of the process
};

class DeviceTuning;

/// The state that lives on the thread: the context, the programs compiled in it, which are
/// destroyed first, and the variants that suit the device.
struct GlState {
    EglContext context;
    DebugOutput debug;
    KernelCache kernels;
    std::shared_ptr<DeviceTuning> tuning; // made by who first traces rays; null before
    uint32_t generation;                  // of the context: GlThread::generation()
};

class GlThread {
public:
    /// Starts the thread and opens the device there.
    static Result<std::unique_ptr<GlThread>> start(const std::string& device, LogSink log,
                                                   const DeviceLimits& limits = {});
    ~GlThread();
    GlThread(const GlThread&) = delete;

    /// Runs work(GlState&) on the thread, waits for it, and returns its value. An exception that
    /// work throws is thrown here. Several threads may call: first come, first served.
    template <class Work>
    auto run(Work&& work) {
        using Value = std::invoke_result_t<Work, GlState&>;
        if constexpr (std::is_void_v<Value>) {
            execute([&](GlState& state) { work(state); });
        } else {
            std::optional<Value> value;
            execute([&](GlState& state) { value.emplace(work(state)); });
            return std::move(*value);
        }
    }

    /// A piece of work that begin() hands to the thread. Whoever owns it waits for it before it
    /// goes. Waiting takes no memory, so that destructors may run work.
    class Job {
    public:
        Job() = default;
        Job(const Job&) = delete;
        ~Job() { assert(is_done_); }

    private:
        friend class GlThread;
        std::function<void(GlState&)> work_;
        std::condition_variable done_;
        bool is_done_ = true;
        std::exception_ptr thrown_{};
        Job* next_ = nullptr; // behind it
    };

    /// Has work(GlState&) run on the thread, behind all that was begun before, and returns at once.
    /// The job is not under way.
    void begin(Job& job, std::function<void(GlState&)> work);
    /// Waits for a job that was begun, and calls idle() here again and again meanwhile. An
    /// exception that its work throws is thrown here.
    void finish(Job& job, const std::function<void()>& idle);

    const DeviceInfo& info() const { return info_; }

    /// The GPU memory that all scenes of the device share.
    SharedBudget& budget() { return budget_; }

    /// How often the device has been opened. Objects of an earlier context are gone.
    uint32_t generation() const { return generation_; }

    /// Opens the device again after work has found the context dead, unless another caller has done
    /// so since `generation`. Error of the kind DeviceLost: the device cannot be opened.
    Result<Done> reopen(uint32_t generation);

private:
    GlThread(std::string device, LogSink log, const DeviceLimits& limits)
        : device_(std::move(device)),
          log_(std::move(log)),
          limits_(limits),
          budget_(limits.gpu_memory_bytes) {}

    void execute(std::function<void(GlState&)> work);
    Result<Done> open(std::optional<GlState>& state) noexcept;
    void serve();
    static void forget_if_dead(GlState& state);

    const std::string device_;
    const LogSink log_;
    const DeviceLimits limits_;
    SharedBudget budget_;
    std::mutex mutex_;                // guards the members below, and jobs
    std::condition_variable changed_; // there is another job, stop_ or started_ is set
    Job* first_job_ = nullptr;        // under way; behind it are those that wait
    Job** end_of_jobs_ = &first_job_; // where the next goes
    std::optional<Result<Done>> started_;
    bool stop_ = false;
    std::atomic<uint32_t> generation_{0};
    DeviceInfo info_;
    std::thread thread_;
};

} // namespace ovc
