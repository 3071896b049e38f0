// SPDX-License-Identifier: Apache-2.0
// Resting: brings meshes that moved into the frame of the scene, where rays need no portal to them.
#pragma once

#include "core/box.h"
#include "plugin/build/built_scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// One update of a scene. A mesh comes to rest in a commit that leaves it where it is, because the
/// next ones are likely to do so too, or that refits its pages anyway. Rays that go through portals
/// take twice as long in the kernel.
class Resting {
public:
    /// placed: chunks that the update places elsewhere.
    Resting(BuiltScene& scene, std::span<const uint32_t> placed);

    /// Takes note of how far the shared meshes reach now, before any of them is considered.
    void set_bounds(const Box& bounds);
    /// Decides about a mesh that is there already and has one instance, `chunk`. Chunks come in the
    /// order of their numbers. box: of its triangles, not placed. moved: so many of them have new
    /// corners. unique: the triangles of the scene that are packed.
    void consider(SharedMesh& mesh, uint32_t chunk, const Box& box, uint64_t moved,
                  uint64_t unique);

    /// Returns what the frame of the scene must hold, so that the meshes that rest are home.
    const Box& reach() const { return reach_; }

    /// Finds the scene's home, when its own level is up to date.
    void find_home();

    /// Returns whether all pages of the mesh are to be refitted because it comes to rest now;
    /// nothing where rays cannot come to its pages and the scene must be built anew.
    std::optional<bool> prepare(SharedMesh& mesh);

private:
    bool may_rest(const SharedMesh& mesh, uint32_t chunk) const;
    bool suits(const SharedMesh& mesh, uint32_t chunk, const Frame& frame) const;
    bool comes_home(SharedMesh& mesh, uint32_t chunk) const;
    void bring_home(SharedMesh& mesh, uint32_t chunk);

    BuiltScene& scene_;
    std::vector<uint32_t> placed_; // sorted
    std::vector<uint32_t> coming_; // chunks that come to rest, sorted
    uint64_t triangles_ = 0;       // of them, as far as nothing else refits them
    Frame frame_;                  // of the scene, about as it will be
    Box grid_;                     // which meshes may come to rest in
    Box reach_;
};

} // namespace ovc
