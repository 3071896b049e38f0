// SPDX-License-Identifier: Apache-2.0
// Parallel loops. The only file that sees oneTBB.
//
// A host may call us from its own oneTBB tasks, and we loop with locks taken. A thread that waits
// for the rest of such a loop must not be given another task of the host meanwhile: that could call
// us again, and wait for a lock which its own thread holds. So every loop is isolated.
//
// A loop runs whole, or throws. In a group of tasks that is cancelled, the host's or that of a loop
// of ours around it whose other parts threw, oneTBB would leave parts of it out and say nothing; so
// every loop is a group of its own, which only what its own parts throw can end.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_reduce.h>
#include <oneapi/tbb/parallel_sort.h>
#include <oneapi/tbb/task_arena.h>

#include <cstddef>
#include <utility>

#ifdef __SANITIZE_THREAD__
#include "core/system/parallel_threads.h"
#endif

namespace ovc {

#ifndef __SANITIZE_THREAD__

/// loop(context) in isolation and in a group of its own. In that context it runs in this thread's
/// floating-point mode; else it would run in that of the thread on which oneTBB began, which may be
/// the host's: with subnormals flushed, say.
template <class Loop>
auto isolated(Loop&& loop) {
    using Context = oneapi::tbb::task_group_context;
    return oneapi::tbb::this_task_arena::isolate([&] {
        Context context(Context::isolated, Context::default_traits | Context::fp_settings);
        return loop(context);
    });
}

/// Calls body(first, last) on disjoint ranges that cover [0, count), of at least `grain` items
/// where possible, from several threads. What body throws is thrown here.
template <class Body>
void parallel_for(size_t count, size_t grain, Body&& body) {
    isolated([&](auto& context) {
        oneapi::tbb::parallel_for(
            oneapi::tbb::blocked_range<size_t>(0, count, grain),
            [&](const auto& range) { body(range.begin(), range.end()); }, context);
    });
}

/// body(first, last, T) -> T over ranges that cover [0, count), joined by join(T, T) -> T. Both
/// must be associative and commutative for the result to be the same on every run.
template <class T, class Body, class Join>
T parallel_reduce(size_t count, T identity, Body&& body, Join&& join) {
    return isolated([&](auto& context) {
        return oneapi::tbb::parallel_reduce(
            oneapi::tbb::blocked_range<size_t>(0, count, 4096), std::move(identity),
            [&](const auto& range, T value) {
                return body(range.begin(), range.end(), std::move(value));
            },
            std::forward<Join>(join), context);
    });
}

/// Runs both, perhaps at the same time.
template <class A, class B>
void parallel_invoke(A&& a, B&& b) {
    isolated([&](auto& context) {
        oneapi::tbb::parallel_invoke(std::forward<A>(a), std::forward<B>(b), context);
    });
}

/// Forks of one recursion (in_forks): fork(a, b) runs both, perhaps at the same time. Unlike in
/// parallel_invoke(), a thread that waits for one of them may take on any other fork of it.
class Fork {
public:
    explicit Fork(oneapi::tbb::task_group_context& context) : context_(context) {}

    template <class A, class B>
    void operator()(A&& a, B&& b) const {
        oneapi::tbb::parallel_invoke(std::forward<A>(a), std::forward<B>(b), context_);
    }

private:
    oneapi::tbb::task_group_context& context_;
};

/// body(Fork). What a fork throws ends them all, and is thrown here.
template <class Body>
void in_forks(Body&& body) {
    isolated([&](auto& context) { body(Fork(context)); });
}

/// Sorts [first, last) by <. Equal elements come in any order.
template <class Iterator>
void parallel_sort(Iterator first, Iterator last) {
    // It takes no context, but has that of the loop that it is part of.
    parallel_invoke([&] { oneapi::tbb::parallel_sort(first, last); }, [] {});
}

#endif

/// Starts the threads that loops run on, once in a process; else they start within the first loops,
/// and where the system refuses one there, oneTBB throws in the midst of a loop or ends the
/// process. Throws std::system_error.
void start_threads();

/// While it lives, loops of the whole process run on at most so many threads.
class ThreadLimit {
public:
    explicit ThreadLimit(size_t threads)
        : limit_(oneapi::tbb::global_control::max_allowed_parallelism, threads) {}

private:
    oneapi::tbb::global_control limit_;
};

/// On how many threads loops run at most.
inline size_t thread_count() {
    return oneapi::tbb::global_control::active_value(
        oneapi::tbb::global_control::max_allowed_parallelism);
}

} // namespace ovc
