// SPDX-License-Identifier: Apache-2.0
// Rays and hits as text.
#include "host/ray_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

TEST(ParseRay, TakesSixOrEightNumbers) {
    const Result<Ray> six = parse_ray("1 2 3 -4 5e-1 .25");
    ASSERT_TRUE(six);
    EXPECT_EQ(six->org, dvec3(1, 2, 3));
    EXPECT_EQ(six->dir, dvec3(-4, 0.5, 0.25));
    EXPECT_EQ(six->t_min, 0);
    EXPECT_EQ(six->t_max, INFINITY);
    const Result<Ray> eight = parse_ray("\t+1,2,3  -4 5 6 0.5 inf\r");
    ASSERT_TRUE(eight);
    EXPECT_EQ(eight->org.x, 1);
    EXPECT_EQ(eight->t_min, 0.5);
    EXPECT_EQ(eight->t_max, INFINITY);
}

TEST(ParseRay, LetsBadNumbersThroughToTheBackend) {
    const Result<Ray> ray = parse_ray("nan 2 3 inf 5 6");
    ASSERT_TRUE(ray);
    EXPECT_FALSE(ray->valid());
}

TEST(ParseRay, SaysWhatIsWrong) {
    const struct {
        const char* line;
        const char* error;
    } cases[] = {
        {"1 2 3 4 5", "found 5 numbers, expected ox oy oz dx dy dz [tmin tmax]"},
        {"7", "found 1 number, expected ox oy oz dx dy dz [tmin tmax]"},
        {"1 2 3 4 5 6 7", "found 7 numbers, expected ox oy oz dx dy dz [tmin tmax]"},
        {"1 2 3 4 5 6 7 8 9", "found more than 8 numbers, expected ox oy oz dx dy dz [tmin tmax]"},
        {"1 2 x 4 5 6", "found 'x', expected a number"},
        {"1 2 3z 4 5 6", "found '3z', expected a number"},
        {"1 2 +-3 4 5 6", "found '+-3', expected a number"},
        {"1 2 1e999 4 5 6", "the number '1e999' does not fit a double"},
    };
    for (const auto& c : cases) {
        const Result<Ray> ray = parse_ray(c.line);
        ASSERT_FALSE(ray) << c.line;
        EXPECT_EQ(ray.error().message, c.error);
    }
}

TEST(IsBlankLine, PassesOverCommentsAndNothing) {
    for (const char* line : {"", "  \t", "\r", "# a comment", "  # another"})
        EXPECT_TRUE(is_blank_line(line)) << line;
    EXPECT_FALSE(is_blank_line("0 0 0 0 0 1"));
}

TEST(AppendHit, WritesTheShortestDecimalsThatReadBack) {
    std::string text;
    append_hit(text, {0.1 + 0.2, 1, 1.0 / 3, {4, 5}});
    append_hit(text, {});
    EXPECT_EQ(text, "0.30000000000000004 1 0.3333333333333333 4 5\nmiss\n");
}

} // namespace ovc
