// SPDX-License-Identifier: Apache-2.0
// BuiltScene: a soup after a commit has cut and packed it, before any of it goes to a GPU. Building
// and restoring make one; planning, saving, tracing, resolving and the exact fallback read it.
#pragma once

#include "core/build_progress.h"
#include "core/changes.h"
#include "core/duplicates.h"
#include "core/exact/triangle.h"
#include "core/numbering.h"
#include "core/soup.h"
#include "core/system/stopwatch.h"
#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "kdtree/partition.h"
#include "plugin/build/far_triangles.h"
#include "plugin/build/shared_meshes.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace ovc {

/// Roughly how many copies of a triangle all leaves have together (as in LoosePairs), where limits
/// on pages decide how large leaves are. Leaves whose pages turn out too large are cut again.
inline constexpr double kCopiesOfLeaves = 1.4;

/// The limits on leaves: the max triangles of one (> 0), and the max bytes of its page. Where all
/// triangles fit into one page of `whole_bytes`, there is one leaf instead if rays gain by it.
struct LeafLimits {
    static constexpr uint64_t kAny = ~uint64_t(0);

    uint64_t triangles;
    uint64_t page_bytes;
    uint64_t whole_bytes = 0; // 0: no such single leaf; kAny: it fits at any size

    /// Returns how many of `all` triangles a leaf may have. rate(n, copies): the estimated bytes a
    /// triangle of a page of n triangles (copies: as in LoosePairs); it is called only where that
    /// matters. one_leaf(): whether rays gain by one leaf (one_leaf.h); it is called only where
    /// there may be one.
    template <class Rate, class OneLeaf>
    uint32_t max_triangles(uint64_t all, Rate&& rate, OneLeaf&& one_leaf) const {
        if (whole_bytes > 0 && one_leaf() && (whole_bytes == kAny || fits(all, rate(all, 1))))
            return kNone - 1;
        return pages_matter() ? triangles_at(rate(triangles, kCopiesOfLeaves))
                              : uint32_t(std::min<uint64_t>(triangles, kNone - 1));
    }
    /// Returns the max bytes of a page where there are so many leaves.
    uint64_t page_bytes_of(uint64_t leaves) const {
        return leaves == 1 ? std::max(page_bytes, whole_bytes) : page_bytes;
    }
    /// Whether a page could be too large at all. If not, triangles alone decide.
    bool pages_matter() const;
    /// Returns how many triangles (at least 1) a leaf may have for its page to fit, where a
    /// triangle takes so many bytes.
    uint32_t triangles_at(double bytes_per_triangle) const;
    /// Returns the same for the parts of a leaf of several triangles whose page was too large. It
    /// is less than the leaf had.
    uint32_t triangles_again(uint64_t triangles_before, uint64_t bytes_before) const;

private:
    bool fits(uint64_t all, double bytes_per_triangle) const;
};

class LeafStore;
struct SharedMesh;

struct BuiltScene {
    explicit BuiltScene(const Soup& soup_);
    ~BuiltScene();
    BuiltScene(BuiltScene&&);

    const Soup& soup;             // outlives the scene
    const Soup* packed = nullptr; // the same triangles where pages have them; null: in `soup`
    Numbering numbers;            // by which pages name triangles
    Dropped dropped;
    Duplicates duplicates;
    uint64_t triangles = 0; // in leaves, each counted once
    LeafLimits limits{};    // which the leaves keep to
    Level1 level1;          // without duplicates, and without meshes that are shared
    std::vector<SharedMesh> shared;
    std::vector<uint32_t> mesh_of_chunk; // into `shared`, or kNone; empty where nothing is shared
    std::vector<uint32_t> once;          // the chunks that level 1 is cut from, as in Placed
    std::vector<Placed::Copies> copies;
    /// pages[i] belongs to level1.leaves[i]. The pages of shared meshes follow, borrowed from them:
    /// first of those that are home.
    std::vector<Page> pages;
    /// The frame and grid for pages of shared meshes that are home; those of level 1's leaves where
    /// these share one.
    std::optional<Leaf> home;
    FarTriangles far;           // which rays meet first; the tree does not lead to their pages
    TopLevel top;               // over the other pages
    LeafStore* store = nullptr; // where the pages lie; null: in memory
    bool from_saved = false;
    bool any_limits = false;  // LevelsKey::any_limits
    double built_overlap = 0; // of the level's own pages before the first update; 0: none yet
    bool was_updated = false;
    /// The leaf of triangles that came into an update, or left their page in one; kNone: none yet.
    uint32_t late_leaf = kNone;
    double seconds_level1 = 0;
    double seconds_level2 = 0;

    /// Returns the smallest of the triangles behind `after`, in the order of ids, that lie exactly
    /// where `id` does, where `id` stands for them all; `id` itself where there is none.
    TriangleId next_duplicate(TriangleId id, TriangleId after) const;
    bool stands_for_others(TriangleId id) const { return next_duplicate(id, id) != id; }

    const Soup& packed_soup() const { return packed ? *packed : soup; }

    /// Returns the triangle that a ray which does not see `skip` meets in the place of `id`.
    TriangleId seen(TriangleId id, TriangleId skip) const {
        return id == skip ? next_duplicate(id, id) : id;
    }
    /// The same for the triangle that pages know by `number`.
    TriangleId seen(uint32_t number, TriangleId skip) const {
        return seen(numbers.id(number), skip);
    }
    /// The same for a hit.
    Hit seen(const Hit& hit, TriangleId skip) const {
        return as_hit_of(seen(hit.id, skip), soup, hit);
    }

    /// Returns the number of the triangle that the kernel passes over for a ray that does not see
    /// `id`; OVC_NO_TRIANGLE where `id` stands for others, which the ray does see, and where there
    /// is no such triangle.
    uint32_t number_to_skip(TriangleId id) const {
        return !soup.has(id) || stands_for_others(id) ? OVC_NO_TRIANGLE : numbers.of(id);
    }
    /// Returns the same for a ray with these exclusions, of which the kernel is told one.
    uint32_t number_to_skip(const Ray& ray, const Exclusion& without) const;

    /// Adds these shared meshes, of which nothing is built yet.
    SharedMesh& share(const Placed::Shared& meshes);
    /// Returns the shared meshes of which the chunk is an instance; null where there are none.
    const SharedMesh* shared_mesh_of(uint32_t chunk) const;
    /// Returns the page around a point of the triangle, one that holds the triangle where there is
    /// such a page; kNone where the point lies in no page.
    uint32_t page_at(const dvec3& point, TriangleId id) const;

    /// Returns an empty Nearest for the ray.
    Nearest nearest_of(const PreparedRay& p) const {
        if (!soup.has(p.after.id))
            return Nearest(p);
        const Triangle after = soup.triangle(p.after.id);
        return Nearest(p, &after);
    }
    /// Offers a triangle that stands for others as that one of them which the ray sees; see
    /// Nearest::offer().
    bool offer(Nearest& nearest, const PreparedRay& p, TriangleId id) const {
        const TriangleId first = seen(id, p.skip);
        if (nearest.offer(soup.triangle(first), first))
            return true;
        return !p.after.is_before_all() && offer_behind(nearest, p, id);
    }

    /// Whether the top-level tree is likely to change: there were updates, or meshes move.
    bool expects_updates() const;
    uint64_t level2_bytes() const { return total_bytes(pages); }
    uint64_t largest_page_bytes() const { return largest_bytes(pages); }
    /// Returns the number of triangles in the soup, of which those of a shared mesh and of chunks
    /// in the same place count once.
    uint64_t unique_triangles() const;
    /// Returns the number of triangles in leaves, counted once in each leaf.
    uint64_t reference_count() const;
    /// Returns the number of triangles that lie exactly where one of a smaller id does.
    uint64_t duplicate_count() const;
    /// Returns the host memory of level 1, level 2 and the top-level tree.
    uint64_t host_bytes() const;

private:
    /// Returns number_to_skip() of the triangle that the place names where the place is its hit.
    uint32_t number_at_place(const Ray& ray, const HitPlace& place) const;
    /// Offers the next triangle behind p.after, in the order of ids, of those that `id` stands for:
    /// the ray meets those before it in the same point, which does not count for them.
    bool offer_behind(Nearest& nearest, const PreparedRay& p, TriangleId id) const;
    /// Returns the first triangle behind `after`, in the order of ids, of those in copies of the
    /// chunk of `built` that lie exactly where that one does.
    std::optional<TriangleId> first_copy_behind(TriangleId built, TriangleId after) const;
};

/// A mesh, or several that lie together, in several places, or one that moves; cut and packed by
/// itself.
struct SharedMesh {
    std::unique_ptr<const Soup> soup; // a chunk for each mesh, not placed
    BuiltScene scene;                 // of that soup; pages number its triangles
    std::vector<uint32_t> places;     // the first chunk of each in the whole scene, sorted
    uint32_t first_page = 0;          // in the pages of the whole scene
    /// There are triangles on a line, which may get an area where an instance is placed. Those are
    /// cut with the triangles that are placed once.
    bool has_lines = false;
    Box box; // of its triangles, not placed
    /// The mesh, which is one, as it was placed when it came to rest: its pages lie there, in the
    /// frame of the scene, and have the scene's numbers. Null where it never did.
    std::unique_ptr<const Soup> rest;
    /// It still lies there, so its pages hang in the scene's own tree.
    bool is_home = false;
    uint32_t commits_in_place = 0; // since it was placed last
    bool is_doubtful = false;      // the frame of the scene does not suit it where it is

    size_t instances() const { return places.size() * soup->chunks.size(); }
    /// Returns the first chunk of the place in which a chunk of the whole scene lies.
    uint32_t place_of(uint32_t chunk) const;
    /// Returns the triangle of the whole scene in the soup here.
    TriangleId local(TriangleId id) const { return {id.mesh - place_of(id.mesh), id.prim}; }

    /// Whether it lies in one place, where it came to rest. all: the whole scene.
    bool lies_at_rest(const BuiltScene& all) const;
    /// Whether its pages lie in the scene's home.
    bool has_frame_of(const BuiltScene& all) const;
    const Transform& rest_place() const { return or_identity(rest->chunks.front().transform()); }
    /// Takes its pages for those of a mesh that came to rest there, whose first triangle has that
    /// number in the scene.
    void put_to_rest(const Transform& place, uint32_t first_number);
};

/// The triangles that leaves are made of: those that can be hit, without duplicates.
struct Hittable {
    std::vector<TriangleId> triangles; // sorted
    Box bounds;
};

/// Finds the hittable triangles of the scene's soup, and enters in the scene which are left out. A
/// triangle is two units of progress.
Hittable take_hittable(BuiltScene& scene, BuildProgress* progress = nullptr);

/// The hittable triangles of a scene, where each shared mesh is taken by itself.
struct HittableParts {
    Hittable once;                // its bounds are those of the whole scene
    std::vector<Hittable> shared; // one for each of scene.shared, which has their soups
};
/// As take_hittable(), for a scene that places its chunks as placed_chunks() tells. A triangle of a
/// shared mesh is two units of progress once.
HittableParts take_hittable_parts(BuiltScene& scene, Placed placed,
                                  BuildProgress* progress = nullptr);

/// Finds out whether the mesh, whose triangles are taken, has_lines among some of them.
void look_for_lines(SharedMesh& mesh, const PrimRange& among);
/// The same among all.
void look_for_lines(SharedMesh& mesh);

/// Finds the home of a scene whose levels are there: the frame that level 1's leaves share, or that
/// of meshes at rest if there are no such leaves.
void find_home(BuiltScene& scene);

/// Finds out which shared meshes are home, and appends their pages and those of the others to those
/// of the scene, all of which are built.
void gather_pages(BuiltScene& scene);

/// Returns the tree over all pages, with portals to shared meshes, after gather_pages(). max_links:
/// as in build_top_level().
TopLevel top_level_of(const BuiltScene& scene, size_t max_links);

} // namespace ovc
