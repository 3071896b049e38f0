// SPDX-License-Identifier: Apache-2.0
// Parallel loops. Only parallel.cpp sees oneTBB, whose headers take a second to compile.
//
// A host may call us from its own oneTBB tasks, and we loop with locks taken. A thread that waits
// for the rest of such a loop must not be given another task of the host meanwhile: that could call
// us again, and wait for a lock which its own thread holds. So every loop is isolated.
//
// A loop runs whole, or throws. In a group of tasks that is cancelled, the host's or that of a loop
// of ours around it whose other parts threw, oneTBB would leave parts of it out and say nothing; so
// every loop is a group of its own, which only what its own parts throw can end.
#pragma once

#include "core/function_ref.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace ovc {

/// Calls body(first, last) on disjoint ranges that cover [0, count), of at least `grain` (> 0)
/// items where possible, from several threads. An exception from body is thrown here.
void parallel_for(size_t count, size_t grain, FunctionRef<void(size_t, size_t)> body);

/// Runs both, perhaps at the same time. An exception from one of them is thrown here.
void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b);

/// Forks of one recursion (in_forks): fork(a, b) runs both, perhaps at the same time. Unlike in
/// parallel_invoke(), a thread that waits for one of them may take on another fork of it.
class Fork {
public:
    explicit Fork(void* context) : context_(context) {}
    void operator()(FunctionRef<void()> a, FunctionRef<void()> b) const;

private:
    void* context_; // oneTBB's; null under ThreadSanitizer
};

/// Calls body. An exception from a fork ends all of them, and is thrown here.
void in_forks(FunctionRef<void(const Fork&)> body);

/// Folds [0, count) with body(first, last, T) -> T over a fixed sequence of ranges, each of which
/// begins with a copy of `identity`, and joins their results in order with join(T, T) -> T. The
/// result is the same on every run, on any number of threads.
template <class T, class Body, class Join>
T parallel_reduce(size_t count, T identity, Body&& body, Join&& join) {
    constexpr size_t kMinItems = 4096, kMaxRanges = 64;
    struct Part { // because elements of vector<bool> would share a word
        T value;
    };
    const size_t ranges = std::clamp<size_t>(count / kMinItems, 1, kMaxRanges);
    std::vector<Part> parts(ranges, Part{std::move(identity)});
    const auto begin_of = [&](size_t range) {
        return count / ranges * range + std::min(range, count % ranges);
    };
    parallel_for(ranges, 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            parts[i].value = body(begin_of(i), begin_of(i + 1), std::move(parts[i].value));
    });
    T total = std::move(parts[0].value);
    for (size_t i = 1; i < ranges; ++i)
        total = join(std::move(total), std::move(parts[i].value));
    return total;
}

/// Starts the threads that loops of this thread run on, which stay. Otherwise they would start
/// within the first loops, and where the system refuses one there, oneTBB throws in the midst of a
/// loop or ends the process. Throws std::system_error where the system refuses one.
void start_threads();

/// The threads that loops of one owner run on, of which there is a max number together.
class LoopThreads {
public:
    /// count: 0 for no limit.
    explicit LoopThreads(size_t count);
    ~LoopThreads();
    LoopThreads(const LoopThreads&) = delete;

    /// While it lives, loops that this thread begins run on these threads. A loop for which none is
    /// free waits. ThreadSanitizer's loops know no limit.
    class Scope {
    public:
        explicit Scope(LoopThreads& threads);
        ~Scope();
        Scope(const Scope&) = delete;

    private:
        LoopThreads* before_;
    };

    /// Returns those of the Scope that this thread is in; null outside of any.
    static LoopThreads* of_this_thread();

    struct Arena;
    Arena* arena() { return arena_.get(); }

private:
    std::unique_ptr<Arena> arena_; // none without a limit
};

/// While it lives, loops of the whole process run on at most `threads` (> 0) threads.
class ThreadLimit {
public:
    explicit ThreadLimit(size_t threads);
    ~ThreadLimit();

private:
    struct Limit;
    std::unique_ptr<Limit> limit_;
};

/// Returns the max number of threads that loops of this thread run on.
size_t thread_count();

/// Sorts [first, last) by <. Equal elements come in any order.
template <class Iterator>
void parallel_sort(Iterator first, Iterator last) {
    const size_t count = size_t(last - first);
    const size_t parts = count < 4096 ? 1 : std::bit_ceil(thread_count());
    const auto begin_of = [&](size_t part) { return first + ptrdiff_t(count * part / parts); };
    parallel_for(parts, 1, [&](size_t from, size_t to) {
        for (size_t i = from; i < to; ++i)
            std::sort(begin_of(i), begin_of(i + 1));
    });
    for (size_t merged = 1; merged < parts; merged *= 2)
        parallel_for(parts / merged / 2, 1, [&](size_t from, size_t to) {
            for (size_t i = 2 * merged * from; i < 2 * merged * to; i += 2 * merged)
                std::inplace_merge(begin_of(i), begin_of(i + merged), begin_of(i + 2 * merged));
        });
}

} // namespace ovc
