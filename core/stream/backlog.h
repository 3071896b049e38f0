// SPDX-License-Identifier: Apache-2.0
// Backlog: the rays that a host has pushed into a stream and that are not traced yet. The newest
// rays leave first, so that children end before their parents' siblings begin and few rays wait.
#pragma once

#include "core/exclusions.h"
#include "core/stream/reserve_sparingly.h"
#include "core/stream/stream.h"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace ovc {

class Backlog {
public:
    /// Takes the rays, or throws for want of memory and takes none.
    void push(const StreamRays& pushed) {
        assert(pushed.tokens.size() == pushed.rays.size());
        assert(pushed.skip.empty() || pushed.skip.size() == pushed.rays.size());
        const size_t count = size() + pushed.rays.size();
        reserve_sparingly(rays_, count);
        reserve_sparingly(tokens_, count);
        reserve_sparingly(skip_, count);
        make_room(after_, pushed.after, count);
        make_room(masks_, pushed.masks, count);
        make_room(filters_, pushed.filters, count);
        rays_.insert(rays_.end(), pushed.rays.begin(), pushed.rays.end());
        tokens_.insert(tokens_.end(), pushed.tokens.begin(), pushed.tokens.end());
        skip_.insert(skip_.end(), pushed.skip.begin(), pushed.skip.end());
        skip_.resize(rays_.size());
        const size_t before = rays_.size() - pushed.rays.size();
        append(after_, pushed.after, before, kBeforeAll);
        append(masks_, pushed.masks, before, 0u);
        append<HitFilter*>(filters_, pushed.filters, before, nullptr);
    }

    size_t size() const { return rays_.size(); }

    /// Returns the last `count` rays (at most size()), in the order in which they were pushed. The
    /// spans are valid until the next push() or drop_last().
    StreamRays last(size_t count) const {
        assert(count <= size());
        const size_t first = size() - count;
        return {false,
                std::span(rays_).subspan(first),
                std::span(skip_).subspan(first),
                std::span(tokens_).subspan(first),
                last_of(after_, first),
                last_of(masks_, first),
                last_of(filters_, first)};
    }
    /// Moves the last `count` rays (at most size()) to another backlog, in place of its own.
    void move_last(size_t count, Backlog& to) {
        to.drop_last(to.size());
        if (count == size()) {
            std::swap(*this, to);
            return;
        }
        to.push(last(count));
        drop_last(count);
    }
    void drop_last(size_t count) {
        assert(count <= size());
        rays_.resize(size() - count);
        skip_.resize(rays_.size());
        tokens_.resize(rays_.size());
        after_.resize(std::min(after_.size(), rays_.size()));
        masks_.resize(std::min(masks_.size(), rays_.size()));
        filters_.resize(std::min(filters_.size(), rays_.size()));
    }

private:
    template <class T>
    static void make_room(std::vector<T>& all, std::span<const T> pushed, size_t count) {
        if (!pushed.empty() || !all.empty())
            reserve_sparingly(all, count);
    }
    /// Brings `all` to one per ray, unless none has one: `other` for those without, among the first
    /// `before` rays. pushed: those of the rays behind these, or one for all of them.
    template <class T>
    void append(std::vector<T>& all, std::span<const T> pushed, size_t before, const T& other) {
        if (pushed.empty() && all.empty())
            return;
        all.resize(before, other);
        all.insert(all.end(), pushed.begin(), pushed.end());
        all.resize(rays_.size(), pushed.empty() ? other : pushed.front());
    }
    template <class T>
    static std::span<const T> last_of(const std::vector<T>& all, size_t first) {
        return all.empty() ? std::span<const T>() : std::span(all).subspan(first);
    }

    std::vector<Ray> rays_;
    std::vector<TriangleId> skip_; // one per ray, as tokens
    std::vector<uint64_t> tokens_;
    // One per ray, or empty where no ray that waits has one.
    std::vector<Hit> after_;
    std::vector<uint32_t> masks_;
    std::vector<HitFilter*> filters_;
};

} // namespace ovc
