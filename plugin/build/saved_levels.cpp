// SPDX-License-Identifier: Apache-2.0
// Saving is writing arrays as they lie.
#include "plugin/build/saved_levels.h"

#include "core/file/checksum.h"
#include "shaders/sources.h"

#include <cassert>

namespace ovc {

uint64_t checksum_of_layout() {
    for (const ShaderSource& source : shader_sources())
        if (source.name == "layout.h")
            return checksum_of(bytes_of(std::span<const char>(source.text)));
    return 0;
}

void put_limits(SavedKey& key, const LeafLimits& limits) {
    key.leaf_triangles = limits.triangles;
    key.page_bytes = limits.pages_matter() ? limits.page_bytes : 0;
    key.whole_bytes = limits.whole_bytes;
}

namespace {

/// Returns the scene and the scenes of its shared meshes, in the order in which they are saved.
std::vector<const BuiltScene*> cuts_of(const BuiltScene& scene) {
    std::vector<const BuiltScene*> cuts{&scene};
    for (const SharedMesh& mesh : scene.shared)
        cuts.push_back(&mesh.scene);
    return cuts;
}

LevelsCut levels_cut(const BuiltScene& scene) {
    LevelsCut cut{scene.dropped, scene.duplicates.pairs(), scene.level1, scene.level1.leaves.size(),
                  scene.triangles};
    if (scene.packed)
        cut.rest_place = or_identity(scene.packed->chunks.front().transform());
    return cut;
}

SavedCut saved_cut(const LevelsCut& of) {
    SavedCut cut;
    if (of.rest_place) {
        cut.rests = 1;
        cut.rest_place = *of.rest_place;
    }
    cut.not_finite = of.dropped.not_finite;
    cut.degenerate = of.dropped.degenerate;
    cut.duplicates = of.duplicates.size() + of.more_duplicates;
    cut.nodes = of.level1.nodes.size();
    cut.leaves = of.leaves;
    cut.triangles = of.triangles;
    cut.shares_frame = of.level1.shares_frame;
    cut.far_leaves = of.level1.far_leaves;
    cut.bounds = of.level1.bounds;
    cut.padding = of.level1.padding;
    return cut;
}

SavedKey key_of(const LevelsKey& of) {
    SavedKey key;
    key.layout = checksum_of_layout();
    key.soup = of.soup.checksum();
    if (of.any_limits)
        key.any_limits = 1;
    else
        put_limits(key, of.limits);
    return key;
}

} // namespace

LevelsWriter::LevelsWriter(const ByteSink& sink) : writer_(sink, kLevelsKind, kLevelsVersion) {
    writer_.begin("texels");
}

SavedLeaf saved_leaf(const Leaf& leaf) {
    return {leaf.cell,         leaf.box,         leaf.grid,
            leaf.frame.origin, leaf.frame.scale, leaf.list().size()};
}

SavedPage saved_page(const Page& page) {
    return {page.view().size(), page.depth, checksum_of(bytes_of(page.view()))};
}

uint64_t version_of_levels() {
    return checksum_of_layout() + kLevelsVersion;
}

void LevelsWriter::add(const SavedLeaf& leaf, const SavedPage& page,
                       std::span<const uvec4> texels) {
    assert(page.texels == texels.size());
    leaves_.push_back(leaf);
    pages_.push_back(page);
    const auto head = texels.first(kHeadTexels);
    heads_.insert(heads_.end(), head.begin(), head.end());
    writer_.write(bytes_of(texels));
}

void LevelsWriter::begin_lists() {
    writer_.begin("lists");
}

void LevelsWriter::add_lists(std::span<const TriangleId> triangles) {
    writer_.write(bytes_of(triangles));
}

bool LevelsWriter::finish(const LevelsKey& key, std::span<const LevelsCut> cuts) {
    const SavedKey saved_key = key_of(key);
    std::vector<SavedCut> saved_cuts;
    for (const LevelsCut& cut : cuts)
        saved_cuts.push_back(saved_cut(cut));
    writer_.part<SavedKey>("key", std::span(&saved_key, 1));
    writer_.part<SavedCut>("cuts", saved_cuts);
    writer_.begin("twins");
    const auto write = [&](std::span<const Duplicates::Pair> pairs) {
        writer_.write(bytes_of(pairs));
    };
    for (const LevelsCut& cut : cuts) {
        write(cut.duplicates);
        if (cut.each_more)
            cut.each_more(write);
    }
    writer_.begin("nodes");
    for (const LevelsCut& cut : cuts)
        writer_.write(bytes_of(std::span<const KdNode>(cut.level1.nodes)));
    writer_.part<SavedLeaf>("leaves", leaves_);
    writer_.part<SavedPage>("pages", pages_);
    writer_.part<uvec4>("heads", heads_);
    writer_.part<uint64_t>("corner sums", key.soup.sums);
    return writer_.finish();
}

bool save_levels(const BuiltScene& scene, const ByteSink& sink) {
    LevelsWriter writer(sink);
    const std::vector<const BuiltScene*> scenes = cuts_of(scene);
    for (const BuiltScene* cut : scenes)
        for (size_t i = 0; i < cut->level1.leaves.size(); ++i) // pages of others may follow
            writer.add(saved_leaf(cut->level1.leaves[i]), saved_page(cut->pages[i]),
                       cut->pages[i].view());
    writer.begin_lists();
    std::vector<LevelsCut> cuts;
    for (const BuiltScene* cut : scenes) {
        cuts.push_back(levels_cut(*cut));
        for (const Leaf& leaf : cut->level1.leaves)
            writer.add_lists(leaf.list());
    }
    return writer.finish({corner_sums_of(scene.soup), scene.limits, scene.any_limits}, cuts);
}

uint64_t saved_bytes(const LevelsSize& size) {
    constexpr uint64_t kParts = 10;
    return size.page_bytes + size.references * sizeof(TriangleId) +
           size.leaves * (sizeof(SavedLeaf) + sizeof(SavedPage) + kHeadTexels * sizeof(uvec4)) +
           size.nodes * sizeof(KdNode) + size.duplicates * sizeof(Duplicates::Pair) +
           size.corner_blocks * sizeof(uint64_t) + size.cuts * sizeof(SavedCut) + sizeof(SavedKey) +
           kParts * (sizeof(ArchivePart) + kPartAlignment);
}

} // namespace ovc
