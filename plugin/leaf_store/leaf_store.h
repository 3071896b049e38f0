// SPDX-License-Identifier: Apache-2.0
// LeafStore: the pages and the corners of a scene that lie on a disk, of which it keeps those in
// memory that were needed lately, within a budget.
#pragma once

#include "core/file/archive.h"
#include "core/file/block_cache.h"
#include "core/file/stored_corners.h"
#include "core/result.h"
#include "plugin/leaf_store/corner_sums.h"
#include "plugin/leaf_store/page_cache.h"

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ovc {

/// The place of a page in saved levels, and the checksum that tells whether it is whole.
struct PagePlace {
    uint64_t offset;
    uint64_t bytes;
    uint64_t checksum;
};

/// Nothing that is read is believed before its checksum and its own check are right. A failure does
/// not end what is under way at once: a triangle whose corners are missing becomes one that no ray
/// hits, a page one that holds nothing, and whoever asked on_failure() hears of it.
class LeafStore {
public:
    /// Fills `corners` with those of `count` triangles of a mesh from `first` on. Returns false
    /// where it cannot. Several threads may call it.
    using ReadCorners = std::function<bool(uint64_t first, uint64_t count, void* corners)>;
    /// Returns whether a page that was read is one that walks may go through.
    using CheckPage = std::function<bool(uint32_t page, std::span<const uvec4> texels)>;

    /// read: gives what was saved, `saved_bytes` in all.
    LeafStore(uint64_t budget_bytes, ReadBytes read, uint64_t saved_bytes);
    ~LeafStore();
    LeafStore(const LeafStore&) = delete;

    /// Returns the corners of a mesh, for Chunk::stored(). Before open() they are read unchecked.
    const StoredCorners& add_mesh(uint64_t triangles, bool has_doubles, ReadCorners read);

    const ReadBytes& read() const { return read_; }
    uint64_t saved_bytes() const { return saved_bytes_; }

    /// Keeps the heads of pages in memory.
    std::span<const uvec4> keep_heads(std::vector<uvec4> heads);
    /// Takes the checksums of the meshes' corners, whose SummedMesh::stored are of add_mesh().
    void set_sums(const CornerSums& sums);
    /// Takes the pages, after set_sums(). table_bytes: what else of the scene is kept in memory.
    void set_pages(std::vector<PagePlace> pages, uint64_t table_bytes);
    /// Shares the budget out, after set_pages(). Error of the kind OverBudget: names the smallest
    /// budget that works.
    Result<Done> open(CheckPage check);

    /// Return, after set_pages(), the smallest budget that works, and the most that is taken of the
    /// one there is.
    uint64_t smallest_bytes() const;
    uint64_t max_bytes() const;

    /// Returns a page; nothing where it cannot be read.
    PageCache::Pin page(uint32_t number);
    bool is_here(uint32_t page) const { return page_cache_->is_here(page); }
    void read_ahead(std::vector<uint32_t> pages) { page_cache_->read_ahead(std::move(pages)); }

    /// Calls tell(error) from now on whenever something cannot be read that somebody needs. Several
    /// threads may call it.
    void on_failure(std::function<void(Error)> tell) { tell_ = std::move(tell); }

    struct Counts {
        uint64_t budget_bytes = 0;
        uint64_t peak_bytes = 0;
        uint64_t read_bytes = 0;
        uint64_t reads = 0;
        uint64_t hits = 0; // of pages and blocks of corners, as the next
        uint64_t misses = 0;
        uint64_t ahead = 0;
    };
    Counts counts() const;

private:
    class Mesh;

    /// The bytes that pages and corners may take.
    struct Shares {
        uint64_t pages;
        uint64_t corners;
    };
    uint64_t block_bytes() const;
    uint64_t page_bytes() const;
    Shares shares() const;

    Result<Done> fill_page(uint32_t number, std::span<std::byte> to);
    bool fill_block(const Mesh& mesh, uint32_t block, std::span<std::byte> to);
    bool copy_corners(const Mesh& mesh, uint32_t first, std::span<std::byte> to);
    void count_read(uint64_t bytes);
    void fail(Error error) const;

    const uint64_t budget_;
    const ReadBytes read_;
    const uint64_t saved_bytes_;
    std::vector<std::unique_ptr<Mesh>> meshes_;
    std::vector<uint64_t> sums_; // of the blocks of all meshes
    std::vector<uvec4> heads_;
    std::vector<PagePlace> pages_;
    CheckPage check_;
    uint64_t table_bytes_ = 0;
    std::atomic<uint64_t> reads_{0}, read_bytes_{0};
    std::function<void(Error)> tell_;
    std::unique_ptr<BlockCache> corner_cache_; // after open()
    std::unique_ptr<PageCache> page_cache_;    // likewise; its threads end first
};

} // namespace ovc
