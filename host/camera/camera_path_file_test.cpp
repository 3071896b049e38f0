// SPDX-License-Identifier: Apache-2.0
// Tests of camera paths from files: both formats, and everything that can be wrong with them.
#include "host/camera/camera_path_file.h"

#include "host/camera/camera.h"

#include <gmock/gmock.h>

#include <fstream>
#include <random>
#include <unistd.h>

namespace ovc {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CameraPathFile : public testing::Test {
protected:
    void SetUp() override {
        file_ = fs::path(testing::TempDir()) / ("path_" + std::to_string(getpid()));
    }
    void TearDown() override { fs::remove(file_); }

    Result<CameraPath> load_text(const std::string& text) const {
        std::ofstream(file_, std::ios::binary) << text;
        return load_camera_path(file_);
    }
    /// Returns the error's sentence without the file's name; empty where the text is a path.
    std::string error(const std::string& text) const {
        const Result<CameraPath> path = load_text(text);
        if (path)
            return "";
        std::string sentence = path.error().message;
        EXPECT_THAT(sentence, testing::StartsWith(file_.string()));
        EXPECT_THAT(sentence, testing::Not(HasSubstr("\n")));
        return sentence.substr(std::min(sentence.size(), file_.string().size()));
    }

    fs::path file_;
};

TEST_F(CameraPathFile, LinesAreWhatTheOptionCameraTakes) {
    const Result<CameraPath> path = load_text("# a walk\nex,ey,ez,tx,ty,tz,fov\n\n1,2,3, 4,5,6\r\n"
                                              "  -1,2e3,.5,0,0,0,75\n# end");
    ASSERT_TRUE(path) << path.error().message;
    ASSERT_EQ(path->size(), 2u);
    EXPECT_EQ((*path)[0].eye, dvec3(1, 2, 3));
    EXPECT_EQ((*path)[0].target, dvec3(4, 5, 6));
    EXPECT_EQ((*path)[0].fov_degrees, 40);
    EXPECT_EQ((*path)[1].eye, dvec3(-1, 2000, 0.5));
    EXPECT_EQ((*path)[1].fov_degrees, 75);
}

TEST_F(CameraPathFile, JsonIsAListOfCameras) {
    const std::string list = R"([{"eye":[1,2,3],"target":[4,5,6]},
        {"eye":[0,0,1],"target":[0,0,0],"up":[0,0.5,1e-3],"fov":60.5}])";
    for (const std::string& text : {list, "\n {\"cameras\": " + list + "}"}) {
        const Result<CameraPath> path = load_text(text);
        ASSERT_TRUE(path) << path.error().message;
        ASSERT_EQ(path->size(), 2u);
        EXPECT_EQ((*path)[0].up, dvec3(0, 1, 0));
        EXPECT_EQ((*path)[1].up, dvec3(0, 0.5, 1e-3));
        EXPECT_EQ((*path)[1].fov_degrees, 60.5);
    }
}

TEST_F(CameraPathFile, WrongOnesAreAnsweredWithOneSentence) {
    const struct {
        const char* text;
        const char* sentence;
    } cases[] = {
        {"", "empty"},
        {"\n\n# nothing\n", "there is no camera in it"},
        {"[]", "there is no camera in it"},
        {"1,2,3,4,5,6\n1,2,3\n", ", line 2: a frame needs ex,ey,ez,tx,ty,tz"},
        {"1,2,3,4,5,6\nex,ey,ez,tx,ty,tz\n", ", line 2: a frame needs"},
        {"1,2,3,1,2,3", "looks from a point at itself"},
        {"1,2,3,4,5,nan", "a frame needs"},
        {"1,2,3,4,5,6,180", "between 0 and 180 degrees"},
        {"1e101,2,3,4,5,6", "within 1e+100"},
        {"{", "this is not JSON"},
        {"[{\"eye\":[1,2,3]", "this is not JSON"},
        {"{\"cameras\":3}", "expected a list of cameras"},
        {"{\"eye\":[1,2,3]}", "expected a list of cameras"},
        {"[7]", ", camera 0: it is not an object"},
        {"[{}]", ", camera 0: it has no \"eye\""},
        {"[{\"eye\":[1,2,3]}]", "it has no \"target\""},
        {"[{\"eye\":[1,2],\"target\":[0,0,0]}]", "its \"eye\" is not a list of three numbers"},
        {"[{\"eye\":[1,2,\"3\"],\"target\":[0,0,0]}]", "its \"eye\" is not"},
        {"[{\"eye\":[1,2,[3]],\"target\":[0,0,0]}]", "its \"eye\" is not"},
        {"[{\"eye\":[1,2,1e999],\"target\":[0,0,0]}]", "a number in it is too large"},
        {"[{\"eye\":[1,2,3],\"target\":[1,2,3]}]", "looks from a point at itself"},
        {"[{\"eye\":[1,2,3],\"target\":[0,0,0],\"up\":[0,0,0]}]", "has no direction"},
        {"[{\"eye\":[1,2,3],\"target\":[0,0,0],\"fov\":0}]", "between 0 and 180"},
        {"[{\"eye\":[1,2,3],\"target\":[0,0,0],\"fov\":\"wide\"}]", "its \"fov\" is not a number"},
        {"[{\"eye\":[1,2,3],\"target\":[0,0,0],\"angle\":7}]", "there is no \"angle\" in a camera"},
    };
    for (const auto& c : cases)
        EXPECT_THAT(error(c.text), HasSubstr(c.sentence)) << c.text;
    EXPECT_THAT(error("[" + std::string(100'000, '[')), HasSubstr("this is not JSON"));
    EXPECT_THAT(load_camera_path(file_.string() + "none").error().message,
                HasSubstr("no such file"));
    EXPECT_THAT(load_camera_path(testing::TempDir()).error().message, HasSubstr("directory"));
}

TEST_F(CameraPathFile, PassesOverTheMarkOfAByteOrder) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(error(mark + "ex,ey,ez,tx,ty,tz\n1,2,3,4,5,6\n"), "");
    EXPECT_EQ(error(mark + "[{\"eye\":[1,2,3],\"target\":[0,0,0]}]"), "");
}

/// A file that is cut or changed gives a path of usable cameras or a sentence, never anything else.
TEST_F(CameraPathFile, SurvivesWhatChanceMakesOfIt) {
    const std::string texts[] = {
        "ex,ey,ez,tx,ty,tz\n1,2,3,4,5,6\n-1,2e3,.5,0,0,0,75\n",
        R"({"cameras":[{"eye":[1,2,3],"target":[4,5,6],"up":[0,1,0],"fov":60}]})"};
    std::mt19937 random(1);
    const auto check = [&](const std::string& text) {
        const Result<CameraPath> path = load_text(text);
        if (!path) {
            EXPECT_FALSE(path.error().message.empty());
            return;
        }
        for (const Camera& camera : *path)
            EXPECT_TRUE(check_camera(camera)) << text;
    };
    for (const std::string& text : texts) {
        for (size_t length = 0; length < text.size(); ++length)
            check(text.substr(0, length));
        for (int round = 0; round < 200; ++round) {
            std::string changed = text;
            for (unsigned change = 0; change <= random() % 3; ++change)
                changed[random() % changed.size()] = char(random());
            check(changed);
        }
    }
}

} // namespace ovc
