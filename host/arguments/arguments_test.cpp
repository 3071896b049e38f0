// SPDX-License-Identifier: Apache-2.0
// Tests of the values of arguments, and of their errors.
#include "core/text/suggestion.h"
#include "host/arguments/arguments.h"

#include <gmock/gmock.h>

namespace ovc {

TEST(ParseSize, TakesTwoNumbers) {
    EXPECT_EQ(parse_size("--size", "640x480")->width, 640u);
    EXPECT_EQ(parse_size("--size", "640X480")->height, 480u);
    for (const char* text :
         {"", "640", "x", "0x5", "5x0", "65536x1", "-1x5", "5x5x5", "axb", "5 x 5"})
        EXPECT_FALSE(parse_size("--size", text)) << text;
    EXPECT_EQ(parse_size("--size", "0x5").error().message,
              "the width in --size needs a whole number from 1 to 65535, not '0'");
}

TEST(ParseCamera, TakesSixOrSevenNumbers) {
    EXPECT_EQ(parse_camera("--camera", "1,2,3,4,5,6")->target, dvec3(4, 5, 6));
    EXPECT_EQ(parse_camera("--camera", "-.5, 2,3e1,4,5,6,35")->eye, dvec3(-0.5, 2, 30));
    EXPECT_EQ(parse_camera("--camera", "1,2,3,4,5,6,35")->fov_degrees, 35);
    for (const char* text : {"", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,6,", "1,2,3,4,5,6,0",
                             "1,2,3,4,5,6,180", "1,2,3,1,2,3", "1,2,3,4,5,inf", "1,2,3,4,5,1e101"})
        EXPECT_FALSE(parse_camera("--camera", text)) << text;
    EXPECT_EQ(parse_camera("--camera", "1,2,3,1,2,3").error().message,
              "--camera: the camera looks from a point at itself: '1,2,3,1,2,3'");
    EXPECT_FALSE(parse_position("--light", "1e200,0,0"));
}

TEST(ParseCount, NamesTheOption) {
    EXPECT_EQ(*parse_count("--leaves", "12", 1, 100), 12u);
    EXPECT_EQ(parse_count("--leaves", "abc", 1, 100).error().message,
              "--leaves needs a whole number from 1 to 100, not 'abc'");
    EXPECT_FALSE(parse_count("--leaves", "101", 1, 100));
    EXPECT_FALSE(parse_count("--leaves", "1.5", 1, 100));
    EXPECT_FALSE(parse_count("--leaves", "", 1, 100));
}

class ParseArguments : public testing::Test {
protected:
    ParseArguments() {
        app_.add_option("SCENE", scene_)->required();
        app_.add_option("--gpu-memory", memory_);
        app_.add_option("--leaves", leaves_)
            ->excludes(app_.add_option("--leaf-triangles", per_leaf_));
        app_.add_flag("--quiet", quiet_);
    }
    std::string error(std::vector<std::string> arguments) {
        const Result<Parsed> parsed = parse_arguments(app_, std::move(arguments));
        return parsed ? "" : parsed.error().message;
    }
    CLI::App app_{"", "overcast render"};
    std::string scene_, memory_, leaves_, per_leaf_;
    bool quiet_ = false;
};

TEST_F(ParseArguments, SuggestsTheOptionThatWasMeant) {
    EXPECT_EQ(error({"a.ply", "--gpu-memroy", "5"}),
              "there is no option '--gpu-memroy'; did you mean '--gpu-memory'?");
    EXPECT_EQ(error({"a.ply", "--gpu-memroy=5"}),
              "there is no option '--gpu-memroy'; did you mean '--gpu-memory'?");
    EXPECT_EQ(error({"a.ply", "--zebra"}), "there is no option '--zebra'");
}

TEST_F(ParseArguments, SaysWhatIsMissingOrTooMuch) {
    EXPECT_THAT(error({}), testing::HasSubstr("SCENE"));
    EXPECT_EQ(error({"a.ply", "b.ply"}),
              "'b.ply' is one argument too many for overcast render; see overcast render --help");
    EXPECT_EQ(error({"a.ply", "--gpu-memory"}), "--gpu-memory needs a value");
    EXPECT_EQ(error({"a.ply", "--gpu-memory", "5M", "--gpu-memory=6M"}),
              "--gpu-memory is given more than once");
    EXPECT_EQ(error({"a.ply", "--gpu-memory", "5M"}), "");
    EXPECT_EQ(memory_, "5M");
}

TEST_F(ParseArguments, AnEmptyValueIsNotTheDefault) {
    EXPECT_EQ(error({"a.ply", "--gpu-memory", ""}), "--gpu-memory needs a value that is not empty");
    EXPECT_EQ(error({"--gpu-memory=", "a.ply"}), "--gpu-memory needs a value that is not empty");
    EXPECT_EQ(error({""}), "SCENE needs a value that is not empty");
}

TEST_F(ParseArguments, SpeaksInItsOwnWords) {
    EXPECT_EQ(error({"a.ply", "--quiet=maybe"}), "--quiet takes no value, and was given 'maybe'");
    EXPECT_EQ(error({"a.ply", "--leaves", "4", "--leaf-triangles", "5"}),
              "--leaves and --leaf-triangles cannot be given together");
}

TEST(Suggestion, FindsNearMissesOnly) {
    const std::string_view commands[] = {"render", "info", "trace"};
    EXPECT_EQ(nearest("rendr", commands), "render");
    EXPECT_EQ(nearest("redner", commands), "render");
    EXPECT_EQ(nearest("inof", commands), "info");
    EXPECT_EQ(nearest("zebra", commands), "");
    EXPECT_EQ(did_you_mean("rendre", commands), "; did you mean 'render'?");
}

} // namespace ovc
