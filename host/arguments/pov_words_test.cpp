// SPDX-License-Identifier: Apache-2.0
// Tests how POV-Ray's words are translated, and the errors for words that cannot be obeyed.
#include "host/arguments/pov_words.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

using testing::ElementsAre;

using Words = std::vector<std::string>;

Words translated(const Words& words) {
    const Result<Words> ours = translate_pov_words(words, {});
    return ours ? *ours : Words{"Error: " + ours.error().message};
}

TEST(PovWords, BecomeOurs) {
    EXPECT_THAT(translated({"a.ply", "+W640", "+H480", "+Oout.png"}),
                ElementsAre("a.ply", "-o", "out.png", "--size=640x480"));
    EXPECT_THAT(translated({"+O", "out.exr", "--quiet"}), ElementsAre("-o", "out.exr", "--quiet"));
    EXPECT_THAT(translated({"+Ia.pov", "+WT4", "+C", "-C", "+FN", "+FN16"}),
                ElementsAre("a.pov", "--threads=4", "--continue", "--png-bits=16"));
    EXPECT_THAT(translated({"+w8", "+h6", "+ia.pov"}), ElementsAre("a.pov", "--size=8x6"));
    EXPECT_THAT(translated({"+W640"}),
                ElementsAre("Error: +W and +H belong together; +H is missing"));
}

TEST(PovWords, OfAntialiasingAskForIt) {
    EXPECT_THAT(translated({"+A"}), ElementsAre("--antialias=0.3"));
    EXPECT_THAT(translated({"+A0.1", "+R4", "+AM2", "-J"}),
                ElementsAre("--antialias=0.1", "--antialias-method=2", "--antialias-depth=4",
                            "--jitter=0"));
    EXPECT_THAT(translated({"+A", "+J0.5"}), ElementsAre("--antialias=0.3", "--jitter=0.5"));
    EXPECT_THAT(translated({"+A", "-A"}), ElementsAre());
    EXPECT_THAT(translated({"+R4"}), ElementsAre());
}

TEST(PovWords, OfVersionsAreTheReaders) {
    EXPECT_THAT(translated({"+MV3.1", "a.pov"}), ElementsAre("--pov-version=3.1", "a.pov"));
}

TEST(PovWords, OfQualityLeaveOutShadowsThenMirrors) {
    EXPECT_THAT(translated({"+Q9"}), ElementsAre());
    EXPECT_THAT(translated({"+Q5"}), ElementsAre("--max-depth=0"));
    EXPECT_THAT(translated({"+Q3"}), ElementsAre("--no-shadows", "--max-depth=0"));
    EXPECT_THAT(translated({"+Q12"}).at(0), testing::HasSubstr("from 0 to 11"));
}

TEST(PovWords, ThatMeanNothingHereAreSaidToAndPassedOver) {
    std::string said;
    const LogSink log = [&](LogLevel, const std::string& message) { said += message + "\n"; };
    EXPECT_THAT(*translate_pov_words({"-D", "+P", "-GA", "+UV", "a.pov"}, log),
                ElementsAre("a.pov"));
    EXPECT_EQ(said, "-D means nothing here\n+P means nothing here\n-GA means nothing here\n"
                    "+UV means nothing here\n");
}

TEST(PovWords, OfFramesNumberThePictures) {
    EXPECT_THAT(translated({"+KFI5", "+KFF10", "+Oa.b/c.png", "-o", "d-###.exr"}),
                ElementsAre("-o", "a.b/c##.png", "-o", "d-###.exr", "--frames=5:10"));
    EXPECT_THAT(translated({"Final_Frame=9"}), ElementsAre("--frames=1:9"));
    EXPECT_THAT(translated({"+KFI5"}).at(0), testing::HasSubstr("+KFF is missing"));
}

TEST(PovWords, ThatCannotBeObeyedNameOurs) {
    EXPECT_THAT(translated({"+K0.5"}).at(0), testing::HasSubstr("+KFI1 +KFF25"));
    EXPECT_THAT(translated({"+KF2"}).at(0), testing::HasSubstr("runs from 0 to 1"));
    EXPECT_THAT(translated({"+SC0.5"}).at(0), testing::HasSubstr("--crop"));
    EXPECT_THAT(translated({"+FT"}).at(0), testing::HasSubstr(".png or .exr"));
    EXPECT_THAT(translated({"+Z"}).at(0),
                testing::HasSubstr("'+Z' is no word of POV-Ray's that is understood here"));
}

TEST(PovWords, JoinOptionsWhoseValueMayBeNegative) {
    EXPECT_THAT(translated({"--camera", "-.5,0,0,1,1,1", "--light", "-1,2,3"}),
                ElementsAre("--camera=-.5,0,0,1,1,1", "--light=-1,2,3"));
    EXPECT_THAT(translated({"-o", "-", "+"}), ElementsAre("-o", "-", "+"));
}

} // namespace
} // namespace ovc
