// SPDX-License-Identifier: Apache-2.0
// Queues: the rays that wait for each leaf, by their numbers, and the choice of the next leaf.
// Based on: thesis, sections 3.4 and 3.5.
#pragma once

#include "core/ray.h"
#include "gpu/page/page.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ovc::thesis {

class Queues {
public:
    explicit Queues(size_t leaves) : queues_(leaves) {}

    void push(uint32_t leaf, uint32_t ray) {
        assert(leaf < queues_.size());
        queues_[leaf].push_back(ray);
        ++count_;
    }
    std::vector<uint32_t> take(uint32_t leaf) {
        assert(leaf < queues_.size() && queues_[leaf].size() <= count_);
        count_ -= queues_[leaf].size();
        return std::exchange(queues_[leaf], {});
    }
    bool empty() const { return count_ == 0; }

    /// Returns the leaf of the fullest queue, as the thesis chooses, but counts the pages to be
    /// moved: of the leaves that are resident, it takes the one with most rays; where there is
    /// none, the one with most rays per byte of its page. resident(leaf) -> bool. Not when empty().
    template <class IsResident>
    uint32_t choose(IsResident&& resident, std::span<const Page> pages) const {
        assert(!empty() && pages.size() == queues_.size());
        uint32_t best = kNone;
        std::pair best_worth(false, 0.0); // resident first
        for (uint32_t leaf = 0; leaf < queues_.size(); ++leaf) {
            if (queues_[leaf].empty())
                continue;
            const bool here = resident(leaf);
            const double rays = double(queues_[leaf].size());
            const std::pair worth(here, here ? rays : rays / double(pages[leaf].bytes()));
            if (best == kNone || worth > best_worth) {
                best = leaf;
                best_worth = worth;
            }
        }
        return best;
    }

private:
    std::vector<std::vector<uint32_t>> queues_; // per leaf
    size_t count_ = 0;
};

} // namespace ovc::thesis
