// SPDX-License-Identifier: Apache-2.0
// Boxes around the pages of a scene, by which ranks are chosen for rays.
#pragma once

#include "core/box.h"
#include "plugin/build/built_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The owner of a page that every rank has.
inline constexpr uint32_t kEveryRank = kNone;

/// Where a page lies in the world: once, or once for each instance of its mesh.
struct PageBox {
    Box box; // every hit of the page's triangles there lies in it
    uint32_t page;
};

/// Returns the boxes of all pages, in the order of pages. The scene has no top-level tree yet.
std::vector<PageBox> page_boxes(const BuiltScene& scene);

/// A box around triangles in the pages of an owner.
struct OwnedBox {
    Box box;
    uint32_t owner; // a rank, or kEveryRank
};

/// Returns boxes around all triangles, at most `max` of each owner. An owner of fewer pages has the
/// boxes of nodes of their trees, the largest of which are opened, if they are placed once; of an
/// owner of more pages, neighbours have one together. Boxes that lie side by side mostly stand side
/// by side. owners: of each page.
std::vector<OwnedBox> owned_boxes(const BuiltScene& scene, std::span<const uint32_t> owners,
                                  size_t max);

} // namespace ovc
