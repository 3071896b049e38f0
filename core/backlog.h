// SPDX-License-Identifier: Apache-2.0
// Backlog: rays that a host pushed into a stream and nobody traces yet. The last to come are the
// first to go, so that children end before their parents' siblings begin and few rays wait.
#pragma once

#include "core/stream.h"

#include <algorithm>
#include <vector>

namespace ovc {

class Backlog {
public:
    void push(const StreamRays& pushed) {
        rays_.insert(rays_.end(), pushed.rays.begin(), pushed.rays.end());
        tokens_.insert(tokens_.end(), pushed.tokens.begin(), pushed.tokens.end());
        skip_.insert(skip_.end(), pushed.skip.begin(), pushed.skip.end());
        skip_.resize(rays_.size());
    }

    size_t size() const { return rays_.size(); }

    /// The last `count`, in the order they came; until the next push().
    StreamRays last(size_t count) const {
        const size_t first = size() - count;
        return {false, std::span(rays_).subspan(first), std::span(skip_).subspan(first),
                std::span(tokens_).subspan(first)};
    }
    void drop_last(size_t count) {
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
