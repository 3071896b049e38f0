// SPDX-License-Identifier: Apache-2.0
// HostBudget: halves and quarters, and the smallest budget that leaves room for each part.
#include "plugin/out_of_core/host_budget.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovc {
namespace {

constexpr uint64_t kMinBuffer = 4096;
constexpr uint64_t kMaxBuffer = 256 << 10;
constexpr uint64_t kMinBudget = 8 << 20; // blocks that are read, and what tables take at least
/// Roughly how many copies of a triangle all cells have together, and how full cells are.
constexpr double kCopies = 1.4, kFull = 0.5;

} // namespace

uint32_t HostBudget::sample_rate(uint64_t triangles) const {
    const uint64_t most = std::max<uint64_t>(bytes / 4 / kBytesOfSample, 1);
    return uint32_t(std::bit_ceil((triangles + most - 1) / most));
}

uint64_t HostBudget::buffer_bytes(size_t cells) const {
    return std::clamp(bytes / 8 / std::max<size_t>(cells, 1), kMinBuffer, kMaxBuffer);
}

uint64_t smallest_host_budget(uint64_t triangles, size_t threads) {
    // With leaves of bytes / (2 kBytesOfCell threads), the smallest buffers of all cells take an
    // eighth of the bytes: an equation for their square.
    const double cells_times_bytes =
        double(triangles) * kCopies / kFull * 2 * double(kBytesOfCell) * double(threads);
    return std::max(kMinBudget, uint64_t(std::sqrt(8 * double(kMinBuffer) * cells_times_bytes)));
}

} // namespace ovc
