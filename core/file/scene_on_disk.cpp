// SPDX-License-Identifier: Apache-2.0
// SceneOnDisk: shares its budget, and tells of what could not be read.
#include "core/file/scene_on_disk.h"

#include "core/vec.h"

#include <algorithm>

namespace ovc {

static constexpr uint64_t kBlockBytes = kBlockRecords * 3 * sizeof(vec3); // the largest there are

bool StoredValues::read(uint64_t first, std::span<std::byte> to) const {
    if (blocks_.read(first, to))
        return true;
    std::ranges::fill(to, std::byte(0));
    disk_.lose(what_, first, to.size() / blocks_.record_bytes());
    return false;
}

/// Returns the bytes of a cache that may take an eighth of a budget, and no more than there is.
static uint64_t cache_share(uint64_t budget_bytes, uint64_t blocks) {
    return std::max(BlockCache::min_bytes(kBlockBytes),
                    std::min(budget_bytes / 8, blocks * kBlockBytes * 5 / 4));
}

SceneOnDisk::SceneOnDisk(std::shared_ptr<const DiskFile> opened, uint64_t budget_bytes,
                         std::vector<uint64_t> sums)
    : opened_(std::move(opened)),
      file(*opened_),
      budget_(budget_bytes),
      reader_{[this](uint64_t offset, std::span<std::byte> to) { return file.read(offset, to); },
              BlockCache(kBlockBytes, cache_share(budget_bytes, sums.size())), std::move(sums)} {}

uint64_t SceneOnDisk::own_bytes_of(uint64_t budget_bytes, uint64_t blocks) {
    return cache_share(budget_bytes, blocks) + blocks * sizeof(uint64_t);
}

uint64_t SceneOnDisk::for_plugin_of(uint64_t budget_bytes) const {
    return budget_bytes - std::min(budget_bytes, own_bytes_of(budget_bytes, reader_.sums.size()));
}

/// The share of the plugin grows with the budget.
uint64_t SceneOnDisk::smallest_budget(uint64_t needed) const {
    uint64_t low = 0, high = 1;
    while (for_plugin_of(high) < needed)
        high *= 2;
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        (for_plugin_of(middle) >= needed ? high : low) = middle;
    }
    return high;
}

uint64_t SceneOnDisk::bytes() const {
    return reader_.cache.bytes() + reader_.sums.size() * sizeof(uint64_t);
}

Error SceneOnDisk::explained(Error error) const {
    if (error.kind != ErrorKind::Unreadable)
        return error;
    const std::optional<std::string> why = file.failure();
    error.message = file.path().string() + ": " + error.message + (why ? ": " + *why : "");
    return error;
}

void SceneOnDisk::lose(const std::string& what, uint64_t first, uint64_t count) {
    const std::lock_guard lock(mutex_);
    if (!lost_)
        lost_ = Error{
            "triangles " + std::to_string(first) + " to " + std::to_string(first + count - 1) +
                ": the " + what +
                (file.failure() ? " cannot be read" : " are damaged: their checksum is wrong"),
            ErrorKind::Unreadable};
}

} // namespace ovc
