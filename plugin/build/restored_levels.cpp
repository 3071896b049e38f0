// SPDX-License-Identifier: Apache-2.0
// Restoring is checking everything that a walk relies on.
#include "plugin/build/restored_levels.h"

#include "core/file/archive.h"
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "gpu/bvh/bvh.h"
#include "gpu/page/page_check.h"
#include "plugin/build/levels_format.h"
#include "plugin/build/stored_page_check.h"
#include "plugin/leaf_store/corner_sums.h"
#include "shaders/layout.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

namespace ovc {
namespace {

bool is_sound(const Box& box) {
    return is_finite(box.lo) && is_finite(box.hi) && !box.empty();
}

/// Whether a walk from the root ends, stays within the nodes and names leaves that exist.
bool is_walkable(std::span<const KdNode> nodes, size_t leaves) {
    constexpr uint32_t kMaxWalkDepth = 120; // what kdtree/walk.h has a stack for, and some
    std::vector<uint8_t> depth(nodes.size(), 0);
    if (!nodes.empty())
        depth[0] = 1;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const KdNode& node = nodes[i];
        if (depth[i] == 0 || depth[i] > kMaxWalkDepth)
            return false;
        if (node.is_leaf()) {
            if (uint64_t(node.first()) + node.count() > leaves)
                return false;
            continue;
        }
        // Both children lie behind their parent, and have no other.
        for (const size_t child : {i + 1, size_t(node.above())}) {
            if (child <= i || child >= nodes.size() || depth[child] || !std::isfinite(node.split()))
                return false;
            depth[child] = uint8_t(depth[i] + 1);
        }
    }
    return true;
}

bool is_sound(const SavedLeaf& leaf) {
    return is_sound(leaf.cell) && is_sound(leaf.box) && is_sound(leaf.grid) &&
           is_finite(leaf.origin) && std::isfinite(leaf.scale) && leaf.scale > 0;
}

bool share_frame(const SavedLeaf& a, const SavedLeaf& b) {
    return a.origin == b.origin && a.scale == b.scale && a.grid.lo == b.grid.lo &&
           a.grid.hi == b.grid.hi;
}

/// Takes the first `count` items off `left` and returns them; nothing where there are fewer.
template <class T>
std::optional<std::span<const T>> take(std::span<const T>& left, uint64_t count) {
    if (count > left.size())
        return std::nullopt;
    const auto taken = left.first(count);
    left = left.subspan(count);
    return taken;
}

bool are_sound(std::span<const Duplicates::Pair> pairs, const Soup& soup) {
    const auto exists = [&](TriangleId id) {
        return id.mesh < soup.chunks.size() && id.prim < soup.chunks[id.mesh].size();
    };
    for (size_t i = 0; i < pairs.size(); ++i)
        if (!exists(pairs[i].smallest) || !exists(pairs[i].other) ||
            !(pairs[i].smallest < pairs[i].other) || (i > 0 && !(pairs[i - 1] < pairs[i])))
            return false;
    return true;
}

const Error kUnsound{"is damaged: what it holds are no levels"};

/// The part of the arrays that is not read yet. The cuts lie one behind the other in them. Of
/// levels on a disk there are heads of pages in place of lists and texels.
struct Arrays {
    std::span<const Duplicates::Pair> duplicates;
    std::span<const KdNode> nodes;
    std::span<const SavedLeaf> leaves;
    std::span<const TriangleId> lists;
    std::span<const SavedPage> pages; // one a leaf
    std::span<const uvec4> texels;
    std::span<const uvec4> heads;
    uint64_t stored_texels = 0; // whose heads these are
    uint32_t stored_pages = 0;  // that were read
    bool are_stored = false;

    bool all_read() const {
        return duplicates.empty() && nodes.empty() && leaves.empty() && lists.empty() &&
               pages.empty() && texels.empty() && heads.empty() && stored_texels == 0;
    }
};

/// Reads a cut from the beginning of the arrays. read() returns false where they are damaged.
class CutReader {
public:
    CutReader(const SavedCut& cut, Arrays& arrays, BuiltScene& scene)
        : cut_(cut), arrays_(arrays), scene_(scene) {}

    bool read() {
        scene_.dropped = {cut_.not_finite, cut_.degenerate};
        scene_.triangles = cut_.triangles;
        return read_duplicates() && read_level1() && read_pages();
    }

private:
    bool read_duplicates() {
        const auto pairs = take(arrays_.duplicates, cut_.duplicates);
        if (!pairs || !are_sound(*pairs, scene_.soup))
            return false;
        scene_.duplicates = Duplicates::restored(*pairs);
        return true;
    }

    bool read_level1() {
        const auto nodes = take(arrays_.nodes, cut_.nodes);
        const auto leaves = take(arrays_.leaves, cut_.leaves);
        if (!nodes || !leaves)
            return false;
        Level1& level1 = scene_.level1;
        level1.bounds = cut_.bounds;
        level1.padding = cut_.padding;
        level1.shares_frame = cut_.shares_frame == 1;
        level1.far_leaves = uint32_t(std::min<uint64_t>(cut_.far_leaves, kNone));
        if (!is_walkable(*nodes, leaves->size()) || nodes->empty() != leaves->empty() ||
            level1.far_leaves > leaves->size() || !(level1.padding >= 0) ||
            (!nodes->empty() && !is_sound(level1.bounds)))
            return false;
        level1.nodes.assign(nodes->begin(), nodes->end());
        for (const SavedLeaf& leaf : *leaves) {
            const uint64_t stored = arrays_.are_stored ? leaf.triangles : 0;
            const auto list = take(arrays_.lists, leaf.triangles - stored);
            if (!is_sound(leaf) || !list ||
                (level1.shares_frame && !share_frame(leaf, leaves->front())))
                return false;
            level1.leaves.push_back({.cell = leaf.cell,
                                     .box = leaf.box,
                                     .frame = {leaf.origin, leaf.scale},
                                     .grid = leaf.grid,
                                     .borrowed = *list,
                                     .stored = stored});
        }
        return true;
    }

    /// Gives each page its part of the texels, without a copy.
    bool read_pages() {
        const auto pages = take(arrays_.pages, cut_.leaves);
        if (!pages)
            return false;
        if (arrays_.are_stored)
            return std::ranges::all_of(*pages, [&](const auto& page) { return read_head(page); });
        for (const SavedPage& saved : *pages) {
            const auto texels = take(arrays_.texels, saved.texels);
            if (!texels || texels->empty() || saved.depth > kNone)
                return false;
            scene_.pages.push_back(
                {.texels = {}, .borrowed = *texels, .depth = uint32_t(saved.depth)});
        }
        const auto triangle_count = uint32_t(scene_.soup.triangle_count());
        const uint32_t first_number = scene_.numbers.first();
        std::atomic<bool> walkable{true};
        parallel_for(scene_.pages.size(), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last && walkable; ++i)
                if (!is_walkable(scene_.pages[i], triangle_count, first_number))
                    walkable = false;
        });
        return walkable;
    }

    bool read_head(const SavedPage& saved) {
        const auto head = take(arrays_.heads, kHeadTexels);
        if (!head || saved.texels % OVC_UNIT_TEXELS || saved.texels > arrays_.stored_texels ||
            saved.depth > kMaxBvhDepth || !is_sound_head(*head, saved.texels / OVC_UNIT_TEXELS))
            return false;
        arrays_.stored_texels -= saved.texels;
        scene_.pages.push_back({.borrowed = *head,
                                .depth = uint32_t(saved.depth),
                                .stored_bytes = saved.texels * sizeof(uvec4),
                                .stored_number = arrays_.stored_pages++});
        return true;
    }

    const SavedCut& cut_;
    Arrays& arrays_;
    BuiltScene& scene_;
};

Result<Arrays> arrays_of(const Archive& archive) {
    const auto duplicates = archive.items<Duplicates::Pair>("twins");
    if (!duplicates)
        return duplicates.error();
    const auto nodes = archive.items<KdNode>("nodes");
    if (!nodes)
        return nodes.error();
    const auto leaves = archive.items<SavedLeaf>("leaves");
    if (!leaves)
        return leaves.error();
    const auto lists = archive.items<TriangleId>("lists");
    if (!lists)
        return lists.error();
    const auto pages = archive.items<SavedPage>("pages", leaves->size());
    if (!pages)
        return pages.error();
    const auto texels = archive.items<uvec4>("texels");
    if (!texels)
        return texels.error();
    return Arrays{*duplicates, *nodes, *leaves, *lists, *pages, *texels, {}};
}

/// Whether rays can come to a mesh that was saved at rest.
bool can_rest(const SharedMesh& mesh, const Soup& soup) {
    const auto& leaves = mesh.scene.level1.leaves;
    if (!mesh.rest || leaves.empty())
        return true;
    return mesh.scene.level1.shares_frame && std::ranges::all_of(mesh.places, [&](uint32_t chunk) {
               return is_well_moved(mesh.rest_place(), or_identity(soup.chunks[chunk].transform()),
                                    leaves.front().grid);
           });
}

Result<BuiltScene> restored(Arrays arrays, std::span<const SavedCut> cuts, const Soup& soup) {
    BuiltScene scene(soup);
    if (cuts.empty() || !CutReader(cuts.front(), arrays, scene).read())
        return kUnsound;
    Placed placed = placed_chunks(soup); // the soup alone tells which meshes are shared
    scene.once = std::move(placed.once);
    scene.copies = std::move(placed.copies);
    if (cuts.size() != 1 + placed.shared.size())
        return kUnsound;
    for (size_t i = 0; i < placed.shared.size(); ++i) {
        SharedMesh& mesh = scene.share(placed.shared[i]);
        const SavedCut& cut = cuts[i + 1];
        if (cut.rests && placed.shared[i].chunks > 1)
            return kUnsound;
        if (cut.rests)
            mesh.put_to_rest(cut.rest_place, scene.numbers.of({mesh.places.front(), 0}));
        if (!CutReader(cut, arrays, mesh.scene).read() || !can_rest(mesh, soup))
            return kUnsound;
        look_for_lines(mesh);
    }
    find_home(scene);
    if (!arrays.all_read())
        return kUnsound;
    gather_pages(scene);
    return scene;
}

} // namespace

Result<std::optional<BuiltScene>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t, uint64_t)>& limits_for,
               bool takes_any_limits) {
    const Stopwatch watch;
    if (reinterpret_cast<uintptr_t>(saved.data()) % kPartAlignment)
        return Error{"is not aligned to 64 bytes"};
    const Result<Archive> archive = Archive::open(saved, kLevelsKind, kLevelsVersion);
    if (!archive)
        return archive.error();
    const auto keys = archive->items<SavedKey>("key", 1);
    if (!keys)
        return keys.error();
    const auto cuts = archive->items<SavedCut>("cuts");
    if (!cuts)
        return cuts.error();
    if (cuts->empty())
        return kUnsound;
    uint64_t unique = 0;
    for (const SavedCut& cut : *cuts)
        unique += cut.triangles;
    const LeafLimits limits = limits_for(cuts->front().triangles, unique);
    SavedKey key = keys->front();
    key.layout = checksum_of_layout();
    if (!takes_any_limits || key.any_limits != 1)
        put_limits(key, limits);
    // The soup is compared last, because its checksum takes a while.
    if (key != keys->front() || corner_sums_of(soup).checksum() != key.soup)
        return std::optional<BuiltScene>();
    const Result<Arrays> arrays = arrays_of(*archive);
    if (!arrays)
        return arrays.error();
    Result<BuiltScene> scene = restored(*arrays, *cuts, soup);
    if (!scene)
        return scene.error();
    scene->limits = limits;
    scene->from_saved = true;
    scene->any_limits = key.any_limits == 1;
    scene->seconds_level1 = watch.seconds();
    return std::optional(std::move(*scene));
}

namespace {

/// The tables of levels on a disk.
struct StoredTables {
    std::vector<SavedCut> cuts;
    std::vector<Duplicates::Pair> duplicates;
    std::vector<KdNode> nodes;
    std::vector<SavedLeaf> leaves;
    std::vector<SavedPage> pages;
    std::vector<uvec4> heads;
    std::vector<uint64_t> sums;

    /// Returns about how many bytes a scene with these keeps in memory: a leaf has its page, its
    /// place in the pool and its part of the top-level tree.
    uint64_t bytes() const {
        constexpr uint64_t kBytesALeaf = 1024;
        return leaves.size() * kBytesALeaf + nodes.size() * sizeof(KdNode) +
               duplicates.size() * sizeof(Duplicates::Pair);
    }
};

Result<StoredTables> read_tables(const StoredArchive& archive) {
    StoredTables tables;
    Result<Done> done = Done{};
    const auto read = [&]<class T>(std::string_view name, std::vector<T>& to, uint64_t count) {
        if (!done)
            return;
        Result<std::vector<T>> items = archive.items<T>(name, count);
        if (items)
            to = std::move(*items);
        else
            done = items.error();
    };
    constexpr uint64_t kAny = ~uint64_t(0);
    read("cuts", tables.cuts, kAny);
    read("twins", tables.duplicates, kAny);
    read("nodes", tables.nodes, kAny);
    read("leaves", tables.leaves, kAny);
    read("pages", tables.pages, tables.leaves.size());
    read("heads", tables.heads, tables.leaves.size() * kHeadTexels);
    read("corner sums", tables.sums, kAny);
    return done ? Result<StoredTables>(std::move(tables)) : done.error();
}

/// Checks that the levels were made of such meshes, by such a library. sums: receives those of the
/// meshes' corners, none of which is read.
Result<Done> check_key(const StoredArchive& archive, const StoredTables& tables, const Soup& soup,
                       CornerSums& sums) {
    const auto keys = archive.items<SavedKey>("key", 1);
    if (!keys)
        return keys.error();
    if (keys->front().layout != checksum_of_layout())
        return Error{"is of another version of the library"};
    sums = unsummed(soup);
    if (sums.sums.size() != tables.sums.size())
        return Error{"is of other meshes"};
    sums.sums = tables.sums;
    if (sums.checksum() != keys->front().soup)
        return Error{"is of other meshes"};
    return Done{};
}

/// Returns what a scene on a disk takes for its meshes and instances, wherever their corners lie:
/// the numbers that the caller gave, and the tree over them. A few count for nothing.
uint64_t bytes_of_meshes(const Soup& soup) {
    constexpr uint64_t kBytesOfMesh = 720, kBytesOfInstance = 1300; // measured, a million of each
    constexpr size_t kFew = 256;
    uint64_t bytes = 0;
    for (const Chunk& chunk : std::span(soup.chunks).subspan(std::min(soup.chunks.size(), kFew)))
        bytes += chunk.transform() ? kBytesOfInstance : kBytesOfMesh;
    return bytes;
}

/// opens: else the store only learns what it would keep.
Result<BuiltScene> open_levels(LeafStore& store, const Soup& soup, bool opens) {
    const Stopwatch watch;
    const Result<StoredArchive> archive =
        StoredArchive::open(store.read(), store.saved_bytes(), kLevelsKind, kLevelsVersion);
    if (!archive)
        return archive.error();
    Result<StoredTables> tables = read_tables(*archive);
    if (!tables)
        return tables.error();
    CornerSums sums;
    if (const Result<Done> fits = check_key(*archive, *tables, soup, sums); !fits)
        return fits.error();
    const ArchivePart texels = archive->place("texels");
    std::vector<PagePlace> places;
    uint64_t offset = texels.offset;
    for (const SavedPage& page : tables->pages) {
        const uint64_t bytes = std::min(page.texels, texels.bytes) * sizeof(uvec4);
        places.push_back({offset, bytes, page.checksum});
        offset += bytes;
    }
    const uint64_t bytes = tables->bytes() + bytes_of_meshes(soup);
    const std::span<const uvec4> heads = store.keep_heads(std::move(tables->heads));
    store.set_sums(sums);
    Arrays arrays{tables->duplicates, tables->nodes, tables->leaves, {}, tables->pages, {}, heads};
    arrays.stored_texels = texels.bytes / sizeof(uvec4);
    arrays.are_stored = true;
    Result<BuiltScene> scene = restored(arrays, tables->cuts, soup);
    if (!scene)
        return scene.error();
    store.set_pages(std::move(places), bytes);
    if (opens)
        if (const auto opened = store.open(StoredPageCheck(*scene, scene->pages)); !opened)
            return opened.error();
    scene->store = &store;
    scene->from_saved = true;
    scene->seconds_level1 = watch.seconds();
    return scene;
}

Result<BuiltScene> read_levels(LeafStore& store, const Soup& soup, bool opens) {
    std::mutex mutex;
    std::optional<Error> failed; // corners of instances are looked at
    store.on_failure([&](Error error) {
        const std::lock_guard lock(mutex);
        if (!failed)
            failed = std::move(error);
    });
    Result<BuiltScene> scene = open_levels(store, soup, opens);
    store.on_failure({});
    return failed ? std::move(*failed) : std::move(scene);
}

} // namespace

Result<BuiltScene> open_stored_levels(LeafStore& store, const Soup& soup) {
    return read_levels(store, soup, /* opens= */ true);
}

Result<BuiltScene> look_at_stored_levels(LeafStore& store, const Soup& soup) {
    return read_levels(store, soup, /* opens= */ false);
}

} // namespace ovc
