// SPDX-License-Identifier: Apache-2.0
// BuiltScene: what a commit makes of a soup before any of it goes to a GPU. Building and restoring
// make one; planning, saving, tracing, resolving and the exact fallback read it.
#pragma once

#include "core/build_progress.h"
#include "core/duplicates.h"
#include "core/exact/triangle.h"
#include "core/numbering.h"
#include "core/soup.h"
#include "core/system/stopwatch.h"
#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "kdtree/partition.h"
#include "plugin/build/shared_meshes.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace ovc {

/// About how many copies of a triangle leaves have together (as in LoosePairs) where its pages are
/// to fit into little: what is too large for that is cut again.
inline constexpr double kCopiesOfLeaves = 1.4;

/// What leaves may be: so many triangles at most (> 0), and so many bytes of a page. But where all
/// triangles fit into one page of `whole_bytes`, there is one leaf if rays gain by it.
struct LeafLimits {
    static constexpr uint64_t kAny = ~uint64_t(0);

    uint64_t triangles;
    uint64_t page_bytes;
    uint64_t whole_bytes = 0; // 0: never one leaf for that; kAny: it fits, whatever it takes

    /// How many triangles a leaf may have, of so many. rate(n, copies): about what a page of n
    /// takes, in bytes a triangle (copies: as in LoosePairs); asked only where that matters.
    /// one_leaf(): whether rays gain by one leaf (one_leaf.h), asked only where there may be one.
    template <class Rate, class OneLeaf>
    uint32_t max_triangles(uint64_t all, Rate&& rate, OneLeaf&& one_leaf) const {
        if (whole_bytes > 0 && one_leaf() && (whole_bytes == kAny || fits(all, rate(all, 1))))
            return kNone - 1;
        return pages_matter() ? triangles_at(rate(triangles, kCopiesOfLeaves))
                              : uint32_t(std::min<uint64_t>(triangles, kNone - 1));
    }
    /// The most bytes of a page where there are so many leaves.
    uint64_t page_bytes_of(uint64_t leaves) const {
        return leaves == 1 ? std::max(page_bytes, whole_bytes) : page_bytes;
    }
    /// Whether a page could be too large at all: else triangles alone decide.
    bool pages_matter() const;
    /// How many triangles a leaf may have for its page to fit where one takes so many bytes. At
    /// least 1.
    uint32_t triangles_at(double bytes_per_triangle) const;
    /// The same for the parts of a leaf whose page was too large; less than it had.
    uint32_t triangles_again(uint64_t triangles_before, uint64_t bytes_before) const;

private:
    bool fits(uint64_t all, double bytes_per_triangle) const;
};

struct SharedMesh;

struct BuiltScene {
    explicit BuiltScene(const Soup& soup_);
    ~BuiltScene();
    BuiltScene(BuiltScene&&);

    const Soup& soup; // outlives the scene
    Numbering numbers;
    Dropped dropped;
    Duplicates duplicates;
    uint64_t triangles = 0; // in leaves, each counted once
    LeafLimits limits{};    // that the leaves keep to
    Level1 level1;          // without duplicates, and without meshes that are shared
    std::vector<SharedMesh> shared;
    std::vector<uint32_t> mesh_of_chunk; // into `shared`, or kNone; empty where nothing is shared
    std::vector<Placed::Copies> copies;
    /// pages[i] belongs to level1.leaves[i]; then those of shared meshes, borrowed from them.
    std::vector<Page> pages;
    TopLevel top; // over the pages
    bool from_saved = false;
    double seconds_level1 = 0;
    double seconds_level2 = 0;

    /// The next smallest of the triangles that lie exactly where `id` does, which stands for them
    /// all; `id` where there is none.
    TriangleId second(TriangleId id) const;
    bool stands_for_others(TriangleId id) const { return second(id) != id; }

    /// The triangle that a ray which does not see `skip` meets where `id` stands.
    TriangleId seen(TriangleId id, TriangleId skip) const { return id == skip ? second(id) : id; }
    /// The same where a page has `number`.
    TriangleId seen(uint32_t number, TriangleId skip) const {
        return seen(numbers.id(number), skip);
    }
    /// The same for a hit.
    Hit seen(const Hit& hit, TriangleId skip) const {
        return as_hit_of(seen(hit.id, skip), soup, hit);
    }

    /// The number of a triangle that the kernel passes over for a ray; OVC_NO_TRIANGLE where the
    /// triangle stands for others, which the ray does see, and where there is no such triangle.
    uint32_t number_to_skip(TriangleId id) const {
        return !numbers.has(id) || stands_for_others(id) ? OVC_NO_TRIANGLE : numbers.of(id);
    }

    /// Adds a mesh that is shared, with nothing built of it.
    SharedMesh& share(const Placed::Instances& instances);
    /// The shared mesh whose instance the chunk is; null where it is none.
    const SharedMesh* shared_mesh_of(uint32_t chunk) const;
    /// The page around a point of the triangle, one that has it where there is one; kNone: the
    /// point lies where no page is.
    uint32_t page_at(const dvec3& point, TriangleId id) const;

    /// As Nearest::offer().
    bool offer(Nearest& nearest, TriangleId id) const {
        return nearest.offer(soup.triangle(id), id);
    }

    uint64_t level2_bytes() const { return total_bytes(pages); }
    uint64_t largest_page_bytes() const { return largest_bytes(pages); }
    /// Triangles of the soup, of a mesh that is shared once.
    uint64_t unique_triangles() const;
    /// Triangles in leaves, counted in each.
    uint64_t reference_count() const;
    /// Those that lie exactly where a smaller one does.
    uint64_t duplicate_count() const;
    /// Of level 1, level 2 and what leads to it.
    uint64_t host_bytes() const;
};

/// A mesh that lies in several places, cut and packed by itself.
struct SharedMesh {
    std::unique_ptr<const Soup> soup; // of one chunk, not placed
    BuiltScene scene;                 // of it; numbers are those of the mesh
    Placed::Instances instances;
    uint32_t first_page; // among those of the whole scene
};

/// The triangles that leaves are made of: those that can be hit, without duplicates.
struct Hittable {
    std::vector<TriangleId> triangles; // sorted
    Box bounds;
};

/// Finds them, and enters in the scene what is left out. A triangle is two units of progress.
Hittable take_hittable(BuiltScene& scene, BuildProgress* progress = nullptr);

/// The same with meshes that are placed more than once, as placed_chunks() tells, taken by
/// themselves. Of these a triangle is two units of progress once.
struct HittableParts {
    Hittable once;                // its bounds are those of the whole scene
    std::vector<Hittable> shared; // of scene.shared, which has their soups now
};
HittableParts take_hittable_parts(BuiltScene& scene, Placed placed,
                                  BuildProgress* progress = nullptr);

/// Appends the pages of the shared meshes, which are built, to those of the scene.
void gather_pages(BuiltScene& scene);

/// The tree over all pages, with portals to what is shared. max_links: as build_top_level() has it.
TopLevel top_level_of(const BuiltScene& scene, size_t max_links);

} // namespace ovc
