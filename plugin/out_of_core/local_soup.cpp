// SPDX-License-Identifier: Apache-2.0
// LocalSoup: begins a chunk with each mesh that comes.
#include "plugin/out_of_core/local_soup.h"

#include <cassert>
#include <cstring>
#include <utility>

namespace ovc {

void LocalSoup::finish() {
    if (mesh_.size() == soup_.chunks.size())
        return;
    const SourceMesh& mesh = meshes_[mesh_.back()];
    soup_.chunks.push_back(mesh.has_doubles
                               ? Chunk::owning_doubles(mesh.origin, std::exchange(doubles_, {}))
                               : Chunk::owning(mesh.origin, std::exchange(floats_, {})));
}

void LocalSoup::add(TriangleId name, Bytes corners) {
    if (mesh_.empty() || mesh_.back() != name.mesh) {
        assert(mesh_.empty() || mesh_.back() < name.mesh);
        finish();
        mesh_.push_back(name.mesh);
        prims_.emplace_back();
    }
    assert(corners.size() == meshes_[name.mesh].triangle_bytes());
    assert(prims_.back().empty() || prims_.back().back() < name.prim);
    prims_.back().push_back(name.prim);
    const auto append = [&](auto& to) {
        to.resize(to.size() + 3);
        std::memcpy(&to[to.size() - 3], corners.data(), corners.size());
    };
    if (meshes_[name.mesh].has_doubles)
        append(doubles_);
    else
        append(floats_);
    ++size_;
}

std::vector<TriangleId> LocalSoup::triangles() const {
    std::vector<TriangleId> ids;
    ids.reserve(size_);
    for (uint32_t chunk = 0; chunk < prims_.size(); ++chunk)
        for (uint32_t i = 0; i < prims_[chunk].size(); ++i)
            ids.push_back({chunk, i});
    return ids;
}

} // namespace ovc
