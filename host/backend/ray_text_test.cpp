// SPDX-License-Identifier: Apache-2.0
// Tests of rays and hits as text.
#include "host/backend/ray_text.h"

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
    const Result<Ray> eight = parse_ray("\t+1 2\t3  -4 5 6 0.5 inf\r");
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
        {"1 2 -1e9999 4 5 6", "the number '-1e9999' does not fit a double"},
        {"1 2 3 4 5 1e999x", "found '1e999x', expected a number"},
        {"0,5 0 5 0 0 -1", "found '0,5', expected a number; numbers are separated by blanks and "
                           "have a decimal point, no comma"},
        {"0, 0, 5, 0, 0, -1", "found '0,', expected a number; numbers are separated by blanks and "
                              "have a decimal point, no comma"},
        {"1 2 3 4 5 \x1b[0m\xe2", "found '\\x1b[0m\\xe2', expected a number"},
        {"1 2 3 4 5 # 6", "found 5 numbers, expected ox oy oz dx dy dz [tmin tmax]"},
    };
    for (const auto& c : cases) {
        const Result<Ray> ray = parse_ray(c.line);
        ASSERT_FALSE(ray) << c.line;
        EXPECT_EQ(ray.error().message, c.error);
    }
}

TEST(ParseRay, HintsAtBinaryWhereTextHasNoNul) {
    EXPECT_EQ(parse_ray(std::string_view("1\0\0 2", 5)).error().message,
              "found '1\\x00\\x00', expected a number; rays that are no text need --binary");
    const std::string zeros(100, '\0');
    EXPECT_NE(parse_ray(zeros).error().message.find("\\x00...'"), std::string::npos);
}

TEST(ParseRay, TakesACommentAfterTheNumbers) {
    for (const char* line : {"1 2 3 4 5 6 # up, 7", "1 2 3 4 5 6#"}) {
        const Result<Ray> ray = parse_ray(line);
        ASSERT_TRUE(ray) << line;
        EXPECT_EQ(ray->dir.z, 6);
    }
}

TEST(ParseRay, RoundsWhatIsTooSmall) {
    const Result<Ray> ray = parse_ray("1e-400 -1e-9999 4e-324 1e-310 5 6");
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->org, dvec3(0, 0, 4.9406564584124654e-324));
    EXPECT_TRUE(std::signbit(ray->org.y));
    EXPECT_EQ(ray->dir.x, 1e-310);
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
