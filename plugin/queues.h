// SPDX-License-Identifier: Apache-2.0
// The rays that wait for each leaf, and which leaf is next.
#pragma once

#include "core/ray.h"
#include "gpu/page.h"
#include "gpu/tracer.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace ovc {

class Queues {
public:
    explicit Queues(size_t leaves) : waiting_(leaves) {}

    void push(uint32_t leaf, uint32_t ray) { waiting_[leaf].push_back(ray); }
    std::vector<uint32_t> take(uint32_t leaf) { return std::exchange(waiting_[leaf], {}); }

    /// The resident leaf with most rays; else the leaf with most rays per byte to move; kNone when
    /// nobody waits.
    uint32_t choose(const Tracer& tracer, const std::vector<Page>& pages) const {
        uint32_t best = kNone;
        bool best_resident = false;
        double best_worth = 0;
        for (uint32_t leaf = 0; leaf < waiting_.size(); ++leaf) {
            if (waiting_[leaf].empty())
                continue;
            const bool resident = tracer.resident(leaf);
            const double rays = double(waiting_[leaf].size());
            const double worth = resident ? rays : rays / double(pages[leaf].bytes());
            if (resident == best_resident ? worth > best_worth : resident) {
                best = leaf;
                best_resident = resident;
                best_worth = worth;
            }
        }
        return best;
    }

private:
    std::vector<std::vector<uint32_t>> waiting_;
};

} // namespace ovc
