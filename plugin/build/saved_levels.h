// SPDX-License-Identifier: Apache-2.0
// Saves a scene as bytes that outlive the process: level 1 and the pages, and a key of what they
// were made of. plugin/build/restored_levels.h reads them.
#pragma once

#include "core/file/archive.h"
#include "core/function_ref.h"
#include "plugin/build/built_scene.h"
#include "plugin/build/levels_format.h"
#include "plugin/leaf_store/corner_sums.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// What is saved of one cut: all triangles that are placed once make the first, and each shared
/// mesh makes another.
struct LevelsCut {
    Dropped dropped;
    std::span<const Duplicates::Pair> duplicates; // sorted
    const Level1& level1;                         // whose own leaves are not looked at
    uint64_t leaves = 0;                          // of those that were added
    uint64_t triangles = 0;                       // in leaves, each counted once
    std::optional<Transform> rest_place{};        // of a mesh that came to rest: where it did
    /// Duplicates that are not in memory, instead of the others: how many there are, and what calls
    /// write() with all of them, sorted.
    using WritePairs = FunctionRef<void(std::span<const Duplicates::Pair>)>;
    uint64_t more_duplicates = 0;
    std::function<void(const WritePairs& write)> each_more{};
};

/// Decides whether a later scene may take levels.
struct LevelsKey {
    const CornerSums& soup;
    LeafLimits limits{}; // unless any_limits
    /// Whether levels are good under other limits too, where the host asks for none itself: it
    /// takes longer to build them again than leaves of another size save.
    bool any_limits = false;
};

SavedLeaf saved_leaf(const Leaf& leaf);
SavedPage saved_page(const Page& page);

/// Returns a number that changes with the version of what is saved.
uint64_t version_of_levels();

/// Writes saved levels leaf by leaf, so that nobody need hold all of them.
class LevelsWriter {
public:
    explicit LevelsWriter(const ByteSink& sink);

    /// Writes the page of the next leaf.
    void add(const SavedLeaf& leaf, const SavedPage& page, std::span<const uvec4> texels);
    /// Ends the leaves. The triangles of all of them come next, in order and in parts of any size.
    void begin_lists();
    void add_lists(std::span<const TriangleId> triangles);
    /// Ends the levels. Returns false where the sink wanted no more.
    bool finish(const LevelsKey& key, std::span<const LevelsCut> cuts);

    uint64_t leaves() const { return leaves_.size(); }
    /// Returns how many bytes were passed to the sink.
    uint64_t bytes() const { return writer_.bytes(); }

private:
    ArchiveWriter writer_;
    std::vector<SavedLeaf> leaves_;
    std::vector<SavedPage> pages_;
    std::vector<uvec4> heads_;
};

/// Passes the scene on to the sink, front to back. Returns false where the sink wanted no more.
bool save_levels(const BuiltScene& scene, const ByteSink& sink);

/// The number of bytes of saved levels depends on these.
struct LevelsSize {
    uint64_t page_bytes = 0;
    uint64_t references = 0;
    uint64_t leaves = 0;
    uint64_t nodes = 0;
    uint64_t duplicates = 0;
    uint64_t corner_blocks = 0;
    uint64_t cuts = 1;
};
/// Returns about how many bytes save_levels() writes of levels of that size.
uint64_t saved_bytes(const LevelsSize& size);

} // namespace ovc
