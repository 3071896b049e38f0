// SPDX-License-Identifier: Apache-2.0
// RaySpan: a view of the caller's rays, which are doubles or floats and are read as doubles.
#pragma once

#include "core/ray.h"

#include <array>
#include <cassert>
#include <concepts>
#include <span>
#include <vector>

namespace ovc {

/// A ray in half the bytes. It is the same ray in double, because every float is a double.
struct FloatRay {
    vec3 org;
    float t_min;
    vec3 dir;
    float t_max;
};
static_assert(sizeof(FloatRay) == 32 && offsetof(FloatRay, dir) == 16);

/// Room for what RaySpan::address() copies, which is not written where the rays are doubles.
template <size_t count>
struct RayRoom {
    RayRoom() {}
    union {
        std::array<Ray, count> rays;
    };
};

class RaySpan {
public:
    RaySpan() = default;
    template <class Rays>
    requires std::convertible_to<const Rays&, std::span<const Ray>> RaySpan(const Rays& rays)
        : RaySpan(std::span<const Ray>(rays)) {}
    RaySpan(std::span<const Ray> rays) : doubles_(rays.data()), size_(rays.size()) {}
    explicit RaySpan(std::span<const FloatRay> rays) : floats_(rays.data()), size_(rays.size()) {}

    size_t size() const { return size_; }

    /// Returns ray i. A t_min or t_max of -0 becomes 0, because the kernel uses their signs for
    /// other things.
    Ray operator[](size_t i) const {
        assert(i < size_);
        if (!floats_) {
            const Ray& ray = doubles_[i];
            return {ray.org, ray.t_min + 0.0, ray.dir, ray.t_max + 0.0};
        }
        const FloatRay& ray = floats_[i];
        return {dvec3(ray.org), ray.t_min + 0.0, dvec3(ray.dir), ray.t_max + 0.0};
    }

    /// Returns the address of ray i where the rays are doubles, as the caller wrote it; else that
    /// of a copy in `room`.
    const Ray* address(size_t i, Ray& room) const {
        assert(i < size_);
        if (!floats_)
            return doubles_ + i;
        room = (*this)[i];
        return &room;
    }

    /// Begins to fetch ray i, which is to be read soon.
    void fetch(size_t i) const {
        assert(i < size_);
        __builtin_prefetch(floats_ ? static_cast<const void*>(floats_ + i) : doubles_ + i);
    }

    /// Returns the rays themselves where they are doubles; else a copy in `room`, empty before.
    std::span<const Ray> in_double(std::vector<Ray>& room) const {
        if (!floats_)
            return {doubles_, size_};
        assert(room.empty());
        for (size_t i = 0; i < size_; ++i)
            room.push_back((*this)[i]);
        return room;
    }

    RaySpan subspan(size_t first, size_t count) const {
        assert(first <= size_ && count <= size_ - first);
        return floats_ ? RaySpan(std::span(floats_ + first, count))
                       : RaySpan(std::span(doubles_ + first, count));
    }

private:
    const Ray* doubles_ = nullptr;
    const FloatRay* floats_ = nullptr; // null: the rays are doubles
    size_t size_ = 0;
};

} // namespace ovc
