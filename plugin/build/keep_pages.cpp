// SPDX-License-Identifier: Apache-2.0
// Erases pages and leaves, level by level.
#include "plugin/build/keep_pages.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {

/// Keeps those of the level's own leaves and pages whose entry, counted from `first`, is set.
static void keep_own(BuiltScene& level, const PagesKept& kept, size_t first) {
    std::vector<Leaf> leaves;
    std::vector<Page> pages;
    uint32_t far = 0;
    for (size_t i = 0; i < level.level1.leaves.size(); ++i) {
        if (!kept[first + i])
            continue;
        far += i < level.level1.far_leaves;
        leaves.push_back(std::move(level.level1.leaves[i]));
        pages.push_back(std::move(level.pages[i]));
    }
    level.pages = std::move(pages);
    level.level1.leaves = std::move(leaves);
    level.level1.far_leaves = far;
    // Rays find pages by the top-level tree; the cells of the KD-tree name leaves that are gone.
    level.level1.nodes.clear();
    if (!level.level1.leaves.empty())
        level.level1.nodes.assign(1, KdNode::leaf(0, uint32_t(level.level1.leaves.size())));
}

void keep_pages(BuiltScene& scene, const PagesKept& kept) {
    assert(kept.size() == scene.pages.size());
    scene.pages.resize(scene.level1.leaves.size()); // without the borrowed ones
    keep_own(scene, kept, 0);
    for (SharedMesh& mesh : scene.shared)
        keep_own(mesh.scene, kept, mesh.first_page);
    gather_pages(scene);
}

} // namespace ovc
