// SPDX-License-Identifier: Apache-2.0
// VisitArrays: the rays of a message that visit a rank, as arrays that a call of a structure takes.
#pragma once

#include "plugin/ranks/transport/message.h"

#include <array>
#include <cassert>

namespace ovc {

/// The place behind which hits of a ray count, as Exclusion::after.
struct VisitAfter {
    double t;
    TriangleId id;
};

/// Views of the arrays in a message, one behind the other. All but rays may be empty, for all
/// visits together; else they have an element a visit.
struct VisitArrays {
    static constexpr uint32_t kHasAfter = 1, kHasSkip = 2, kHasMasks = 4; // MessageHead::arrays
    static constexpr size_t kMaxVisitBytes =
        sizeof(Ray) + sizeof(VisitAfter) + sizeof(TriangleId) + sizeof(uint32_t);
    static_assert(kMaxVisitBytes <= 96);

    std::span<Ray> rays; // t_max: that of the nearest hit so far, or a little more
    std::span<VisitAfter> after;
    std::span<TriangleId> skip;
    std::span<uint32_t> masks;

    /// The arrays of a message with visits. It outlives them.
    explicit VisitArrays(const Message& message) {
        assert(message.has_visits());
        const MessageHead head = message.head();
        std::byte* next = message.item_bytes();
        take(rays, next, head.count);
        take(after, next, head.arrays & kHasAfter ? head.count : 0);
        take(skip, next, head.arrays & kHasSkip ? head.count : 0);
        take(masks, next, head.arrays & kHasMasks ? head.count : 0);
        assert(next == message.bytes().data() + message.bytes().size());
    }

    /// Returns how many bytes `count` visits take with these arrays.
    static size_t bytes(size_t count, uint32_t arrays) {
        return count *
               (sizeof(Ray) + (arrays & kHasAfter ? sizeof(VisitAfter) : 0) +
                (arrays & kHasSkip ? sizeof(TriangleId) : 0) + (arrays & kHasMasks ? 4u : 0));
    }

private:
    template <class T>
    static void take(std::span<T>& array, std::byte*& next, size_t count) {
        array = {reinterpret_cast<T*>(next), count};
        next += array.size_bytes();
    }
};

} // namespace ovc
