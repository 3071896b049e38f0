// SPDX-License-Identifier: Apache-2.0
// HostBudget: halves and quarters, and the smallest budget that leaves room for each part.
#include "plugin/out_of_core/host_budget.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovc {
namespace {

constexpr uint64_t kMinBuffer = 1024;
constexpr uint64_t kMaxBuffer = 256 << 10;
constexpr uint64_t kMinBudget = 8 << 20; // blocks that are read, and what tables take at least
/// A triangle of floats in a buffer, and what is kept of each buffer that went to the disk
/// (DealtExtent, in a vector that doubles).
constexpr double kBytesOfRecord = 48, kBytesOfExtent = 24;
constexpr double kMaxBytesOfCell = double(kBytesOfCell + kBytesOfDouble);
/// Roughly how many copies of a triangle all cells have together, and how full cells are.
constexpr double kCopies = 1.4, kFull = 0.5;

} // namespace

uint32_t HostBudget::sample_rate(uint64_t triangles) const {
    const uint64_t max_sample = std::max<uint64_t>(bytes / 4 / kBytesOfSample, 1);
    return uint32_t(std::bit_ceil((triangles + max_sample - 1) / max_sample));
}

uint64_t HostBudget::buffer_bytes(size_t cells) const {
    return std::clamp(bytes / 8 / std::max<size_t>(cells, 1), kMinBuffer, kMaxBuffer);
}

uint64_t smallest_host_budget(uint64_t triangles, size_t threads) {
    // Leaves have bytes / (2 kMaxBytesOfCell threads) triangles, so their number times the bytes is
    // fixed. The smallest buffers of all cells take an eighth of the bytes: an equation for their
    // square. What is kept of larger ones takes a quarter: one for their cube.
    const double copies = double(triangles) * kCopies;
    const double cells_times_bytes = copies / kFull * 2 * kMaxBytesOfCell * double(threads);
    const double for_buffers = std::sqrt(8 * double(kMinBuffer) * cells_times_bytes);
    const double for_extents =
        std::cbrt(4 * kBytesOfExtent * copies * kBytesOfRecord * 8 * cells_times_bytes);
    return std::max({kMinBudget, uint64_t(for_buffers), uint64_t(for_extents)});
}

} // namespace ovc
