// SPDX-License-Identifier: Apache-2.0
// Tests that the film's sums do not depend on their order, and when a pixel is done.
#include "host/film/film.h"

#include "core/system/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace ovc {
namespace {

TEST(Film, AddsUpToTheSameBitsInAnyOrderAndFromAnyThread) {
    std::vector<vec3> light(20000);
    std::mt19937 random(1);
    for (vec3& l : light)
        l = std::exp2(float(random() % 24) - 18) * vec3(random() % 1000, random() % 1000, 1);
    Film in_order(2, 1), shuffled(2, 1), parallel(2, 1, uint32_t(light.size()));
    for (const vec3& l : light)
        in_order.add(1, l);
    std::vector<vec3> other = light;
    std::shuffle(other.begin(), other.end(), random);
    for (const vec3& l : other)
        shuffled.add(1, l);
    parallel_for(light.size(), 16, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            parallel.add(1, light[i]);
    });
    EXPECT_EQ(in_order.sums(1), shuffled.sums(1));
    EXPECT_EQ(in_order.sums(1), parallel.sums(1));
    EXPECT_EQ(in_order.sums(0), Film::Sums());
    EXPECT_GT(in_order.sums(1)[0], 0);
}

TEST(Film, IsTheMeanOfItsSamples) {
    Film film(1, 1, 4);
    film.add(0, {1, 2, 3});
    film.add(0, {0, 0, 1});
    for (int i = 0; i < 4; ++i)
        film.close(0);
    EXPECT_EQ(film.image().pixels[0], vec4(0.25f, 0.5f, 1, 1));
}

TEST(Film, APixelIsDoneWhenNoRayIsUnderWay) {
    Film film(2, 1, 2);
    film.close(0);
    EXPECT_FALSE(film.done(0));
    film.open(0, 3);
    for (int i = 0; i < 3; ++i)
        film.close(0);
    EXPECT_FALSE(film.done(0));
    EXPECT_EQ(film.image().pixels[0], vec4(0));
    film.close(0);
    EXPECT_TRUE(film.done(0));
    EXPECT_EQ(film.pixels_done(), 1u);
    film.restore(1, {0, 0, 0});
    EXPECT_EQ(film.pixels_done(), 2u);
}

/// Also where the film ends in the middle of the tile, and for a film of a single row.
TEST(Film, ATileGoesToAnotherFilmWithThePixelsThatAreDone) {
    for (const auto& [width, height] : {std::pair(40u, 50u), std::pair(1100u, 1u)}) {
        Film from(width, height), to(width, height);
        for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
            from.add(pixel, vec3(float(pixel)));
            if (pixel % 3 != 0)
                from.close(pixel);
        }
        to.restore(1, {7, 7, 7});
        std::vector<std::byte> bytes(Film::kTileBytes);
        const auto tile = std::span(bytes).first<Film::kTileBytes>();
        for (uint32_t number = 0; number < from.tile_count(); ++number) {
            from.copy_tile(number, tile);
            to.restore_tile(number, tile);
        }
        EXPECT_EQ(to.pixels_done(), from.pixels_done());
        for (uint32_t pixel = 0; pixel < width * height; ++pixel) {
            ASSERT_EQ(to.done(pixel), from.done(pixel)) << pixel;
            ASSERT_EQ(to.sums(pixel), pixel % 3 != 0 ? from.sums(pixel) : Film::Sums()) << pixel;
        }
    }
}

TEST(Film, GivesAllThatItHasToAnother) {
    Film from(3, 2, 2), to(3, 2, 2);
    from.restore(4, from.sums_of({0.5f, 0.25f, 3}));
    const Film::Sums sums = from.sums(4);
    to.take(std::move(from));
    EXPECT_EQ(to.pixels_done(), 1u);
    EXPECT_EQ(to.sums(4), sums);
    EXPECT_EQ(to.image().pixels[4], vec4(0.5f, 0.25f, 3, 1));
    EXPECT_FALSE(to.done(3));
}

TEST(Film, WhatIsNoNumberIsDarkAndInfinityIsNotMore) {
    Film film(1, 1);
    film.add(0, vec3(std::numeric_limits<float>::quiet_NaN(),
                     std::numeric_limits<float>::infinity(), 0.5f));
    film.close(0);
    const vec4 pixel = film.image().pixels[0];
    EXPECT_EQ(pixel.r, 0);
    EXPECT_TRUE(std::isfinite(pixel.g));
    EXPECT_EQ(pixel.b, 0.5f);
}

} // namespace
} // namespace ovc
