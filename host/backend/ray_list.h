// SPDX-License-Identifier: Apache-2.0
// RayList holds rays as a backend takes them, each with the purpose of its answer.
#pragma once

#include "core/ray.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace ovc {

/// Lets resize() of a vector leave the memory of new elements as it is; each is written next.
template <class T>
struct Unwritten : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = Unwritten<U>;
    };
    void construct(T*) noexcept {}
    template <class... From>
    void construct(T* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }
};

template <class T>
using UnwrittenVector = std::vector<T, Unwritten<T>>;

template <class Purpose>
struct RayList {
    UnwrittenVector<Ray> rays;
    UnwrittenVector<TriangleId> skip; // the triangle that each ray starts on, and does not see
    UnwrittenVector<Purpose> purposes;

    size_t size() const { return rays.size(); }
    bool empty() const { return rays.empty(); }

    void push(const Ray& ray, TriangleId start, const Purpose& purpose) {
        rays.push_back(ray);
        skip.push_back(start);
        purposes.push_back(purpose);
    }

    void reserve(size_t count) {
        rays.reserve(count);
        skip.reserve(count);
        purposes.reserve(count);
    }

    void resize(size_t count) {
        rays.resize(count);
        skip.resize(count);
        purposes.resize(count);
    }

    /// Copies all of `from` over the rays from index `at` on; at + from.size() <= size().
    void put(size_t at, const RayList& from) {
        assert(at + from.size() <= size());
        std::copy(from.rays.begin(), from.rays.end(), rays.begin() + ptrdiff_t(at));
        std::copy(from.skip.begin(), from.skip.end(), skip.begin() + ptrdiff_t(at));
        std::copy(from.purposes.begin(), from.purposes.end(), purposes.begin() + ptrdiff_t(at));
    }

    void append(const RayList& from) {
        const size_t before = size();
        resize(before + from.size());
        put(before, from);
    }

    /// Moves the rays from index `first` on into `to`, whose own are dropped; first <= size().
    void move_tail(size_t first, RayList& to) {
        assert(first <= size());
        if (first == 0) {
            std::swap(*this, to);
        } else {
            to.rays.assign(rays.begin() + ptrdiff_t(first), rays.end());
            to.skip.assign(skip.begin() + ptrdiff_t(first), skip.end());
            to.purposes.assign(purposes.begin() + ptrdiff_t(first), purposes.end());
        }
        resize(first);
    }
};

} // namespace ovc
