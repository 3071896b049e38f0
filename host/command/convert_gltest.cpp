// SPDX-License-Identifier: Apache-2.0
// overcast convert and render under a budget of host memory: pictures of the file are those of its
// source, and an error leaves nothing behind.
#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "host/terminal/interrupt.h"
#include "tests/file_size_limit.h"
#include "tests/temp_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class ConvertUnderABudget : public testing::Test {
protected:
    void SetUp() override {
        testing::internal::CaptureStdout();
        const bool has_device = bool(run_command({"devices"}));
        testing::internal::GetCapturedStdout();
        if (!has_device)
            GTEST_SKIP() << "no device for the plugin";
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    static std::string error(const Arguments& arguments) {
        const Result<int> code = run_command(arguments);
        return code ? "" : code.error().message;
    }

    std::string bytes(const std::string& name) const { return folder_.read(name); }

    /// Renders a scene and returns the bytes of its picture.
    std::string picture(const std::string& scene, const std::string& gpu_memory = "64M") const {
        EXPECT_EQ(error({"render", scene, "--size", "96x64", "--gpu-memory", gpu_memory, "-o",
                         path("picture.png"), "--quiet"}),
                  "");
        return bytes("picture.png");
    }

    test::TempFolder folder_;
};

TEST_F(ConvertUnderABudget, PicturesAreThoseOfTheSource) {
    // 100,000 triangles are too many to be built in memory within 48 MiB. Those of plants-1 share
    // few sides, and some reach far. A box is built in memory. As OBJ, they are several meshes.
    for (const std::string name :
         {"sphere-7.ply", "plants-1.ply", "box.ply", "powerplant-200000.obj"}) {
        const std::string source = path(name), file = path("a.ovc");
        const std::string scene = name.substr(0, name.find('.'));
        ASSERT_EQ(error({"convert", scene, source, "--quiet"}), "");
        ASSERT_EQ(error({"convert", source, file, "--host-memory", "48M"}), "");
        const std::string expected = picture(source);
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(picture(file), expected);
        EXPECT_EQ(picture(file, "8M"), expected);
    }
}

/// Holes, mirrors and instances ask rays for more than nearest hits, and shade what they hit.
TEST_F(ConvertUnderABudget, PicturesOfAFileOnTheDiskAreTheSame) {
    for (const std::string scene : {"plants-1", "leaf-canopy", "mirrors", "grass-in-wind"}) {
        const std::string file = path(scene + ".ovc");
        ASSERT_EQ(error({"convert", scene, file, "--leaves", "40"}), "");
        const std::string expected = picture(file);
        ASSERT_FALSE(expected.empty());
        for (const std::string gpu : {"256M", "8M"})
            for (const std::string host : {"1G", "16M"}) {
                SCOPED_TRACE(scene + ", GPU " + gpu + ", host " + host);
                EXPECT_EQ(error({"render", file, "--size", "96x64", "--gpu-memory", gpu,
                                 "--host-memory", host, "-o", path("disk.png"), "--quiet"}),
                          "");
                EXPECT_TRUE(bytes("disk.png") == expected);
            }
    }
}

TEST_F(ConvertUnderABudget, HostMemoryOfARenderingGoesWithOneSceneFile) {
    const auto refused = [&](Arguments arguments) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), {"-o", path("a.png"), "--quiet"});
        return error(arguments);
    };
    EXPECT_THAT(refused({"box", "--host-memory", "1G"}),
                testing::HasSubstr("--host-memory goes with one .ovc file"));
    EXPECT_THAT(refused({path("none.ovc"), "--host-memory", "1G"}),
                testing::HasSubstr("no such file"));
    EXPECT_THAT(refused({path("none.ovc"), "--host-memory", "50%"}),
                testing::HasSubstr("expected bytes, such as 2G"));
    EXPECT_THAT(refused({path("none.ovc"), "--host-memory", "1G", "--backend", "cpu-kdtree"}),
                testing::HasSubstr("--host-memory means nothing to the backend cpu-kdtree"));
    ASSERT_EQ(error({"convert", "box", path("box.ovc"), "--backend", "cpu-kdtree"}), "");
    EXPECT_THAT(refused({path("box.ovc"), "--host-memory", "1G"}),
                testing::HasSubstr("the file holds no levels"));
}

/// A scene of PBRT has lights, an exposure, hidden shapes, instances and holes as well.
TEST_F(ConvertUnderABudget, PicturesAreThoseOfAPbrtFile) {
    std::ofstream(path("a.pgm")) << "P2\n2 1\n255\n0 255\n";
    std::ofstream(path("ball.pbrt")) << "Shape \"sphere\" \"float radius\" 0.7\n";
    std::ofstream scene(path("a.pbrt"));
    scene << "LookAt 0 3 -9  0 0 0  0 1 0 Camera \"perspective\"\nWorldBegin\n"
             "LightSource \"point\" \"point from\" [3 9 -9] \"rgb I\" [50 50 50]\n"
             "ObjectBegin \"o\" Include \"ball.pbrt\" ObjectEnd\n"
             "AttributeBegin Translate 0 -2 0 ObjectInstance \"o\" AttributeEnd\n"
             "AttributeBegin AreaLightSource \"diffuse\" Translate 0 3 0 Shape \"disk\" "
             "AttributeEnd\n"
             "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.pgm\"\n"
             "AttributeBegin Translate 0 0 -3 Shape \"disk\" \"texture alpha\" \"t\" "
             "AttributeEnd\n";
    for (int i = 0; i < 16; ++i)
        scene << "Material \"matte\" \"rgb Kd\" [0.5 " << i << "e-2 0.9]\nAttributeBegin Translate "
              << i % 4 * 1.2 - 2 << " " << i / 4 * 1.2 - 2 << " " << i
              << " Include \"ball.pbrt\" AttributeEnd\n";
    scene.close();
    ASSERT_EQ(error({"convert", path("a.pbrt"), path("a.ovc"), "--tolerance", "5e-4",
                     "--host-memory", "48M"}),
              "");
    ASSERT_EQ(error({"convert", path("a.pbrt"), path("b.ovc"), "--tolerance", "5e-4"}), "");
    const std::string expected = picture(path("b.ovc"));
    ASSERT_FALSE(expected.empty());
    EXPECT_EQ(picture(path("a.ovc")), expected);
    EXPECT_EQ(picture(path("a.ovc"), "8M"), expected);
}

TEST_F(ConvertUnderABudget, AFileThatFitsIsTheSameAsWithoutABudget) {
    ASSERT_EQ(error({"convert", "sphere-3", path("a.ply"), "--quiet"}), "");
    ASSERT_EQ(error({"convert", path("a.ply"), path("a.ovc")}), "");
    ASSERT_EQ(error({"convert", path("a.ply"), path("b.ovc"), "--host-memory", "1G"}), "");
    EXPECT_EQ(bytes("a.ovc"), bytes("b.ovc"));
}

TEST_F(ConvertUnderABudget, ErrorsAreSentencesAndLeaveNothing) {
    ASSERT_EQ(error({"convert", "sphere-6", path("a.ply"), "--quiet"}), "");
    struct Case {
        Arguments arguments;
        const char* sentence;
    };
    const Case cases[] = {
        {{path("a.ply"), path("b.ovc"), "--host-memory", "100K"}, "works is 8388608"},
        {{path("a.ply"), path("b.ovc"), "--host-memory", "1M"},
         "1048576 bytes of host memory are too few for 81920 triangles"},
        {{path("a.ply"), path("b.ovc"), "--host-memory", "50%"}, "expected bytes, such as 2G"},
        {{path("a.ply"), path("b.ply"), "--host-memory", "1G"}, "goes with an output in .ovc"},
        {{path("a.ply"), "box", path("b.ovc"), "--host-memory", "1G"}, "one input alone"},
        {{"box", path("b.ovc"), "--host-memory", "1G"}, "inputs that stream"},
        {{"landscape-4001", path("b.ovc"), "--host-memory", "1G"}, "must be from 1 to 4000"},
        {{path("none.ply"), path("b.ovc"), "--host-memory", "1G"}, "no such file"},
    };
    for (const auto& [arguments, sentence] : cases) {
        Arguments all{"convert"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        EXPECT_THAT(error(all), testing::HasSubstr(sentence));
        EXPECT_EQ(folder_.file_count(), 1u) << sentence;
    }
}

/// It is full at any point of the conversion.
TEST_F(ConvertUnderABudget, AFullDiskIsASentenceAndLeavesNothing) {
    ASSERT_EQ(error({"convert", "sphere-7", path("a.ply"), "--quiet"}), "");
    for (const rlim_t most : {4u << 20, 13u << 20, 24u << 20}) {
        {
            const test::FileSizeLimit limit(most);
            EXPECT_THAT(error({"convert", path("a.ply"), path("b.ovc"), "--host-memory", "48M"}),
                        testing::EndsWith("File too large"))
                << most;
        }
        EXPECT_EQ(folder_.file_count(), 1u) << most;
    }
}

} // namespace
} // namespace ovc
