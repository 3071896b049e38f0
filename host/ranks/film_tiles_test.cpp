// SPDX-License-Identifier: Apache-2.0
// Every pixel is one rank's, all ranks get about as many, and most tiles go where they should.
#include "host/ranks/film_tiles.h"

#include "core/ray.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {
namespace {

std::vector<uint32_t> nobody_knows(std::span<const uint32_t>) {
    return {};
}

TEST(FilmTiles, HaveEveryPixelOnce) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {37u, 50u}, {1000u, 1u}, {33u, 2u}}) {
        const FilmTiles tiles(width, height);
        std::vector<uint32_t> pixels = tiles.pixels(tiles.tiles([](uint32_t) { return true; }));
        std::ranges::sort(pixels);
        ASSERT_EQ(pixels.size(), size_t(width) * height);
        for (uint32_t i = 0; i < pixels.size(); ++i)
            EXPECT_EQ(pixels[i], i);
    }
}

TEST(FilmTiles, GoEvenlyToRanks) {
    const FilmTiles tiles(640, 320); // 200 tiles
    const std::vector<uint32_t> owners = tiles.deal(3, nobody_knows);
    ASSERT_EQ(owners.size(), 200u);
    for (uint32_t rank = 0; rank < 3; ++rank)
        EXPECT_NEAR(double(std::ranges::count(owners, rank)), 200 / 3.0, 1.0);
}

TEST(FilmTiles, GoToTheRanksOfTheirRaysAsFarAsThatIsFair) {
    const FilmTiles tiles(640, 320);
    // The left quarter sees leaves of rank 2, the next rank 1's, the right half none.
    const auto first_ranks = [](std::span<const uint32_t> pixels) {
        std::vector<uint32_t> ranks;
        for (const uint32_t pixel : pixels) {
            const uint32_t x = pixel % 640;
            ranks.push_back(x < 160 ? 2 : x < 320 ? 1 : kNone);
        }
        return ranks;
    };
    const std::vector<uint32_t> owners = tiles.deal(3, first_ranks);
    uint32_t as_wished = 0;
    for (uint32_t tile = 0; tile < 200; ++tile)
        as_wished += (tile % 20 < 5 && owners[tile] == 2) ||
                     (tile % 20 >= 5 && tile % 20 < 10 && owners[tile] == 1);
    EXPECT_GE(as_wished, 2 * 34u); // a third of the 100 each, for rank 0 is to have work too
    EXPECT_LT(as_wished, 100u);
    for (uint32_t rank = 0; rank < 3; ++rank)
        EXPECT_NEAR(double(std::ranges::count(owners, rank)), 200 / 3.0, 1.0);
}

} // namespace
} // namespace ovc
