// SPDX-License-Identifier: Apache-2.0
// StreamedLevelsWriter: pages go straight to the sink. Lists wait in the scratch space, because the
// archive has them in one part.
#include "plugin/out_of_core/streamed_levels.h"

#include "core/text/format_text.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {

static ByteSink throwing(const ByteSink& sink) {
    return [&sink](Bytes bytes) {
        if (!sink(bytes))
            throw Cancelled();
        return true;
    };
}

StreamedLevelsWriter::StreamedLevelsWriter(const ByteSink& sink, ScratchSpace& scratch,
                                           BuildSteps& steps)
    : writer_(throwing(sink)), scratch_(scratch), steps_(steps), duplicates_(scratch) {}

void StreamedLevelsWriter::add_tree(size_t cell, bool is_far, std::vector<KdNode> nodes,
                                    size_t leaves) {
    const auto first = uint32_t(writer_.leaves());
    if (is_far) {
        assert(first == far_leaves_);
        far_leaves_ += uint32_t(leaves);
        return;
    }
    if (!trees_.empty() && trees_.back().cell == cell) {
        KdNode& node = trees_.back().nodes.front();
        node = KdNode::leaf(node.first(), node.count() + uint32_t(leaves));
        trees_.back().end += uint32_t(leaves);
        return;
    }
    for (KdNode& node : nodes)
        node = node.moved(0, first);
    trees_.push_back({cell, std::move(nodes), first + uint32_t(leaves)});
}

StreamedLevelsWriter::List StreamedLevelsWriter::put_list(std::span<const TriangleId> triangles) {
    const Bytes bytes = bytes_of(triangles);
    const List list{scratch_.allocate(bytes.size()), triangles.size(), checksum_of(bytes)};
    scratch_.write(list.offset, bytes);
    return list;
}

void StreamedLevelsWriter::add(size_t cell, bool is_far, BuiltCell built) {
    add_tree(cell, is_far, built.nodes, built.leaves.size());
    std::vector<KeptLeaf> kept;
    for (size_t i = 0; i < built.leaves.size(); ++i) {
        lists_.push_back(put_list(built.leaves[i].triangles));
        kept.push_back({saved_leaf(built.leaves[i]), saved_page(built.pages[i]), writer_.bytes(),
                        lists_.back()});
        writer_.add(kept.back().leaf, kept.back().page, built.pages[i].view());
    }
    const DuplicateRuns::Run run = duplicates_.put(built.duplicates);
    duplicates_.add(run);
    steps_.keep(uint64_t(cell), built.nodes, kept, run.offset, run.pairs, run.checksum);
}

bool StreamedLevelsWriter::add_kept(size_t cell, bool is_far) {
    uint64_t kept_cell = 0;
    std::vector<KdNode> nodes;
    std::vector<KeptLeaf> leaves;
    DuplicateRuns::Run run;
    if (!steps_.take(kept_cell, nodes, leaves, run.offset, run.pairs, run.checksum))
        return false;
    if (kept_cell != cell)
        BuildSteps::fail();
    add_tree(cell, is_far, std::move(nodes), leaves.size());
    std::vector<uvec4> texels;
    for (const KeptLeaf& leaf : leaves) {
        texels.resize(leaf.page.texels);
        steps_.read_written(leaf.page_offset, std::as_writable_bytes(std::span(texels)),
                            leaf.page.checksum);
        lists_.push_back(leaf.list);
        writer_.add(leaf.leaf, leaf.page, texels);
    }
    duplicates_.add(run);
    return true;
}

/// Puts the trees over the cells in the places of the cells.
std::vector<KdNode> StreamedLevelsWriter::joined_nodes(std::span<const KdNode> planes) const {
    std::vector<KdNode> nodes;
    std::vector<uint32_t> now_at(planes.size());
    auto tree = trees_.begin();
    uint32_t leaves = far_leaves_; // so far
    size_t cell = 0;
    for (size_t n = 0; n < planes.size(); ++n) {
        const auto place = now_at[n] = uint32_t(nodes.size());
        if (!planes[n].is_leaf()) {
            nodes.push_back(planes[n]);
            continue;
        }
        if (tree == trees_.end() || tree->cell != cell++) {
            nodes.push_back(KdNode::leaf(leaves, 0));
            continue;
        }
        for (const KdNode& node : tree->nodes)
            nodes.push_back(node.is_leaf() ? node : node.moved(place, 0));
        leaves = (tree++)->end;
    }
    assert(tree == trees_.end());
    for (size_t n = 0; n < planes.size(); ++n)
        if (!planes[n].is_leaf())
            nodes[now_at[n]].set_above(now_at[planes[n].above()]);
    return nodes;
}

void StreamedLevelsWriter::write_lists() {
    writer_.begin_lists();
    std::vector<TriangleId> list;
    for (const List& from : lists_) {
        list.resize(from.triangles);
        scratch_.read(from.offset, std::as_writable_bytes(std::span(list)));
        if (checksum_of(bytes_of(std::span<const TriangleId>(list))) != from.checksum)
            throw damaged_scratch();
        writer_.add_lists(list);
    }
}

Result<StreamedLevels> StreamedLevelsWriter::finish(const LevelsKey& key, const Dropped& dropped,
                                                    uint64_t hittable, Level1 level1,
                                                    std::span<const KdNode> planes) {
    const uint64_t leaves = writer_.leaves();
    if (leaves >= OVC_KEY_LEAF)
        return over_budget(format_text("{} leaves are too many: at most {}; give more host memory, "
                                       "or let leaves hold more triangles",
                                       leaves, OVC_KEY_LEAF - 1));
    if (leaves > 0)
        level1.nodes = joined_nodes(planes);
    level1.far_leaves = far_leaves_;
    LevelsCut cut{dropped, {}, level1, leaves};
    duplicates_.for_each(
        [&](std::span<const Duplicates::Pair> pairs) { cut.more_duplicates += pairs.size(); });
    cut.each_more = [&](const LevelsCut::WritePairs& write) { duplicates_.for_each(write); };
    write_lists();
    const uint64_t triangles = cut.triangles = hittable - cut.more_duplicates;
    writer_.finish(key, std::span(&cut, 1));
    return StreamedLevels{leaves, triangles, true};
}

} // namespace ovc
