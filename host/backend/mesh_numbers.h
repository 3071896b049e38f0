// SPDX-License-Identifier: Apache-2.0
// MeshNumbers: the numbers that the library has for the meshes of a scene. A mesh that is added
// after another was removed gets a number that no mesh had before, so that the two come apart.
#pragma once

#include "core/exclusions.h"
#include "core/ray.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The library's numbers rise with those of the scene, so that ties between triangles are decided
/// alike by both.
class MeshNumbers {
public:
    /// Returns the number of meshes of the scene.
    uint32_t count() const { return uint32_t(in_library_.size()); }
    /// Enters the library's number of the scene's next mesh.
    void add(uint32_t in_library);
    /// Forgets the scene's meshes from this one on.
    void forget_from(uint32_t mesh);

    /// Returns whether a mesh has two numbers. All functions below change nothing otherwise.
    bool differ() const { return differ_; }
    uint32_t in_library(uint32_t mesh) const { return in_library_[mesh]; }
    TriangleId in_library(TriangleId id) const {
        return id.mesh == kNone ? id : TriangleId{in_library_[id.mesh], id.prim};
    }
    TriangleId in_scene(TriangleId id) const {
        return id.mesh == kNone ? id : TriangleId{in_scene_[id.mesh], id.prim};
    }
    void to_scene(std::span<Hit> hits) const;

private:
    std::vector<uint32_t> in_library_; // by the number in the scene
    std::vector<uint32_t> in_scene_;   // by the library's; kNone: the mesh was removed
    bool differ_ = false;
};

/// Asks a filter of the scene about hits in the library's numbers.
class LibraryFilter final : public HitFilter {
public:
    LibraryFilter(const MeshNumbers& numbers, HitFilter& filter)
        : numbers_(numbers), filter_(filter) {}

    bool keep(std::span<const uint64_t> rays, std::span<const Hit> hits,
              std::span<uint8_t> keep) override;

private:
    const MeshNumbers& numbers_;
    HitFilter& filter_;
};

/// The triangles and hits that exclude others, in the library's numbers.
class LibraryExclusions {
public:
    LibraryExclusions(const MeshNumbers& numbers, std::span<const TriangleId> skip,
                      std::span<const Hit> after);

    std::span<const TriangleId> skip() const { return skip_; }
    std::span<const Hit> after() const { return after_; }

private:
    std::vector<TriangleId> skip_room_;
    std::vector<Hit> after_room_;
    std::span<const TriangleId> skip_;
    std::span<const Hit> after_;
};

} // namespace ovc
