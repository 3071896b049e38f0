// SPDX-License-Identifier: Apache-2.0
// TriangleStore gathers items to parts of a MiB, so that the system is not called for each
// triangle.
#include "importers/scratch/triangle_store.h"

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

void TriangleStore::begin_mesh() {
    mesh_ = meshes();
    corners_.meshes.emplace_back();
    normals_.meshes.emplace_back();
}

void TriangleStore::go_on_with(size_t mesh) {
    assert(mesh < meshes());
    mesh_ = mesh;
}

/// The normals' place in the file stays unused.
void TriangleStore::drop_normals(size_t mesh) {
    assert(mesh < meshes());
    normals_.meshes[mesh] = {};
}

bool TriangleStore::add(Items& to, std::span<const vec3> items) const {
    assert(mesh_ < to.meshes.size());
    Mesh& mesh = to.meshes[mesh_];
    const bool goes_on = !mesh.runs.empty() &&
                         mesh.runs.back().at + mesh.items - mesh.runs.back().before == to.items;
    if (!goes_on && !items.empty())
        mesh.runs.push_back({mesh.items, to.items});
    mesh.items += items.size();
    to.waiting.insert(to.waiting.end(), items.begin(), items.end());
    to.items += items.size();
    return to.waiting.size() < kPart || flush(to);
}

bool TriangleStore::add_corners(std::span<const vec3> corners) {
    assert(corners.size() % 3 == 0);
    return add(corners_, corners);
}

bool TriangleStore::add_normals(std::span<const vec3> normals) {
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
    assert(corners_.waiting.empty());
    return read(corners_, corners_.meshes[mesh], first, corners);
}

bool TriangleStore::read_normals(size_t mesh, uint64_t first, std::span<vec3> normals) const {
    assert(normals_.waiting.empty());
    return normals.empty() || read(normals_, normals_.meshes[mesh], first, normals);
}

bool TriangleStore::read(const Items& items, const Mesh& mesh, uint64_t first, std::span<vec3> to) {
    assert(first + to.size() <= mesh.items);
    auto run = std::ranges::upper_bound(mesh.runs, first, {}, &Run::before);
    for (; !to.empty(); ++run) {
        const Run& from = *(run - 1);
        const uint64_t end = run == mesh.runs.end() ? mesh.items : run->before;
        const std::span part = to.first(size_t(std::min<uint64_t>(to.size(), end - first)));
        const uint64_t at = from.at + first - from.before;
        if (!items.file.read(at * sizeof(vec3), std::as_writable_bytes(part)))
            return false;
        to = to.subspan(part.size());
        first += part.size();
    }
    return true;
}

Result<Done> TriangleStore::write(const Items& items, const ByteSink& sink) {
    assert(items.waiting.empty());
    std::vector<vec3> part;
    for (const Mesh& mesh : items.meshes)
        for (uint64_t first = 0; first < mesh.items; first += part.size()) {
            part.resize(size_t(std::min<uint64_t>(kPart, mesh.items - first)));
            if (!read(items, mesh, first, part))
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
