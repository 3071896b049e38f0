// SPDX-License-Identifier: Apache-2.0
// Tests of --frames, and of #### in names.
#include "host/render/frames.h"

#include <gmock/gmock.h>

namespace ovc {

TEST(Frames, AreOneOrARangeOrEverySoMany) {
    const struct {
        const char* text;
        uint32_t first, last, step, count;
    } cases[] = {{"7", 7, 7, 1, 1},         {"0:99", 0, 99, 1, 100},
                 {"99:99", 99, 99, 1, 1},   {"0:99:10", 0, 99, 10, 10},
                 {"3:98:19", 3, 98, 19, 6}, {"5:6:4294967295", 5, 6, 4294967295u, 1}};
    for (const auto& c : cases) {
        const Result<FrameRange> range = parse_frames(c.text, 100, "x");
        ASSERT_TRUE(range) << range.error().message;
        EXPECT_EQ(range->first, c.first) << c.text;
        EXPECT_EQ(range->last, c.last) << c.text;
        EXPECT_EQ(range->step, c.step) << c.text;
        EXPECT_EQ(range->count(), c.count) << c.text;
    }
}

TEST(Frames, WrongOnesAreAnsweredWithOneSentence) {
    for (const char* text : {"", ":", "a", "1:", ":1", "1:2:", "1:2:3:4", "-1:2", "1 :2", "1.5",
                             "0x1", "+1", "4294967296", "99999999999999999999", "1::2", "1;2"})
        EXPECT_THAT(parse_frames(text, 100, "x").error().message,
                    testing::StartsWith("--frames needs FIRST:LAST"))
            << text;
    EXPECT_EQ(parse_frames("5:4", 100, "x").error().message,
              "--frames goes from the first to the last, not '5:4'");
    EXPECT_EQ(parse_frames("1:2:0", 100, "x").error().message,
              "--frames needs a step of at least 1, not '1:2:0'");
    EXPECT_EQ(parse_frames("0:100", 100, "dragons-3").error().message,
              "--frames: there is no frame 100; dragons-3 has frames 0 to 99");
}

TEST(FrameFile, HasTheNumberInThePlaceOfItsLastRun) {
    EXPECT_EQ(frame_file("out-####.png", 7), "out-0007.png");
    EXPECT_EQ(frame_file("out-####.png", 123456), "out-123456.png");
    EXPECT_EQ(frame_file("#.exr", 0), "0.exr");
    EXPECT_EQ(frame_file("c#/a#-##.png", 3), "c#/a#-03.png");
    EXPECT_EQ(frame_file("c##/a.png", 3), "c##/a.png");
    EXPECT_EQ(frame_file("##", 5), "05");
    EXPECT_EQ(frame_file("", 5), "");
    EXPECT_FALSE(has_frame_number("c#/a.png"));
    EXPECT_TRUE(has_frame_number("c#/#.png"));
}

} // namespace ovc
