// SPDX-License-Identifier: Apache-2.0
// Pictures of Debian's tachyon with Overcast beside those without, pixel by pixel.
#include "plugin/hosts/tachyon/test_scenes.h"
#include "tests/real_data.h"
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace ovc::tachyon {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_shell;
using testing::HasSubstr;
using testing::Not;

const std::string kOurs = OVC_BINARY_DIR "/bin/overcast-tachyon";

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class TachyonHost : public testing::Test {
protected:
    void SetUp() override {
        if (run_shell("command -v tachyon").exit_code != 0)
            GTEST_SKIP() << "tachyon is not installed";
        folder_ = fs::temp_directory_path() /
                  (std::string("overcast_tachyon_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override {
        if (!folder_.empty() && !HasFailure())
            fs::remove_all(folder_);
    }

    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }

    CommandResult draw(const std::string& program, const std::string& arguments,
                       const std::string& picture) {
        return run_shell(program + " -fullshade " + arguments + " -format PPM -o " +
                         (folder_ / picture).string());
    }

    /// Draws the scene with both; the pictures must be the same bytes. What ours said.
    std::string expect_same(const std::string& arguments) {
        const CommandResult plain = draw("tachyon", arguments, "plain.ppm");
        EXPECT_EQ(plain.exit_code, 0) << plain.output;
        const CommandResult ours = draw(kOurs, arguments, "ours.ppm");
        EXPECT_EQ(ours.exit_code, 0) << ours.output;
        EXPECT_GT(bytes_of(folder_ / "plain.ppm").size(), 64u * 64u * 3u);
        EXPECT_TRUE(bytes_of(folder_ / "plain.ppm") == bytes_of(folder_ / "ours.ppm"))
            << folder_ << " has both pictures";
        return ours.output;
    }

    fs::path folder_;
};

const std::string kBalls = ball(Kind::Flat, "plain", -0.7, -0.2, 0.3, 0.6) +
                           ball(Kind::Smooth, "checker", 0.7, -0.1, 0.4, 0.7) +
                           ball(Kind::Colored, "", 0.1, -0.6, -0.8, 0.4);

TEST_F(TachyonHost, FlatSmoothAndColoredTrianglesLookTheSame) {
    const std::string said = expect_same(write("balls.dat", scene(kBalls)) + " -numthreads 2");
    EXPECT_THAT(said, HasSubstr("Overcast: 672 triangles in "));
}

TEST_F(TachyonHost, GlassFiltersLightAsOftenAsTachyonSays) {
    const std::string balls = ball(Kind::Flat, "glass", -0.5, -0.1, -0.4, 0.7) +
                              ball(Kind::Smooth, "glass", 0.5, -0.2, 0.2, 0.7) + kBalls;
    const std::string path = write("glass.dat", scene(balls));
    for (const char* options :
         {"", " -shadow_filter_off", " -trans_vmd", " -trans_raster3d", " -trans_max_surfaces 2"})
        expect_same(path + " -numthreads 2" + options);
}

TEST_F(TachyonHost, MirrorsFogAndClippingPlanesStayTachyons) {
    expect_same(write("mirror.dat", scene(ball(Kind::Smooth, "mirror", 0.4, 0, 0, 0.8) + kBalls)));
    expect_same(write("fog.dat", scene(kBalls, "FOG LINEAR START 3 END 6 DENSITY 1 COLOR 1 1 1")));
    expect_same(write("clipped.dat",
                      scene("START_CLIPGROUP NUMPLANES 1 0 1 0 0.1\n" + kBalls + "END_CLIPGROUP\n" +
                            ball(Kind::Smooth, "plain", 0, 0.5, 1.5, 0.6))));
}

TEST_F(TachyonHost, CamerasSamplesAndSkylightStayTachyons) {
    expect_same(write("fisheye.dat", scene(kBalls, "", "PROJECTION FISHEYE ZOOM 1")));
    expect_same(write("parallel.dat", scene(kBalls, "", "PROJECTION ORTHOGRAPHIC ZOOM 0.6")));
    expect_same(write("samples.dat", scene(kBalls, "", "ZOOM 1.2", /* antialiasing= */ 3)));
    expect_same(write("skylight.dat", scene(kBalls)) + " -auto_skylight 0.7 -skylight_samples 4");
}

TEST_F(TachyonHost, EveryShaderAndThreadCountGivesTachyonsPicture) {
    const std::string path = write("balls.dat", scene(kBalls));
    for (const char* options : {" -numthreads 1", " -numthreads 16", " -numthreads 2 -mediumshade",
                                " -numthreads 2 -lowshade", " -numthreads 2 -nobounding"})
        expect_same(path + options);
}

// Both kinds of order among equally near triangles: Tachyon's list, and its grid's cells.
TEST_F(TachyonHost, OfCoincidingTrianglesTheOneThatTachyonSeesIsSeen) {
    const std::string above = "TRI V0 -2 -0.9 -1 V1 2 -0.9 -1 V2 0 -0.9 3 ";
    const std::string turned = "TRI V0 0 -0.9 3 V1 2 -0.9 -1 V2 -2 -0.9 -1 ";
    const std::string pair = above + "plain\n" + turned + "mirror\n" + above + "glass\n";
    expect_same(write("listed.dat", scene(pair)));
    expect_same(write("gridded.dat", scene(pair + kBalls)));
    const std::string glass = above + "glass\n" + turned + "glass\n";
    expect_same(write("filtered_twice.dat", scene(glass + kBalls)));
    std::string pane;
    for (int i = 0; i < 6; ++i)
        pane += glass;
    expect_same(write("filtered_often.dat", scene(pane + kBalls)));
}

// A camera above a sheet whose sides run straight away from it: rays along them pass within a
// rounding error, where Tachyon's test finds the one triangle or the other, and no ray slips
// through. Which of the two it sees first is up to its grid, so both have one color here.
TEST_F(TachyonHost, RaysAlongSidesFindATriangleWhereTachyonFindsOne) {
    const auto corner = [](int x, int z) {
        return std::to_string(x) + " " +
               std::to_string(-0.9 + 0.0137 * ((x * x * 7 + z * z * 3) % 11)) + " " +
               std::to_string(2 * z) + " ";
    };
    std::string sheet;
    for (int x = -8; x < 8; ++x)
        for (int z = -4; z < 8; ++z) {
            const std::string a = corner(x, z), b = corner(x + 1, z), c = corner(x, z + 1),
                              d = corner(x + 1, z + 1);
            sheet += "TRI V0 " + a + "V1 " + b + "V2 " + c + "plain\n";
            sheet += "TRI V0 " + b + "V1 " + d + "V2 " + c + "plain\n";
        }
    std::string text = scene(sheet);
    const std::string camera = "CENTER 0.3 1.1 -4 VIEWDIR -0.07 -0.25 1";
    text.replace(text.find(camera), camera.size(), "CENTER 4 1.1 -8 VIEWDIR -1 0 2");
    expect_same(write("sheet.dat", text) + " -lowshade -res 256 256");
}

TEST_F(TachyonHost, FieldOfInstancesLooksTheSame) {
    std::string field;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            field += ball(Kind::Smooth, (i + j) % 3 ? "plain" : "mirror", 0.37 * (i - 4), -0.8,
                          0.41 * j - 1, 0.17);
    EXPECT_THAT(expect_same(write("field.dat", scene(field)) + " -numthreads 2"),
                HasSubstr("Overcast: 18144 triangles"));
}

TEST_F(TachyonHost, StanfordModelsLookTheSame) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const CommandResult compared = run_shell(
        OVC_PYTHON " " OVC_SOURCE_DIR "/plugin/hosts/tachyon/compare.py --build " OVC_BINARY_DIR
                   " --size 256 --runs 0 --meshes " +
        (*data / "meshes").string());
    EXPECT_EQ(compared.exit_code, 0) << compared.output;
    for (const char* drawn :
         {"| dragon | 871306 | overcast-tachyon |", "| bunny | 69451 |", "| field | 586836 |"})
        EXPECT_THAT(compared.output, HasSubstr(drawn));
}

TEST_F(TachyonHost, SceneWithoutTrianglesIsTachyonsAlone) {
    EXPECT_THAT(expect_same(write("none.dat", scene(""))), Not(HasSubstr("Overcast:")));
}

TEST_F(TachyonHost, LandscapesWhoseCornersAreNoFloatsLookTheSame) {
    // Tachyon draws its height by rand(), seeded alike in each run.
    const std::string scape = "SCAPE RES 21 21 SCALE 6 6 CENTER 0 -0.7 1 plain\n";
    EXPECT_THAT(expect_same(write("scape.dat", scene(scape + kBalls))),
                HasSubstr("Overcast: 1472 triangles in "));
}

TEST_F(TachyonHost, OtherLanguagesOfTachyonsAreRead) {
    expect_same(write("patch.nff", R"(b 0.1 0.2 0.3
v
from 0.3 1.1 -4
at 0 0 0
up 0 1 0
angle 45
hither 1
resolution 64 64
l -4 6 -5
f 0.9 0.7 0.5 0.7 0.3 20 0 1
p 4
-1 -1 -1
-1 -1 1
1 -1 1
1 -1 -1
pp 3
-0.5 -0.5 0 0 0 -1
0.5 -0.5 0.3 0.3 0 -1
0 0.7 0 0 0.3 -1
s 0.5 0.2 0.5 0.3
)"));
}

TEST_F(TachyonHost, EveryFrameOfAnAnimationIsTachyons) {
    const std::string path = write("balls.dat", scene(kBalls));
    const std::string camera = write("fly.cam", "0 -0.2 1  0 1 0  0.3 1.0 -4\n"
                                                "0.2 -0.1 1  0 1 0  -0.3 0.8 -4\n");
    for (const std::string& program : {std::string("tachyon"), kOurs}) {
        const std::string name = program == kOurs ? "ours%d.ppm" : "plain%d.ppm";
        const CommandResult drawn = draw(program, path + " -camfile " + camera, name);
        ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    }
    for (const char* number : {"0", "1"}) {
        const std::string plain = bytes_of(folder_ / (std::string("plain") + number + ".ppm"));
        EXPECT_GT(plain.size(), 64u * 64u * 3u);
        EXPECT_TRUE(plain == bytes_of(folder_ / (std::string("ours") + number + ".ppm"))) << number;
    }
}

TEST_F(TachyonHost, SeveralScenesInOneRunAreEachTachyons) {
    const std::string scenes = write("a.dat", scene(kBalls)) + " " +
                               write("b.dat", scene(ball(Kind::Flat, "glass", 0, 0, 0, 0.9)));
    for (const std::string& program : {std::string("tachyon"), kOurs}) {
        const std::string name = program == kOurs ? "ours%d.ppm" : "plain%d.ppm";
        const CommandResult drawn = draw(program, scenes, name);
        ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    }
    for (const char* number : {"0", "1"})
        EXPECT_TRUE(bytes_of(folder_ / (std::string("plain") + number + ".ppm")) ==
                    bytes_of(folder_ / (std::string("ours") + number + ".ppm")))
            << number;
}

TEST_F(TachyonHost, PictureIsTheSameUnderASmallBudget) {
    expect_same(write("balls.dat", scene(kBalls)) + " -numthreads 2");
    const CommandResult small =
        draw(kOurs + " --gpu-memory 2M --device llvmpipe", folder_ / "balls.dat", "small.ppm");
    EXPECT_EQ(small.exit_code, 0) << small.output;
    EXPECT_TRUE(bytes_of(folder_ / "ours.ppm") == bytes_of(folder_ / "small.ppm"));
}

TEST_F(TachyonHost, WhatCannotBeIsOneSentenceAndNoPicture) {
    const std::string path = write("balls.dat", scene(kBalls));
    struct Case {
        const char* before;
        const char* sentence;
    };
    for (const Case& c : {
             Case{" --gpu-memory 12X",
                  "--gpu-memory 12X is no number of bytes; expected such as 256M"},
             Case{" --gpu-memory -1", "--gpu-memory -1 is no number of bytes"},
             Case{" --gpu-memory 1", "overcast: "},
             Case{" --device nobody", "nobody"},
         }) {
        const CommandResult drawn = draw(kOurs + c.before, path, "none.ppm");
        EXPECT_EQ(drawn.exit_code, 1) << c.before << drawn.output;
        EXPECT_THAT(drawn.output, HasSubstr(c.sentence));
        EXPECT_FALSE(fs::exists(folder_ / "none.ppm"));
    }
    const fs::path colon = folder_ / "a:b";
    fs::create_directory(colon);
    fs::copy(kOurs, colon);
    fs::copy(OVC_BINARY_DIR "/bin/libovercast_tachyon.so", colon);
    const CommandResult apart = draw(colon / "overcast-tachyon", path, "none.ppm");
    EXPECT_EQ(apart.exit_code, 1) << apart.output;
    EXPECT_THAT(apart.output, HasSubstr("in a folder without colons and semicolons"));
    const CommandResult nothing = run_shell(kOurs + " --device");
    EXPECT_EQ(nothing.exit_code, 1);
    EXPECT_THAT(nothing.output, HasSubstr("--device is followed by nothing"));
    const CommandResult absent = run_shell("PATH=/nowhere " + kOurs + " " + path);
    EXPECT_EQ(absent.exit_code, 1);
    EXPECT_THAT(absent.output, HasSubstr("cannot run tachyon"));
}

TEST_F(TachyonHost, ErrorsOfTachyonsOwnStayItsOwn) {
    const CommandResult plain = draw("tachyon", folder_ / "absent.dat", "a.ppm");
    const CommandResult ours = draw(kOurs, folder_ / "absent.dat", "b.ppm");
    EXPECT_EQ(plain.exit_code, ours.exit_code);
    EXPECT_EQ(plain.output, ours.output);
}

} // namespace
} // namespace ovc::tachyon
