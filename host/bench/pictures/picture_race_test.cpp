// SPDX-License-Identifier: Apache-2.0
// Tests programs that write a picture, and how far it is from the reference.
#include "host/bench/pictures/picture_race.h"
#include "host/bench/pictures/picture_text.h"
#include "host/bench/programs/scratch_folder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

namespace ovc {
namespace {

class PictureRaceTest : public testing::Test {
protected:
    /// Returns a command that writes a picture of one row of pixels.
    PictureChoice gray(const std::string& name, const std::string& codes, int pixels = 2) {
        const std::filesystem::path picture = scratch.path() / (name + ".ppm");
        return {name,
                {"sh", "-c",
                 "printf 'P3 " + std::to_string(pixels) + " 1 1000 " + codes + "' > '" +
                     picture.string() + "'"},
                picture,
                {}};
    }
    static bool never() { return false; }

    ScratchFolder scratch = std::move(*ScratchFolder::make());
};

TEST_F(PictureRaceTest, MeasuresEachAgainstTheReference) {
    const PictureChoice choices[] = {gray("right", "500 500 500 0 0 0"),
                                     gray("wrong", "500 500 500 0 300 0")};
    const Result<PictureRace> race =
        race_pictures(gray("reference", "500 500 500 0 0 0"), choices, 3, never);
    ASSERT_TRUE(bool(race)) << race.error().message;
    EXPECT_TRUE(race->complete);
    ASSERT_EQ(race->choices.size(), 2u);
    EXPECT_EQ(race->choices[0].rmse, 0);
    EXPECT_NEAR(race->choices[1].rmse, 0.3 / std::sqrt(6), 1e-5);
    EXPECT_EQ(race->choices[1].seconds.size(), 3u);
    EXPECT_FALSE(race->choices[1].host_peak_bytes) << "of another program nobody knows";
    EXPECT_THAT(picture_table(*race), testing::HasSubstr("wrong"));
    const Json json = picture_json(race->choices[1]);
    EXPECT_EQ(json["wall_seconds"].size(), 3u);
    EXPECT_TRUE(json["bytes_in"].is_null());
}

TEST_F(PictureRaceTest, SaysWhatIsWrong) {
    const PictureChoice reference = gray("reference", "500 500 500 0 0 0");
    const PictureChoice small[] = {gray("small", "5 5 5", 1)};
    const Result<PictureRace> sizes = race_pictures(reference, small, 1, never);
    ASSERT_FALSE(sizes);
    EXPECT_EQ(sizes.error().message, "small drew 1 x 1 pixels, expected 2 x 1");
    const PictureChoice broken[] = {
        {"broken", {"sh", "-c", "echo no light >&2; exit 1"}, scratch.path() / "none.ppm", {}}};
    const Result<PictureRace> failed = race_pictures(reference, broken, 1, never);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "broken failed: no light");
}

TEST_F(PictureRaceTest, KeepsWhatWasDrawnBeforeItWasStopped) {
    const PictureChoice choices[] = {gray("first", "5 5 5 5 5 5"), gray("second", "5 5 5 5 5 5")};
    const auto stop = [&] { return std::filesystem::exists(choices[1].picture); };
    const Result<PictureRace> race =
        race_pictures(gray("reference", "5 5 5 5 5 5"), choices, 1, stop);
    ASSERT_TRUE(bool(race)) << race.error().message;
    EXPECT_FALSE(race->complete);
    EXPECT_EQ(race->choices[0].seconds.size(), 1u);
    EXPECT_TRUE(race->choices[1].seconds.empty());
    EXPECT_TRUE(picture_json(race->choices[1])["seconds"].is_null());
    EXPECT_THAT(picture_table(*race), testing::Not(testing::HasSubstr("second")));
}

} // namespace
} // namespace ovc
