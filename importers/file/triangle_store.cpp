// SPDX-License-Identifier: Apache-2.0
// TriangleStore gathers items to parts of a MiB, so that the system is not called for each
// triangle.
#include "importers/file/triangle_store.h"

#include <algorithm>
#include <cassert>

namespace ovc {

static constexpr size_t kPart = (size_t(1) << 20) / sizeof(vec3);

Result<TriangleStore> TriangleStore::create(const std::filesystem::path& folder) {
    Result<ScratchFile> corners = ScratchFile::create(folder);
    if (!corners)
        return corners.error();
    Result<ScratchFile> normals = ScratchFile::create(folder);
    if (!normals)
        return normals.error();
    return TriangleStore(std::move(*corners), std::move(*normals));
}

bool TriangleStore::flush(Items& items) {
    const uint64_t first = items.items - items.waiting.size();
    const bool written =
        items.file.write(first * sizeof(vec3), bytes_of(std::span<const vec3>(items.waiting)));
    items.waiting.clear();
    return written;
}

bool TriangleStore::add(Items& to, std::span<const vec3> items) {
    to.waiting.insert(to.waiting.end(), items.begin(), items.end());
    to.items += items.size();
    return to.waiting.size() < kPart || flush(to);
}

bool TriangleStore::add_corners(std::span<const vec3> corners) {
    assert(!meshes_.empty() && corners.size() % 3 == 0);
    return add(corners_, corners);
}

bool TriangleStore::add_normals(std::span<const vec3> normals) {
    assert(!meshes_.empty());
    return add(normals_, normals);
}

Result<Done> TriangleStore::finish() {
    for (Items* items : {&corners_, &normals_}) {
        flush(*items);
        items->waiting.shrink_to_fit();
    }
    if (const std::optional<Error> failed = error())
        return *failed;
    return Done{};
}

bool TriangleStore::read_corners(size_t mesh, uint64_t first, std::span<vec3> corners) const {
    assert(first + corners.size() <= this->corners(mesh) && corners_.waiting.empty());
    return corners_.file.read((meshes_[mesh].corners + first) * sizeof(vec3),
                              std::as_writable_bytes(corners));
}

Result<Done> TriangleStore::write(const Items& items, const ByteSink& sink) {
    assert(items.waiting.empty());
    std::vector<vec3> part;
    for (uint64_t first = 0; first < items.items; first += part.size()) {
        part.resize(size_t(std::min<uint64_t>(kPart, items.items - first)));
        if (!items.file.read(first * sizeof(vec3), std::as_writable_bytes(std::span(part))))
            return *items.file.error();
        sink(bytes_of(std::span<const vec3>(part)));
    }
    return Done{};
}

std::optional<Error> TriangleStore::error() const {
    const std::optional<Error> failed = corners_.file.error();
    return failed ? failed : normals_.file.error();
}

} // namespace ovc
