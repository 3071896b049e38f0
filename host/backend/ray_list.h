// SPDX-License-Identifier: Apache-2.0
// RayList holds rays as a backend takes them, each with the purpose of its answer.
#pragma once

#include "core/ray.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace ovc {

template <class Purpose>
struct RayList {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip; // the triangle that each ray starts on, and does not see
    std::vector<Purpose> purposes;

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
