// SPDX-License-Identifier: Apache-2.0
#include "core/system/parallel.h"

#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

namespace ovc {
namespace {

/// Throws where the system does not allow this process so many threads more.
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

/// Runs a loop whose parts wait for each other, so that every thread must come; but not for ever,
/// because the host may have given oneTBB other work.
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
    static const bool started = [] {
        try_threads(thread_count() - 1);
        try {
            gather_threads(thread_count());
        } catch (const std::runtime_error&) { // oneTBB's word for the same
            throw std::system_error(
                std::make_error_code(std::errc::resource_unavailable_try_again));
        }
        return true;
    }();
    (void)started;
}

} // namespace ovc
