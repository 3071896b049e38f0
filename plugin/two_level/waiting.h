// SPDX-License-Identifier: Apache-2.0
// Waiting: queues of the rays that wait for leaves outside the pool; and the choice of the leaves
// that are worth moving in.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

class Waiting {
public:
    explicit Waiting(size_t leaves) : queues_(leaves) {}

    void push(uint32_t leaf, uint32_t ray) {
        queues_[leaf].push_back(ray);
        ++count_;
    }
    std::vector<uint32_t> take(uint32_t leaf) {
        assert(leaf < queues_.size());
        count_ -= queues_[leaf].size();
        return std::exchange(queues_[leaf], {});
    }
    size_t count() const { return count_; }

    size_t count(uint32_t leaf) const { return queues_[leaf].size(); }

private:
    std::vector<std::vector<uint32_t>> queues_; // per leaf
    size_t count_ = 0;
};

/// Moving so many bytes takes as long as answering a ray in double: each takes 1 us on a core
/// (docs/decisions/0013).
inline constexpr uint64_t kBytesARay = 8192;

/// A byte that must first be read from a disk counts as so many that are moved to the GPU: disks
/// give some 2 GB/s, and moving takes in some 8.
inline constexpr uint64_t kDiskByte = 4;

/// Returns the leaves worth moving in, where counts[leaf] rays wait for each, and moving it costs
/// as much as that of costs[leaf] bytes: those with more rays per byte come first. A leaf that is
/// worth less than an eighth of the first is left out, because its queue may grow; so is one with
/// less than a ray for `bytes_a_ray` (> 0), because doubles answer its rays sooner than it is
/// moved.
inline std::vector<uint32_t> worth_moving(std::span<const size_t> counts,
                                          std::span<const uint64_t> costs, uint64_t bytes_a_ray) {
    assert(counts.size() == costs.size() && bytes_a_ray > 0);
    constexpr double kMinShare = 1.0 / 8;
    std::vector<std::pair<double, uint32_t>> leaves;
    for (uint32_t leaf = 0; leaf < counts.size(); ++leaf)
        if (counts[leaf] > 0 && counts[leaf] >= costs[leaf] / bytes_a_ray)
            leaves.emplace_back(-double(counts[leaf]) / double(costs[leaf]), leaf);
    std::sort(leaves.begin(), leaves.end());
    std::vector<uint32_t> wanted;
    for (const auto& [minus_worth, leaf] : leaves)
        if (minus_worth <= leaves.front().first * kMinShare)
            wanted.push_back(leaf);
    return wanted;
}

} // namespace ovc
