// SPDX-License-Identifier: Apache-2.0
// The loops of parallel.h on plain threads, for ThreadSanitizer: oneTBB's library is not compiled
// with it, so that what its tasks hand to each other would look like races, and real ones would
// drown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <utility>

namespace ovc {

template <class A, class B>
void parallel_invoke(A&& a, B&& b) {
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

class Fork {
public:
    template <class A, class B>
    void operator()(A&& a, B&& b) const {
        parallel_invoke(std::forward<A>(a), std::forward<B>(b));
    }
};

template <class Body>
void in_forks(Body&& body) {
    body(Fork());
}

template <class Body>
void parallel_for(size_t count, size_t grain, Body&& body) {
    const size_t half = count / 2;
    if (half < std::max<size_t>(grain, 1)) {
        if (count > 0)
            body(size_t(0), count);
        return;
    }
    parallel_invoke([&] { body(size_t(0), half); }, [&] { body(half, count); });
}

template <class T, class Body, class Join>
T parallel_reduce(size_t count, T identity, Body&& body, Join&& join) {
    const size_t half = count / 2;
    T first = identity, second = identity;
    parallel_invoke([&] { first = body(size_t(0), half, std::move(first)); },
                    [&] { second = body(half, count, std::move(second)); });
    return join(std::move(first), std::move(second));
}

template <class Iterator>
void parallel_sort(Iterator first, Iterator last) {
    std::sort(first, last);
}

} // namespace ovc
