// SPDX-License-Identifier: Apache-2.0
// Shares: which rank has which page of a scene. Every rank computes the same shares from the same
// scene, so nothing is sent for it.
#pragma once

#include "core/ray.h"
#include "plugin/ranks/page_boxes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

struct ShareOptions {
    uint32_t ranks = 1;
    /// Pages of meshes that are placed several times, those of the most instances first, and then
    /// those that the most rays a byte come by are on every rank while they take no more than this
    /// together, and than lets no rank of N have more than (N + 1) / N of its part of all pages.
    uint64_t everywhere_bytes = uint64_t(24) << 20;
    /// Rays such as will be traced. None: random lines through the scene.
    std::span<const Ray> sample{};
};

/// Returns the owner of each page. Ranks get about the same number of bytes, and as far as these
/// allow the same number of the sample's rays, in stretches of pages that lie together: as few as
/// let the sample's rays visit few ranks.
std::vector<uint32_t> share_out(const BuiltScene& scene, std::span<const PageBox> boxes,
                                const ShareOptions& options);

} // namespace ovc
