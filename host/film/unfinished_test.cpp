// SPDX-License-Identifier: Apache-2.0
// Tests that an interrupted picture comes back to the bit, or is refused.
#include "host/film/unfinished.h"

#include "importers/test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ovc {
namespace {

class UnfinishedTest : public testing::Test {
protected:
    UnfinishedTest() {
        for (uint32_t pixel = 0; pixel < 60; pixel += 3) {
            film_.add(pixel, {0.1f * float(pixel), 1e-7f, 300});
            film_.close(pixel);
            film_.close(pixel);
        }
        film_.add(1, vec3(1)); // not done
    }
    std::string saved() {
        const std::string path = folder_ / "a.unfinished.film";
        EXPECT_TRUE(save_film(film_, 77, path));
        return path;
    }

    const TestFolder folder_;
    Film film_{10, 6, 2};
};

TEST_F(UnfinishedTest, ComesBackToTheBit) {
    Film again(10, 6, 2);
    ASSERT_TRUE(load_film(saved(), 77, again));
    EXPECT_EQ(again.pixels_done(), 20u);
    for (uint32_t pixel = 0; pixel < 60; ++pixel) {
        EXPECT_EQ(again.done(pixel), film_.done(pixel));
        EXPECT_EQ(again.sums(pixel), film_.done(pixel) ? film_.sums(pixel) : Film::Sums());
    }
}

TEST_F(UnfinishedTest, RefusesAnotherPictures) {
    const std::string path = saved();
    Film same(10, 6, 2), wider(12, 5, 2), smoother(10, 6, 4);
    EXPECT_THAT(
        load_film(path, 78, same).error().message,
        testing::HasSubstr("a.unfinished.film: the unfinished picture is of another scene"));
    EXPECT_FALSE(load_film(path, 77, wider));
    EXPECT_FALSE(load_film(path, 77, smoother));
    EXPECT_EQ(same.pixels_done() + wider.pixels_done() + smoother.pixels_done(), 0u);
}

TEST_F(UnfinishedTest, RefusesEveryDamage) {
    const std::string path = saved();
    const std::string bytes = folder_.read("a.unfinished.film");
    for (size_t at = 0; at < bytes.size(); at += 7) {
        std::string damaged = bytes;
        damaged[at] = char(damaged[at] ^ 0x20);
        folder_.write("a.unfinished.film", damaged);
        Film film(10, 6, 2);
        const Result<Done> loaded = load_film(path, 77, film);
        // Damaged padding does no harm.
        EXPECT_TRUE(!loaded || film.sums(3) == film_.sums(3)) << "byte " << at;
    }
    folder_.write("a.unfinished.film", bytes.substr(0, bytes.size() / 2));
    Film film(10, 6, 2);
    EXPECT_FALSE(load_film(path, 77, film));
}

TEST(Unfinished, StandsBesideTheOutput) {
    EXPECT_EQ(unfinished_picture("d/out.0.png"), "d/out.0.unfinished.png");
    EXPECT_EQ(unfinished_film("d/out.0.png"), "d/out.0.unfinished.film");
}

} // namespace
} // namespace ovc
