// SPDX-License-Identifier: Apache-2.0
// Loops on oneTBB; under ThreadSanitizer those of parallel_threads.cpp take their place.
#include "core/system/parallel.h"

#include "core/system/blocked_signals.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <latch>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace ovc {

struct LoopThreads::Arena {
    oneapi::tbb::task_arena arena;
};

static constinit thread_local LoopThreads* loop_threads = nullptr;

/// Returns the arena of this thread's loops; nullptr: that of the process.
static oneapi::tbb::task_arena* own_arena() {
    LoopThreads::Arena* const own = loop_threads ? loop_threads->arena() : nullptr;
    return own ? &own->arena : nullptr;
}

LoopThreads::LoopThreads(size_t count) {
    if (count > 0 && count < thread_count()) // oneTBB warns of more than there are
        arena_.reset(new Arena{oneapi::tbb::task_arena(int(count))});
}

LoopThreads::~LoopThreads() = default;

LoopThreads::Scope::Scope(LoopThreads& threads) : before_(std::exchange(loop_threads, &threads)) {}

LoopThreads* LoopThreads::of_this_thread() {
    return loop_threads;
}

LoopThreads::Scope::~Scope() {
    loop_threads = before_;
}

#ifndef __SANITIZE_THREAD__
namespace {

using Context = oneapi::tbb::task_group_context;

/// Calls loop(context) in isolation and in a group of its own. In that context it runs in this
/// thread's floating-point mode. Otherwise it would run in the mode of the thread on which oneTBB
/// began, which may be the host's and flush subnormals, say.
void isolated(FunctionRef<void(Context&)> loop) {
    Context context(Context::isolated, Context::default_traits | Context::fp_settings);
    const auto run = [&] { oneapi::tbb::this_task_arena::isolate([&] { loop(context); }); };
    if (oneapi::tbb::task_arena* const arena = own_arena())
        arena->execute(run);
    else
        run();
}

} // namespace

void parallel_for(size_t count, size_t grain, FunctionRef<void(size_t, size_t)> body) {
    assert(grain > 0);
    if (count <= grain) { // a task would wake a thread, which finds nothing to do
        if (count > 0)
            body(0, count);
        return;
    }
    using Range = oneapi::tbb::blocked_range<size_t>;
    isolated([&](Context& context) {
        oneapi::tbb::parallel_for(
            Range(0, count, grain), [&](const Range& range) { body(range.begin(), range.end()); },
            context);
    });
}

void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
    isolated([&](Context& context) { oneapi::tbb::parallel_invoke(a, b, context); });
}

void Fork::operator()(FunctionRef<void()> a, FunctionRef<void()> b) const {
    oneapi::tbb::parallel_invoke(a, b, *static_cast<Context*>(context_));
}

void in_forks(FunctionRef<void(const Fork&)> body) {
    isolated([&](Context& context) { body(Fork(&context)); });
}
#endif

struct ThreadLimit::Limit {
    oneapi::tbb::global_control control;
};

ThreadLimit::ThreadLimit(size_t threads)
    : limit_(new Limit{{oneapi::tbb::global_control::max_allowed_parallelism, threads}}) {
    assert(threads > 0);
}

ThreadLimit::~ThreadLimit() = default;

size_t thread_count() {
    const size_t all = oneapi::tbb::global_control::active_value(
        oneapi::tbb::global_control::max_allowed_parallelism);
    const oneapi::tbb::task_arena* const arena = own_arena();
    return arena ? std::min(all, size_t(arena->max_concurrency())) : all;
}

namespace {

/// Throws where the system does not allow this process `count` threads more.
void try_threads(size_t count) {
    std::latch all_tried(1);
    std::vector<std::thread> threads;
    struct Joined {
        std::latch& all_tried;
        std::vector<std::thread>& threads;
        ~Joined() {
            all_tried.count_down();
            for (std::thread& thread : threads)
                thread.join();
        }
    } const joined{all_tried, threads};
    threads.reserve(count);
    for (size_t i = 0; i < count; ++i)
        threads.emplace_back([&] { all_tried.wait(); });
}

/// Runs a loop whose parts wait for each other, so that every thread must come. They do not wait
/// for ever, because the host may have given oneTBB other work.
void gather_threads(size_t count) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + std::chrono::milliseconds(20);
    std::atomic<size_t> there{0};
    parallel_for(count, 1, [&](size_t first, size_t last) {
        there += last - first;
        while (there < count && Clock::now() < until)
            std::this_thread::yield();
    });
}

} // namespace

void start_threads() {
    static std::mutex mutex;
    static size_t started = 1;
    const std::lock_guard lock(mutex);
    if (started >= thread_count())
        return;
    const BlockedSignals blocked;
    try_threads(thread_count() - started);
    try {
        gather_threads(thread_count());
    } catch (const std::runtime_error&) { // oneTBB's report of the same failure
        throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
    }
    started = thread_count();
}

} // namespace ovc
