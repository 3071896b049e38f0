// SPDX-License-Identifier: Apache-2.0
// FilmTiles: which rank renders which pixels of a film, and in which round.
#pragma once

#include "host/film/film.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <vector>

namespace ovc {

/// Returns for each of the pixels the rank whose leaves its ray comes by first, kNone where there
/// is none; nothing at all where nobody can tell.
using FirstRanks = std::function<std::vector<uint32_t>(std::span<const uint32_t> pixels)>;

/// Tiles of neighbouring pixels, whose rays go the same way.
class FilmTiles {
public:
    /// Fewer at the film's right and lower side.
    static constexpr uint32_t kTilePixels = Film::kTilePixels;

    FilmTiles(uint32_t width, uint32_t height);

    uint32_t count() const { return columns_ * rows_; }

    /// Returns a rank for each tile. All get about as many tiles; of those where first_ranks knows
    /// a rank, that one, as long as it has not more than its part.
    std::vector<uint32_t> deal(uint32_t ranks, const FirstRanks& first_ranks) const;

    /// Returns those tiles for which wanted(tile), along a curve, so that neighbours in the list
    /// are neighbours in the film.
    template <class Wanted>
    std::vector<uint32_t> tiles(Wanted&& wanted) const {
        std::vector<uint32_t> some;
        std::ranges::copy_if(order_, std::back_inserter(some), wanted);
        return some;
    }
    /// Returns the pixels of the tiles, one tile after the other, in each along a curve too.
    std::vector<uint32_t> pixels(std::span<const uint32_t> tiles) const;

private:
    std::vector<uint32_t> wishes(uint32_t ranks, const FirstRanks& first_ranks) const;

    const uint32_t width_, height_;
    const uint32_t side_, run_; // pixels of a tile down and across
    const uint32_t columns_, rows_;
    const std::vector<uint32_t> order_;  // of tiles
    const std::vector<uint32_t> within_; // of pixels in a tile
};

} // namespace ovc
