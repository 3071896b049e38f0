// SPDX-License-Identifier: Apache-2.0
// Saving is writing arrays as they lie; restoring is checking everything that a walk relies on.
#include "plugin/saved_levels.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gpu/page_check.h"
#include "plugin/page_rate.h"
#include "shaders/layout.h"
#include "shaders/sources.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace ovc {
namespace {

constexpr std::string_view kKind = "ovc levels";
/// To be raised when a build makes other leaves or pages of the same soup; a change of layout.h is
/// noticed without.
constexpr uint32_t kVersion = 5;

/// Where all of it is the same, a build makes the same levels.
struct Key {
    uint64_t layout = 0;         // checksum of shaders/layout.h
    uint64_t soup = 0;           // checksum of origins and corners
    uint64_t leaf_triangles = 0; // limits
    uint64_t page_bytes = 0;     // 0 where no page could come near it
    uint64_t whole_bytes = 0;

    bool operator==(const Key&) const = default;
};

struct Summary {
    Key key;
    uint64_t not_finite = 0;
    uint64_t degenerate = 0;
    uint64_t twins = 0;
    uint64_t triangles = 0;
    uint64_t shares_frame = 0;
    uint64_t far_leaves = 0;
    Box bounds;
    double padding = 0;
};
static_assert(sizeof(Summary) == 18 * 8);

struct SavedLeaf {
    Box cell;
    Box box;
    Box grid;
    dvec3 origin{0};
    double scale = 1;
    uint64_t triangles = 0; // so many of the part "lists", behind those of the leaves before
};
static_assert(sizeof(SavedLeaf) == 23 * 8);

struct SavedPage {
    uint64_t texels = 0;
    uint64_t depth = 0;
};

uint64_t checksum_of_layout() {
    for (const ShaderSource& source : shader_sources())
        if (source.name == "layout.h")
            return checksum_of(bytes_of(std::span<const char>(source.text)));
    return 0;
}

uint64_t checksum_of_soup(const Soup& soup) {
    Checksum sum;
    for (const Chunk& chunk : soup.chunks) {
        sum.add(bytes_of(std::span<const dvec3>(&chunk.origin(), 1)));
        sum.add_value(uint64_t(chunk.size()));
        sum.add(bytes_of(chunk.corners()));
        sum.add(bytes_of(chunk.double_corners()));
        if (chunk.placement())
            sum.add(bytes_of(std::span<const Placement>(chunk.placement(), 1)));
    }
    return sum.value();
}

void put_limits(Key& key, const LeafLimits& limits) {
    key.leaf_triangles = limits.triangles;
    key.page_bytes = limits.pages_matter() ? limits.page_bytes : 0;
    key.whole_bytes = limits.whole_bytes;
}

bool is_sound(const Box& box) {
    return is_finite(box.lo) && is_finite(box.hi) && !box.empty();
}

/// Whether a walk from the root ends, stays within the nodes and names leaves there are.
bool is_walkable(std::span<const KdNode> nodes, size_t leaves) {
    constexpr uint32_t kDeepest = 120; // what kdtree/walk.h has a stack for, and some
    std::vector<uint8_t> depth(nodes.size(), 0);
    if (!nodes.empty())
        depth[0] = 1;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const KdNode& node = nodes[i];
        if (depth[i] == 0 || depth[i] > kDeepest)
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

bool are_sound(std::span<const Twins::Pair> pairs, const Soup& soup) {
    const auto exists = [&](TriangleId id) {
        return id.mesh < soup.chunks.size() && id.prim < soup.chunks[id.mesh].size();
    };
    for (size_t i = 0; i < pairs.size(); ++i)
        if (!exists(pairs[i].smallest) || !exists(pairs[i].second) ||
            (i > 0 && !(pairs[i - 1].smallest < pairs[i].smallest)))
            return false;
    return true;
}

/// Each page its part of the texels; false where they do not come out even, or a page is no page.
bool share_out(std::span<const uvec4> texels, std::span<const SavedPage> saved,
               uint64_t triangle_count, std::vector<Page>& pages) {
    pages.resize(saved.size());
    for (size_t i = 0; i < saved.size(); ++i) {
        if (saved[i].texels == 0 || saved[i].texels > texels.size() || saved[i].depth > 0xffffffffu)
            return false;
        pages[i].borrowed = texels.first(saved[i].texels);
        pages[i].depth = uint32_t(saved[i].depth);
        texels = texels.subspan(saved[i].texels);
    }
    std::atomic<bool> walkable{texels.empty()};
    parallel_for(pages.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last && walkable; ++i)
            if (!is_walkable(pages[i], uint32_t(triangle_count)))
                walkable = false;
    });
    return walkable;
}

const Error kUnsound{"is damaged: what it holds are no levels"};

class Restorer {
public:
    Restorer(const Archive& archive, const Soup& soup) : archive_(archive), scene_(soup) {}

    Result<BuiltScene> restore(const Summary& summary) {
        scene_.dropped = {summary.not_finite, summary.degenerate};
        scene_.triangles = summary.triangles;
        scene_.level1.bounds = summary.bounds;
        scene_.level1.padding = summary.padding;
        scene_.level1.shares_frame = summary.shares_frame == 1;
        scene_.level1.far_leaves = uint32_t(std::min<uint64_t>(summary.far_leaves, kNone));
        if (Result<Done> done = read_twins(summary.twins); !done)
            return done.error();
        if (Result<Done> done = read_level1(); !done)
            return done.error();
        if (Result<Done> done = read_pages(); !done)
            return done.error();
        return std::move(scene_);
    }

private:
    Result<Done> read_twins(uint64_t count) {
        const auto pairs = archive_.items<Twins::Pair>("twins");
        if (!pairs)
            return pairs.error();
        if (!are_sound(*pairs, scene_.soup))
            return kUnsound;
        scene_.twins = Twins::restored(*pairs, count);
        return Done{};
    }

    Result<Done> read_level1() {
        const auto nodes = archive_.items<KdNode>("nodes");
        if (!nodes)
            return nodes.error();
        const auto leaves = archive_.items<SavedLeaf>("leaves");
        if (!leaves)
            return leaves.error();
        const auto lists = archive_.items<TriangleId>("lists");
        if (!lists)
            return lists.error();
        Level1& level1 = scene_.level1;
        if (!is_walkable(*nodes, leaves->size()) || nodes->empty() != leaves->empty() ||
            level1.far_leaves > leaves->size() || !(level1.padding >= 0) ||
            (!nodes->empty() && !is_sound(level1.bounds)))
            return kUnsound;
        level1.nodes.assign(nodes->begin(), nodes->end());
        std::span<const TriangleId> rest = *lists;
        for (const SavedLeaf& leaf : *leaves) {
            if (!is_sound(leaf) || leaf.triangles > rest.size() ||
                (level1.shares_frame && !share_frame(leaf, leaves->front())))
                return kUnsound;
            const auto list = rest.first(leaf.triangles);
            rest = rest.subspan(leaf.triangles);
            level1.leaves.push_back({leaf.cell,
                                     leaf.box,
                                     {leaf.origin, leaf.scale},
                                     leaf.grid,
                                     {list.begin(), list.end()}});
        }
        if (!rest.empty())
            return kUnsound;
        return Done{};
    }

    Result<Done> read_pages() {
        const auto pages = archive_.items<SavedPage>("pages", scene_.level1.leaves.size());
        if (!pages)
            return pages.error();
        const auto texels = archive_.items<uvec4>("texels");
        if (!texels)
            return texels.error();
        if (!share_out(*texels, *pages, scene_.soup.triangle_count(), scene_.pages))
            return kUnsound;
        return Done{};
    }

    const Archive& archive_;
    BuiltScene scene_;
};

} // namespace

bool save_levels(const BuiltScene& scene, const ByteSink& sink) {
    Summary summary;
    summary.key.layout = checksum_of_layout();
    summary.key.soup = checksum_of_soup(scene.soup);
    put_limits(summary.key, scene.limits);
    summary.not_finite = scene.dropped.not_finite;
    summary.degenerate = scene.dropped.degenerate;
    summary.twins = scene.twins.count();
    summary.triangles = scene.triangles;
    summary.shares_frame = scene.level1.shares_frame;
    summary.far_leaves = scene.level1.far_leaves;
    summary.bounds = scene.level1.bounds;
    summary.padding = scene.level1.padding;
    std::vector<SavedLeaf> leaves;
    for (const Leaf& leaf : scene.level1.leaves)
        leaves.push_back({leaf.cell, leaf.box, leaf.grid, leaf.frame.origin, leaf.frame.scale,
                          leaf.triangles.size()});
    std::vector<SavedPage> pages;
    for (const Page& page : scene.pages)
        pages.push_back({page.view().size(), page.depth});

    ArchiveWriter writer(sink, kKind, kVersion);
    writer.part<Summary>("summary", std::span(&summary, 1));
    writer.part<Twins::Pair>("twins", scene.twins.pairs());
    writer.part<KdNode>("nodes", scene.level1.nodes);
    writer.part<SavedLeaf>("leaves", leaves);
    writer.begin("lists");
    for (const Leaf& leaf : scene.level1.leaves)
        writer.write(bytes_of(std::span<const TriangleId>(leaf.triangles)));
    writer.part<SavedPage>("pages", pages);
    writer.begin("texels");
    for (const Page& page : scene.pages)
        writer.write(bytes_of(page.view()));
    return writer.finish();
}

Result<std::optional<BuiltScene>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t)>& limits_for) {
    const Stopwatch watch;
    if (reinterpret_cast<uintptr_t>(saved.data()) % kPartAlignment)
        return Error{"is not aligned to 64 bytes"};
    const Result<Archive> archive = Archive::open(saved, kKind, kVersion);
    if (!archive)
        return archive.error();
    const auto summaries = archive->items<Summary>("summary", 1);
    if (!summaries)
        return summaries.error();
    const Summary& summary = summaries->front();
    Key key;
    key.layout = checksum_of_layout();
    const LeafLimits limits = limits_for(summary.triangles);
    put_limits(key, limits);
    key.soup = summary.key.soup; // the rest first: this takes a while
    if (key != summary.key || checksum_of_soup(soup) != key.soup)
        return std::optional<BuiltScene>();
    Result<BuiltScene> scene = Restorer(*archive, soup).restore(summary);
    if (!scene)
        return scene.error();
    scene->limits = limits;
    scene->from_saved = true;
    scene->seconds_level1 = watch.seconds();
    return std::optional(std::move(*scene));
}

} // namespace ovc
