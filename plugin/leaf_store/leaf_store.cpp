// SPDX-License-Identifier: Apache-2.0
// LeafStore: reads, checks, and shares its budget out between pages and corners.
#include "plugin/leaf_store/leaf_store.h"

#include "core/file/checksum.h"
#include "core/text/format_text.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace ovc {

/// A mesh as the store knows it.
class LeafStore::Mesh final : public StoredCorners {
public:
    Mesh(LeafStore& store, uint32_t number_, uint64_t triangles_, bool has_doubles,
         ReadCorners read)
        : number(number_),
          triangles(triangles_),
          read_corners(std::move(read)),
          store_(store),
          has_doubles_(has_doubles) {}

    bool has_doubles() const override { return has_doubles_; }
    bool read(uint32_t first, std::span<std::byte> to) const override {
        return store_.copy_corners(*this, first, to);
    }

    const uint32_t number;
    const uint64_t triangles;
    const ReadCorners read_corners;
    uint64_t first_sum = 0; // of its blocks

private:
    LeafStore& store_;
    const bool has_doubles_;
};

LeafStore::LeafStore(uint64_t budget_bytes, ReadBytes read, uint64_t saved_bytes)
    : budget_(budget_bytes), read_(std::move(read)), saved_bytes_(saved_bytes) {}
LeafStore::~LeafStore() = default;

const StoredCorners& LeafStore::add_mesh(uint64_t triangles, bool has_doubles, ReadCorners read) {
    meshes_.push_back(std::make_unique<Mesh>(*this, uint32_t(meshes_.size()), triangles,
                                             has_doubles, std::move(read)));
    return *meshes_.back();
}

std::span<const uvec4> LeafStore::keep_heads(std::vector<uvec4> heads) {
    heads_ = std::move(heads);
    return heads_;
}

void LeafStore::set_sums(const CornerSums& sums) {
    sums_ = sums.sums;
    for (const SummedMesh& mesh : sums.meshes)
        if (mesh.stored)
            meshes_[static_cast<const Mesh*>(mesh.stored)->number]->first_sum = mesh.first_sum;
}

void LeafStore::set_pages(std::vector<PagePlace> pages, uint64_t table_bytes) {
    pages_ = std::move(pages);
    table_bytes_ = table_bytes + sums_.size() * sizeof(uint64_t);
}

uint64_t LeafStore::block_bytes() const {
    size_t triangle_bytes = 1;
    for (const auto& mesh : meshes_)
        triangle_bytes = std::max(triangle_bytes, mesh->triangle_bytes());
    return kCornerBlock * triangle_bytes;
}

uint64_t LeafStore::page_bytes() const {
    uint64_t bytes = 1;
    for (const PagePlace& page : pages_)
        bytes += page.bytes;
    return bytes;
}

uint64_t LeafStore::smallest_bytes() const {
    uint64_t largest = 1;
    for (const PagePlace& page : pages_)
        largest = std::max(largest, page.bytes);
    return table_bytes_ + BlockCache::min_bytes(block_bytes()) + 2 * largest * 4 / 3 + 1;
}

/// Corners get a quarter, more where pages do not need the rest, and no more than there are. Blocks
/// share places, so that there is room for a few more than all of them.
LeafStore::Shares LeafStore::shares() const {
    const uint64_t bytes = budget_ - std::min(budget_, table_bytes_);
    const uint64_t all_pages = page_bytes(), all_corners = sums_.size() * block_bytes() * 5 / 4;
    const uint64_t rest = bytes - std::min(bytes, all_pages);
    const uint64_t corners = std::max(BlockCache::min_bytes(block_bytes()),
                                      std::min(all_corners, std::max(bytes / 4, rest)));
    return {std::min(bytes - std::min(bytes, corners), all_pages), corners};
}

uint64_t LeafStore::max_bytes() const {
    const uint64_t all_corners = sums_.size() * block_bytes();
    return table_bytes_ + shares().pages + std::min(shares().corners, all_corners);
}

Result<Done> LeafStore::open(CheckPage check) {
    if (budget_ < smallest_bytes())
        return over_budget(
            format_text("{} bytes of host memory are too few for this scene: the smallest number "
                        "that works is {}",
                        budget_, smallest_bytes()));
    check_ = std::move(check);
    std::vector<uint64_t> bytes;
    for (const PagePlace& page : pages_)
        bytes.push_back(page.bytes);
    // Any two pages fit; see PageCache.
    corner_cache_ = std::make_unique<BlockCache>(block_bytes(), shares().corners);
    page_cache_ = std::make_unique<PageCache>(
        std::move(bytes), shares().pages,
        [this](uint32_t number, std::span<std::byte> to) { return fill_page(number, to); });
    return Done{};
}

void LeafStore::count_read(uint64_t bytes) {
    reads_.fetch_add(1, std::memory_order_relaxed);
    read_bytes_.fetch_add(bytes, std::memory_order_relaxed);
}

void LeafStore::fail(Error error) const {
    if (error.kind == ErrorKind::Other) // it may be memory that there is not
        error.kind = ErrorKind::Unreadable;
    if (tell_)
        tell_(std::move(error));
}

PageCache::Pin LeafStore::page(uint32_t number) {
    Result<PageCache::Pin> pin = page_cache_->pin(number);
    if (pin)
        return std::move(*pin);
    fail(pin.error());
    return {};
}

Result<Done> LeafStore::fill_page(uint32_t number, std::span<std::byte> to) {
    const PagePlace& place = pages_[number];
    count_read(place.bytes);
    if (!read_(place.offset, to))
        return Error{format_text("the page of leaf {} cannot be read", number)};
    if (checksum_of(to) != place.checksum)
        return Error{format_text("the page of leaf {} is damaged: its checksum is wrong", number)};
    if (!check_(number, {reinterpret_cast<const uvec4*>(to.data()), to.size() / sizeof(uvec4)}))
        return Error{format_text("the page of leaf {} is damaged: it is no page", number)};
    return Done{};
}

bool LeafStore::fill_block(const Mesh& mesh, uint32_t block, std::span<std::byte> to) {
    const uint64_t first = uint64_t(block) * kCornerBlock;
    const uint64_t count = std::min<uint64_t>(kCornerBlock, mesh.triangles - first);
    const auto corners = to.first(count * mesh.triangle_bytes());
    const auto failed = [&](const char* how) {
        fail({format_text("the corners of triangles {} to {} of mesh {} {}", first,
                          first + count - 1, mesh.number, how)});
        return false;
    };
    count_read(corners.size());
    if (!mesh.read_corners(first, count, corners.data()))
        return failed("cannot be read");
    if (checksum_of(corners) != sums_[mesh.first_sum + block])
        return failed("are damaged: their checksum is wrong");
    return true;
}

bool LeafStore::copy_corners(const Mesh& mesh, uint32_t first, std::span<std::byte> to) {
    if (!corner_cache_) {
        const uint64_t count = to.size() / mesh.triangle_bytes();
        count_read(to.size());
        if (mesh.read_corners(first, count, to.data()))
            return true;
        fail({format_text("the corners of triangles {} to {} of mesh {} cannot be read", first,
                          first + count - 1, mesh.number)});
        std::ranges::fill(to, std::byte(0));
        return false;
    }
    bool all = true;
    while (!to.empty()) {
        const uint32_t block = first / kCornerBlock, within = first % kCornerBlock;
        const size_t bytes = std::min(to.size(), (kCornerBlock - within) * mesh.triangle_bytes());
        const auto part = to.first(bytes);
        const auto fill = [&](std::span<std::byte> whole) {
            return fill_block(mesh, block, whole);
        };
        if (!corner_cache_->copy(mesh.first_sum + block, within * mesh.triangle_bytes(), part,
                                 fill)) {
            std::ranges::fill(part, std::byte(0));
            all = false;
        }
        to = to.subspan(bytes);
        first += uint32_t(bytes / mesh.triangle_bytes());
    }
    return all;
}

LeafStore::Counts LeafStore::counts() const {
    Counts all{.budget_bytes = budget_, .read_bytes = read_bytes_, .reads = reads_};
    if (!page_cache_)
        return all;
    const PageCache::Counts pages = page_cache_->counts();
    all.peak_bytes = table_bytes_ + pages.peak_bytes + corner_cache_->bytes();
    all.hits = pages.hits + corner_cache_->hits();
    all.misses = pages.misses + corner_cache_->misses();
    all.ahead = pages.ahead;
    return all;
}

} // namespace ovc
