// SPDX-License-Identifier: Apache-2.0
// Compares what pages take with the budgets, and shares them out.
#include "plugin/ranks/sharing.h"

#include "core/file/checksum.h"
#include "core/text/format_text.h"

namespace ovc {

/// Shares of fewer leaves a rank differ much.
static constexpr uint64_t kFewLeaves = 4;

/// How many boxes there are around what a rank has. More of them send fewer rays to ranks in vain,
/// and take longer to test.
static size_t max_boxes_of_rank(uint32_t ranks) {
    return std::max<size_t>(256 / ranks, 32);
}

static uint64_t checksum_of_shares(const BuiltScene& scene, std::span<const PageBox> boxes,
                                   std::span<const uint32_t> owners) {
    Checksum sum;
    for (const PageBox& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            sum.add_value(box.box.lo[axis]);
            sum.add_value(box.box.hi[axis]);
        }
    for (const Page& page : scene.pages)
        sum.add_value(page.bytes());
    sum.add(std::as_bytes(owners));
    return sum.value();
}

bool Sharing::fits(const BuiltScene& scene) const {
    const uint64_t bytes = scene.level2_bytes();
    const uint64_t rest = options_.gpu_bytes / 4; // for rays, answers and the top-level tree
    return bytes <= options_.gpu_bytes - rest && bytes <= options_.host_bytes;
}

PagesKept Sharing::choose(const BuiltScene& scene) {
    finder_.reset();
    checksum_ = 0;
    if (!options_.always && fits(scene))
        return PagesKept(scene.pages.size(), true);
    const uint32_t ranks = options_.shares.ranks;
    if (scene.pages.size() < kFewLeaves * ranks && options_.rank == 0)
        say(log_, LogLevel::Warning,
            format_text("{} {} for {} ranks: their shares will differ much; with smaller leaves "
                        "they would not",
                        scene.pages.size(), scene.pages.size() == 1 ? "leaf" : "leaves", ranks));
    const std::vector<PageBox> boxes = page_boxes(scene);
    const std::vector<uint32_t> owners = share_out(scene, boxes, options_.shares);
    checksum_ = checksum_of_shares(scene, boxes, owners);
    finder_ = std::make_unique<StopFinder>(owned_boxes(scene, owners, max_boxes_of_rank(ranks)),
                                           options_.rank);
    PagesKept kept(owners.size());
    for (size_t page = 0; page < owners.size(); ++page)
        kept[page] = owners[page] == kEveryRank || owners[page] == options_.rank;
    return kept;
}

} // namespace ovc
