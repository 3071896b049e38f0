// SPDX-License-Identifier: Apache-2.0
// Asks for the first ranks of a few rays of each tile, and gives most tiles to the rank that most
// of these name: then fewer rays visit another rank.
#include "host/ranks/film_tiles.h"

#include "core/ray.h"
#include "host/camera/camera.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace ovc {

static constexpr uint32_t
    kTileSide = 32,
    kTileRun = FilmTiles::kTilePixels; // of films of one row, whose pixels are points

static_assert(kTileSide * kTileSide == FilmTiles::kTilePixels);

static uint32_t parts_of(uint32_t length, uint32_t part) {
    return (length + part - 1) / part;
}

/// Returns the numbers of a rectangle's places along a curve, of a row from left to right.
static std::vector<uint32_t> curve(uint32_t width, uint32_t height) {
    if (height > 1)
        return pixel_order(width, height);
    std::vector<uint32_t> row(width);
    std::iota(row.begin(), row.end(), 0u);
    return row;
}

FilmTiles::FilmTiles(uint32_t width, uint32_t height)
    : width_(width),
      height_(height),
      side_(height > 1 ? kTileSide : 1),
      run_(height > 1 ? kTileSide : kTileRun),
      columns_(parts_of(width, run_)),
      rows_(parts_of(height, side_)),
      order_(curve(columns_, rows_)),
      within_(curve(run_, side_)) {}

std::vector<uint32_t> FilmTiles::pixels(std::span<const uint32_t> tiles) const {
    std::vector<uint32_t> pixels;
    pixels.reserve(tiles.size() * kTilePixels);
    for (const uint32_t tile : tiles)
        for (const uint32_t i : within_) {
            const uint32_t x = tile % columns_ * run_ + i % run_;
            const uint32_t y = tile / columns_ * side_ + i / run_;
            if (x < width_ && y < height_)
                pixels.push_back(y * width_ + x);
        }
    return pixels;
}

/// Returns for each tile the rank that most of a few rays come by first; kNone where they come by
/// none.
std::vector<uint32_t> FilmTiles::wishes(uint32_t ranks, const FirstRanks& first_ranks) const {
    constexpr uint32_t kAcross = 2, kAsked = kAcross * kAcross; // rays a tile
    std::vector<uint32_t> pixels;
    for (uint32_t tile = 0; tile < count(); ++tile)
        for (uint32_t i = 0; i < kAsked; ++i) {
            const uint32_t x = tile % columns_ * run_ + (2 * (i % kAcross) + 1) * run_ / 4;
            const uint32_t y = tile / columns_ * side_ + (2 * (i / kAcross) + 1) * side_ / 4;
            pixels.push_back(std::min(y, height_ - 1) * width_ + std::min(x, width_ - 1));
        }
    const std::vector<uint32_t> first = first_ranks(pixels);
    std::vector<uint32_t> wished(count(), kNone), votes(ranks);
    for (uint32_t tile = 0; !first.empty() && tile < count(); ++tile) {
        std::ranges::fill(votes, 0u);
        for (uint32_t i = 0; i < kAsked; ++i)
            if (const uint32_t rank = first[tile * kAsked + i]; rank < ranks)
                ++votes[rank];
        const auto largest = std::ranges::max_element(votes);
        if (*largest > 0)
            wished[tile] = uint32_t(largest - votes.begin());
    }
    return wished;
}

std::vector<uint32_t> FilmTiles::deal(uint32_t ranks, const FirstRanks& first_ranks) const {
    assert(ranks > 0);
    std::vector<uint32_t> owners = wishes(ranks, first_ranks);
    const auto wished = count() - uint32_t(std::ranges::count(owners, kNone));
    const uint32_t max = parts_of(wished, ranks);
    std::vector<uint32_t> has(ranks);
    for (uint32_t& owner : owners)
        if (owner != kNone && ++has[owner] > max)
            --has[owner], owner = kNone;
    // The others go to the rank that has the fewest. Neighbours among them so go to different
    // ranks, as they should, for their rays take about as long.
    for (uint32_t tile = 0; tile < count(); ++tile)
        if (owners[tile] == kNone) {
            const auto smallest = std::ranges::min_element(has);
            owners[tile] = uint32_t(smallest - has.begin());
            ++*smallest;
        }
    return owners;
}

} // namespace ovc
