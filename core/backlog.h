// SPDX-License-Identifier: Apache-2.0
// Backlog: the rays that a host has pushed into a stream and that are not traced yet. The newest
// rays leave first, so that children end before their parents' siblings begin and few rays wait.
#pragma once

#include "core/stream.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {

class Backlog {
public:
    void push(const StreamRays& pushed) {
        assert(pushed.tokens.size() == pushed.rays.size());
        assert(pushed.skip.empty() || pushed.skip.size() == pushed.rays.size());
        rays_.insert(rays_.end(), pushed.rays.begin(), pushed.rays.end());
        tokens_.insert(tokens_.end(), pushed.tokens.begin(), pushed.tokens.end());
        skip_.insert(skip_.end(), pushed.skip.begin(), pushed.skip.end());
        skip_.resize(rays_.size());
    }

    size_t size() const { return rays_.size(); }

    /// Returns the last `count` rays (at most size()), in the order in which they were pushed. The
    /// spans are valid until the next push() or drop_last().
    StreamRays last(size_t count) const {
        assert(count <= size());
        const size_t first = size() - count;
        return {false, std::span(rays_).subspan(first), std::span(skip_).subspan(first),
                std::span(tokens_).subspan(first)};
    }
    void drop_last(size_t count) {
        assert(count <= size());
        rays_.resize(size() - count);
        skip_.resize(rays_.size());
        tokens_.resize(rays_.size());
    }

private:
    std::vector<Ray> rays_;
    std::vector<TriangleId> skip_; // one per ray, as tokens
    std::vector<uint64_t> tokens_;
};

} // namespace ovc
