// SPDX-License-Identifier: Apache-2.0
// BuiltScene: finds the triangles of a soup that are packed, and the places where they lie.
#include "plugin/build/built_scene.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

namespace ovc {

BuiltScene::BuiltScene(const Soup& soup_) : soup(soup_), numbers(soup_) {}
BuiltScene::~BuiltScene() = default;
BuiltScene::BuiltScene(BuiltScene&&) = default;

SharedMesh& BuiltScene::share(const Placed::Shared& meshes) {
    assert(!meshes.places.empty());
    mesh_of_chunk.resize(soup.chunks.size(), kNone);
    meshes.for_each_chunk([&](uint32_t chunk) { mesh_of_chunk[chunk] = uint32_t(shared.size()); });
    auto local = std::make_unique<Soup>();
    for (uint32_t i = 0; i < meshes.chunks; ++i)
        local->chunks.push_back(soup.chunks[meshes.places.front() + i].unplaced());
    BuiltScene cut(*local);
    cut.once.resize(meshes.chunks);
    std::iota(cut.once.begin(), cut.once.end(), 0u);
    shared.push_back({.soup = std::move(local),
                      .scene = std::move(cut),
                      .places = meshes.places,
                      .box = meshes.box});
    return shared.back();
}

uint32_t SharedMesh::place_of(uint32_t chunk) const {
    if (soup->chunks.size() == 1)
        return chunk;
    return *std::prev(std::ranges::upper_bound(places, chunk));
}

bool SharedMesh::lies_at_rest(const BuiltScene& all) const {
    if (!rest || places.size() != 1)
        return false;
    const uint32_t chunk = places.front();
    return rest_place().rows == or_identity(all.soup.chunks[chunk].transform()).rows &&
           scene.numbers.first() == all.numbers.of({chunk, 0});
}

bool SharedMesh::has_frame_of(const BuiltScene& all) const {
    if (!all.home || scene.level1.leaves.empty())
        return false;
    const Leaf& leaf = scene.level1.leaves.front();
    return leaf.frame == all.home->frame && leaf.grid.lo == all.home->grid.lo &&
           leaf.grid.hi == all.home->grid.hi;
}

void SharedMesh::put_to_rest(const Transform& place, uint32_t first_number) {
    assert(soup->chunks.size() == 1);
    auto placed = std::make_unique<Soup>();
    placed->chunks.push_back(soup->chunks.front().instance());
    placed->chunks.front().place_anew(place);
    rest = std::move(placed);
    scene.packed = rest.get();
    scene.numbers = Numbering(*soup, first_number);
}

const SharedMesh* BuiltScene::shared_mesh_of(uint32_t chunk) const {
    const uint32_t mesh = mesh_of_chunk.empty() ? kNone : mesh_of_chunk[chunk];
    return mesh == kNone ? nullptr : &shared[mesh];
}

TriangleId BuiltScene::next_duplicate(TriangleId id, TriangleId after) const {
    const SharedMesh* mesh = shared_mesh_of(id.mesh);
    auto others = mesh ? mesh->scene.duplicates.of(mesh->local(id)) : duplicates.of(id);
    if (mesh && mesh->has_lines && others.empty()) { // the triangle may be one that was on a line
        mesh = nullptr;
        others = duplicates.of(id);
    }
    const uint32_t place = mesh ? mesh->place_of(id.mesh) : 0;
    const auto of_pair = [&](const Duplicates::Pair& pair) {
        return TriangleId{place + pair.other.mesh, pair.other.prim};
    };
    // The first behind `after` of those that are built; those before it may have copies there.
    const auto next = std::ranges::upper_bound(others, after, {}, of_pair);
    TriangleId found = next == others.end() ? id : of_pair(*next);
    const auto offer_copy = [&](TriangleId built) {
        const auto copy = first_copy_behind(built, after);
        if (copy && (found == id || *copy < found))
            found = *copy;
    };
    if (!copies.empty()) {
        offer_copy(id);
        for (auto other = others.begin(); other != next; ++other)
            offer_copy(of_pair(*other));
    }
    return found;
}

std::optional<TriangleId> BuiltScene::first_copy_behind(TriangleId built, TriangleId after) const {
    const auto place = std::ranges::lower_bound(copies, built.mesh, {},
                                                [](const auto& chunks) { return chunks.front(); });
    if (place == copies.end() || place->front() != built.mesh)
        return std::nullopt;
    const auto chunk = std::ranges::upper_bound(*place, after, {}, [&](uint32_t copy) {
        return TriangleId{copy, built.prim};
    });
    return chunk == place->end() ? std::nullopt : std::optional(TriangleId{*chunk, built.prim});
}

/// Returns whether doubles tell that the ray does not hit the triangle from the place on.
static bool is_passed(const Ray& ray, const Soup& soup, TriangleId id, const HitPlace& place) {
    const double all = std::numeric_limits<double>::max();
    const PreparedRay whole(Ray{ray.org, -all, ray.dir, all});
    bool in_doubt = false;
    const auto found =
        candidate(whole, soup.triangle(id), id, [&](auto&&...) -> std::optional<Candidate> {
            in_doubt = true;
            return std::nullopt;
        });
    return !in_doubt && (!found || found->latest_t() < place.t);
}

uint32_t BuiltScene::number_to_skip(const Ray& ray, const Exclusion& without) const {
    const uint32_t start = number_to_skip(without.skip);
    if (without.after.is_before_all())
        return start;
    // A ray that has passed by a hit is far from the triangle that it started on, but the kernel
    // would be in doubt about the one at the place.
    if (start != OVC_NO_TRIANGLE && !is_passed(ray, soup, without.skip, without.after))
        return start;
    const uint32_t at_place = number_at_place(ray, without.after);
    return at_place != OVC_NO_TRIANGLE ? at_place : start;
}

uint32_t BuiltScene::number_at_place(const Ray& ray, const HitPlace& place) const {
    const uint32_t number = number_to_skip(place.id);
    return number != OVC_NO_TRIANGLE &&
                   (place.is_certain || hit_at(ray, soup.triangle(place.id), place))
               ? number
               : OVC_NO_TRIANGLE;
}

bool BuiltScene::expects_updates() const {
    return was_updated || std::ranges::any_of(soup.chunks, &Chunk::moves);
}

bool BuiltScene::offer_behind(Nearest& nearest, const PreparedRay& p, TriangleId id) const {
    TriangleId next = next_duplicate(id, p.after.id);
    if (next == p.skip)
        next = next_duplicate(id, next);
    return next != id && nearest.offer(soup.triangle(next), next);
}

uint32_t BuiltScene::page_at(const dvec3& point, TriangleId id) const {
    const SharedMesh* mesh = shared_mesh_of(id.mesh);
    if (!mesh)
        return leaf_at(level1, point, id);
    const std::vector<Leaf>& leaves = mesh->scene.level1.leaves;
    for (uint32_t i = 0; i < leaves.size(); ++i)
        if (std::ranges::binary_search(leaves[i].list(), mesh->local(id)))
            return mesh->first_page + i;
    return kNone;
}

uint64_t BuiltScene::reference_count() const {
    uint64_t count = level1.reference_count();
    for (const SharedMesh& mesh : shared)
        count += mesh.scene.level1.reference_count();
    return count;
}

uint64_t BuiltScene::unique_triangles() const {
    uint64_t count = soup.triangle_count();
    for (const SharedMesh& mesh : shared)
        count -= (mesh.places.size() - 1) * mesh.soup->triangle_count();
    for (const Placed::Copies& there : copies)
        count -= (there.size() - 1) * soup.chunks[there.front()].size();
    return count;
}

uint64_t BuiltScene::duplicate_count() const {
    uint64_t count = duplicates.count();
    for (const SharedMesh& mesh : shared)
        count += mesh.scene.duplicates.count() * mesh.places.size();
    for (const Placed::Copies& there : copies)
        count += (there.size() - 1) * soup.chunks[there.front()].size();
    return count;
}

uint64_t BuiltScene::host_bytes() const {
    uint64_t bytes = top.tree.bytes() + top.portals.size() * sizeof(Portal) +
                     far.triangles.size() * sizeof(FarTriangle);
    const auto add = [&](const BuiltScene& scene) {
        bytes += scene.level1.reference_count() * sizeof(TriangleId) +
                 scene.level1.leaves.size() * sizeof(Leaf) +
                 scene.level1.nodes.size() * sizeof(KdNode);
    };
    add(*this);
    for (const SharedMesh& mesh : shared)
        add(mesh.scene);
    return bytes + (store ? 0 : level2_bytes());
}

namespace {

/// Returns those of some triangles of a mesh whose three corners differ but lie on a line. Where
/// the mesh is placed, rounding may give them an area.
std::vector<TriangleId> on_a_line(const Soup& soup, const PrimRange& among) {
    return parallel_reduce(
        among.end - among.first, std::vector<TriangleId>(),
        [&](size_t from, size_t to, std::vector<TriangleId> found) {
            for (auto prim = uint32_t(among.first + from); prim < among.first + to; ++prim) {
                const Triangle t = soup.triangle({among.mesh, prim});
                if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0] &&
                    triangle_fault(t) == TriangleFault::Degenerate)
                    found.push_back({among.mesh, prim});
            }
            return found;
        },
        [](std::vector<TriangleId> a, const std::vector<TriangleId>& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        });
}

/// Returns the same of all triangles.
std::vector<TriangleId> on_a_line(const Soup& soup) {
    std::vector<TriangleId> found;
    for (uint32_t mesh = 0; mesh < soup.chunks.size(); ++mesh) {
        const std::vector<TriangleId> more = on_a_line(soup, {mesh, 0, soup.chunks[mesh].size()});
        found.insert(found.end(), more.begin(), more.end());
    }
    return found;
}

/// Takes the triangles of shared meshes, and finds those that must be cut with the others because
/// they have an area only where an instance is placed.
class SharedParts {
public:
    explicit SharedParts(BuiltScene& scene) : scene_(scene) {}

    void take(const Placed& placed, std::vector<Hittable>& hittable, BuildProgress* progress) {
        for (const Placed::Shared& meshes : placed.shared) {
            SharedMesh& mesh = scene_.share(meshes);
            hittable.push_back(take_hittable(mesh.scene, progress));
            mesh.scene.seconds_level1 = 0; // the scene's own count includes it
            look_for_lines(mesh);
            note(mesh, hittable.back().bounds);
        }
    }

    const std::vector<TriangleId>& by_themselves() const { return by_themselves_; }
    const Box& bounds() const { return bounds_; }

private:
    void note(const SharedMesh& mesh, const Box& box) {
        const BuiltScene& local = mesh.scene;
        std::vector<TriangleId> lines;
        if (mesh.has_lines)
            lines = on_a_line(local.soup);
        for (const uint32_t place : mesh.places) {
            scene_.dropped.not_finite += local.dropped.not_finite;
            scene_.dropped.degenerate += local.dropped.degenerate;
            if (!box.empty())
                bounds_.add(placed_box(box, scene_.soup.chunks[place].transform()));
            for (const TriangleId& line : lines) {
                const TriangleId id{place + line.mesh, line.prim};
                const Triangle triangle = scene_.soup.triangle(id);
                if (triangle_fault(triangle) != TriangleFault::None)
                    continue;
                by_themselves_.push_back(id);
                bounds_.add(bounds_of(triangle));
                assert(scene_.dropped.degenerate > 0); // the mesh's count, added above, has it
                scene_.dropped.degenerate -= 1;
            }
        }
    }

    BuiltScene& scene_;
    std::vector<TriangleId> by_themselves_;
    Box bounds_;
};

void take_duplicates_out(BuiltScene& scene, Hittable& hittable, BuildProgress* progress) {
    scene.duplicates = Duplicates::take_out(scene.soup, hittable.triangles, progress);
    scene.triangles = hittable.triangles.size();
}

} // namespace

Hittable take_hittable(BuiltScene& scene, BuildProgress* progress) {
    const Stopwatch watch;
    Hittable hittable;
    hittable.triangles = hittable_triangles(scene.soup, &scene.dropped, &hittable.bounds, progress);
    take_duplicates_out(scene, hittable, progress);
    scene.seconds_level1 = watch.seconds();
    return hittable;
}

HittableParts take_hittable_parts(BuiltScene& scene, Placed placed, BuildProgress* progress) {
    const Stopwatch watch;
    scene.once = std::move(placed.once);
    scene.copies = std::move(placed.copies);
    HittableParts parts;
    parts.once.triangles =
        hittable_triangles(scene.soup, scene.once, &scene.dropped, &parts.once.bounds, progress);
    SharedParts shared(scene);
    shared.take(placed, parts.shared, progress);
    std::vector<TriangleId>& triangles = parts.once.triangles;
    assert(std::ranges::is_sorted(triangles));
    std::vector<TriangleId> more(shared.by_themselves().begin(), shared.by_themselves().end());
    std::ranges::sort(more);
    const auto before = ptrdiff_t(triangles.size());
    triangles.insert(triangles.end(), more.begin(), more.end());
    std::ranges::inplace_merge(triangles, triangles.begin() + before);
    parts.once.bounds.add(shared.bounds());
    take_duplicates_out(scene, parts.once, progress);
    scene.seconds_level1 = watch.seconds();
    return parts;
}

void look_for_lines(SharedMesh& mesh, const PrimRange& among) {
    mesh.has_lines = mesh.scene.dropped.degenerate > 0 && !on_a_line(*mesh.soup, among).empty();
}

void look_for_lines(SharedMesh& mesh) {
    mesh.has_lines = mesh.scene.dropped.degenerate > 0 && !on_a_line(*mesh.soup).empty();
}

namespace {

/// Returns the box around the pages of a level whose leaves share a frame.
Box box_around_pages(const BuiltScene& level) {
    constexpr double kMargin = 0x1p-10; // of the box, as leaves have it
    const Frame& frame = level.level1.leaves.front().frame;
    Box box;
    for (const Page& page : level.pages) {
        const Box local = box_of(page);
        box.add(Box{local.lo / frame.scale + frame.origin, local.hi / frame.scale + frame.origin});
    }
    return box.padded(kMargin * max_component(box.extent()) + box.rounding());
}

/// Adds a mesh that came to rest and has left since.
void add_left(Parts& parts, const BuiltScene& scene, const SharedMesh& mesh) {
    const BuiltScene& level = mesh.scene;
    if (level.pages.empty())
        return;
    PlacedPart part{{mesh.first_page, uint32_t(level.pages.size())},
                    level.level1.leaves.front().frame,
                    box_around_pages(level),
                    {},
                    {}};
    const Transform back = *inverse(mesh.rest_place());
    part.kept.reserve(mesh.places.size()); // the places point to them
    for (const uint32_t place : mesh.places) {
        part.kept.push_back(then(back, or_identity(scene.soup.chunks[place].transform())));
        part.places.push_back(
            {&part.kept.back(), scene.numbers.of({place, 0}) - level.numbers.first()});
    }
    parts.all.push_back(std::move(part));
}

void add_unplaced(Parts& parts, const BuiltScene& scene, const SharedMesh& mesh) {
    std::vector<Place> places;
    for (const uint32_t place : mesh.places)
        places.push_back({scene.soup.chunks[place].transform(), scene.numbers.of({place, 0})});
    parts.add(mesh.scene.level1, mesh.first_page, places);
}

} // namespace

void find_home(BuiltScene& scene) {
    const auto live_in = [&](const Leaf& leaf) {
        scene.home = Leaf{.cell = {}, .box = leaf.box, .frame = leaf.frame, .grid = leaf.grid};
    };
    const Level1& level1 = scene.level1;
    if (!level1.leaves.empty()) {
        scene.home.reset();
        if (level1.shares_frame)
            live_in(level1.leaves.front());
        return;
    }
    for (const SharedMesh& mesh : scene.shared)
        if (!scene.home && mesh.lies_at_rest(scene) && !mesh.scene.level1.leaves.empty())
            live_in(mesh.scene.level1.leaves.front());
}

void gather_pages(BuiltScene& scene) {
    assert(scene.pages.size() == scene.level1.leaves.size());
    for (SharedMesh& mesh : scene.shared)
        mesh.is_home = mesh.lies_at_rest(scene) && mesh.has_frame_of(scene);
    for (const bool home : {true, false})
        for (SharedMesh& mesh : scene.shared) {
            if (mesh.is_home != home)
                continue;
            mesh.first_page = uint32_t(scene.pages.size());
            for (const Page& page : mesh.scene.pages)
                scene.pages.push_back({.texels = {},
                                       .borrowed = page.view(),
                                       .depth = page.depth,
                                       .stored_bytes = page.stored_bytes,
                                       .stored_number = page.stored_number});
        }
}

TopLevel top_level_of(const BuiltScene& scene, size_t max_links) {
    const std::span<const uint32_t> without = scene.far.leaves;
    if (scene.shared.empty())
        return build_top_level(scene.level1, scene.pages, max_links, without);
    Parts parts;
    uint32_t pages = uint32_t(scene.level1.leaves.size()); // in the scene's own tree
    for (const SharedMesh& mesh : scene.shared)
        pages += mesh.is_home ? uint32_t(mesh.scene.pages.size()) : 0;
    if (pages > scene.level1.leaves.size())
        parts.all.push_back({{0, pages}, scene.home->frame, scene.home->grid, {Place()}, {}});
    else
        parts.add(scene.level1, 0, {Place()}, without);
    for (const SharedMesh& mesh : scene.shared) {
        assert(mesh.first_page + mesh.scene.pages.size() <= scene.pages.size());
        if (!mesh.is_home)
            (mesh.rest ? add_left : add_unplaced)(parts, scene, mesh);
    }
    return build_top_level(scene.level1.bounds, parts, scene.pages, max_links);
}

} // namespace ovc
