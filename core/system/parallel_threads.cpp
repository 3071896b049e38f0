// SPDX-License-Identifier: Apache-2.0
// The loops of parallel.h on plain threads, for ThreadSanitizer. oneTBB's library is not compiled
// with it, so data that its tasks hand to each other would look like races, and real ones would
// drown among them.
#include "core/system/parallel.h"

#ifdef __SANITIZE_THREAD__

#include <exception>
#include <thread>

namespace ovc {

void parallel_invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
    std::exception_ptr thrown;
    std::thread other([&] {
        try {
            a();
        } catch (...) {
            thrown = std::current_exception();
        }
    });
    try {
        b();
    } catch (...) {
        other.join();
        throw;
    }
    other.join();
    if (thrown)
        std::rethrow_exception(thrown);
}

void Fork::operator()(FunctionRef<void()> a, FunctionRef<void()> b) const {
    parallel_invoke(a, b);
}

void in_forks(FunctionRef<void(const Fork&)> body) {
    body(Fork(nullptr));
}

void parallel_for(size_t count, size_t grain, FunctionRef<void(size_t, size_t)> body) {
    const size_t half = count / 2;
    if (half < std::max<size_t>(grain, 1)) {
        if (count > 0)
            body(size_t(0), count);
        return;
    }
    parallel_invoke([&] { body(size_t(0), half); }, [&] { body(half, count); });
}

} // namespace ovc

#endif
