// SPDX-License-Identifier: Apache-2.0
// BuiltScene: what a commit makes of a soup before any of it goes to a GPU. Building and restoring
// make one; planning, saving, tracing, resolving and the exact fallback read it.
#pragma once

#include "core/build_progress.h"
#include "core/numbering.h"
#include "core/soup.h"
#include "core/triangle.h"
#include "core/twins.h"
#include "gpu/page.h"
#include "kdtree/partition.h"
#include "plugin/leaf_limits.h"
#include "shaders/layout.h"

#include <cstdint>
#include <vector>

namespace ovc {

struct BuiltScene {
    explicit BuiltScene(const Soup& soup_) : soup(soup_), numbers(soup_) {}

    const Soup& soup; // outlives the scene
    Numbering numbers;
    Dropped dropped;
    Twins twins;
    uint64_t triangles = 0;  // in leaves, each counted once
    LeafLimits limits{};     // that the leaves keep to
    Level1 level1;           // without twins
    std::vector<Page> pages; // pages[i] belongs to level1.leaves[i]
    bool from_saved = false;
    double seconds_level1 = 0;
    double seconds_level2 = 0;

    /// The triangle that a ray which does not see `skip` meets where a page has `number`.
    TriangleId seen(uint32_t number, TriangleId skip) const {
        return twins.seen(numbers.id(number), skip);
    }

    /// The number of a triangle that the kernel passes over for a ray; OVC_NO_TRIANGLE where the
    /// triangle stands for twins, which the ray does see.
    uint32_t number_to_skip(TriangleId id) const {
        return id.mesh == kNone || twins.stands_for_others(id) ? OVC_NO_TRIANGLE : numbers.of(id);
    }

    /// As Nearest::offer().
    bool offer(Nearest& nearest, TriangleId id) const {
        return nearest.offer(soup.triangle(id), id);
    }

    uint64_t level2_bytes() const;
    uint64_t largest_page_bytes() const;
    uint64_t host_bytes() const; // of level 1 and level 2
};

/// The triangles that leaves are made of: those that can be hit, without twins.
struct Hittable {
    std::vector<TriangleId> triangles; // sorted
    Box bounds;
};

/// Finds them, and enters in the scene what is left out. A triangle is two units of progress.
Hittable take_hittable(BuiltScene& scene, BuildProgress* progress = nullptr);

} // namespace ovc
