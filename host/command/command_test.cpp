// SPDX-License-Identifier: Apache-2.0
// Tests of the command as a whole, on the CPU: what it writes, and that an error writes nothing.
#include "host/command/command.h"
#include "host/terminal/interrupt.h"
#include "tests/temp_folder.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

namespace ovc {

namespace fs = std::filesystem;

class CommandTest : public testing::Test {
protected:
    std::string path(const char* name) const { return (folder_ / name).string(); }

    /// Returns the sentence with which the command fails; empty when it does not fail.
    static std::string error(const Arguments& arguments) {
        const Result<int> code = run_command(arguments);
        return code ? "" : code.error().message;
    }

    std::string bytes(const char* name) const { return folder_.read(name); }

    test::TempFolder folder_;
};

TEST_F(CommandTest, RendersATestSceneToTwoFilesAndStatistics) {
    const Result<int> code =
        run_command({"render", "box", "--backend", "cpu-kdtree", "+W40", "+H30", "-o",
                     path("a.png"), "+O" + path("a.exr"), "--stats", path("a.json"), "--quiet"});
    ASSERT_TRUE(code) << code.error().message;
    EXPECT_EQ(*code, kExitOk);
    EXPECT_TRUE(fs::exists(path("a.png")));
    EXPECT_TRUE(fs::exists(path("a.exr")));
    std::ifstream file(path("a.json"));
    const nlohmann::json stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats["rays"]["primary"], 1200);
    EXPECT_EQ(stats["triangles"], 30);
    EXPECT_EQ(stats["complete"], true);
}

TEST_F(CommandTest, ConvertsATestSceneAndReadsItBack) {
    ASSERT_EQ(error({"convert", "box", path("box.ply")}), "");
    EXPECT_EQ(error({"render", path("box.ply"), "--backend", "cpu-kdtree", "--size", "8x8", "-o",
                     path("box.png"), "--quiet"}),
              "");
    EXPECT_TRUE(fs::exists(path("box.png")));
}

TEST_F(CommandTest, SeveralFilesAreOneScene) {
    std::ofstream(path("a.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(path("b.obj")) << "v 0 0 5\nv 1 0 5\nv 0 1 5\nf 1 2 3\nf 3 2 1\n";
    ASSERT_EQ(error({"convert", path("a.obj"), path("b.obj"), "box", path("all.obj")}), "");
    testing::internal::CaptureStdout();
    ASSERT_EQ(error({"info", path("all.obj"), "--json"}), "");
    EXPECT_EQ(nlohmann::json::parse(testing::internal::GetCapturedStdout())["triangles"], 33);
    ASSERT_EQ(error({"render", path("a.obj"), path("b.obj"), "--backend", "cpu-kdtree", "--size",
                     "8x8", "-o", path("a.png"), "--stats", path("a.json"), "--quiet", "--cache",
                     path("cache")}),
              "");
    std::ifstream file(path("a.json"));
    const nlohmann::json stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats["triangles"], 3);
    EXPECT_EQ(stats["scene"], path("a.obj") + " + " + path("b.obj"));
    EXPECT_THAT(error({"info", path("a.obj"), path("none.obj")}), testing::HasSubstr("none.obj"));
    EXPECT_THAT(error({"render", path("a.obj"), path("b.obj"), "-o", path("b.obj")}),
                testing::HasSubstr("ends in neither"));
    EXPECT_THAT(error({"convert", path("a.obj"), path("b.obj"), path("b.obj")}),
                testing::HasSubstr("are the same file"));
}

TEST_F(CommandTest, ZMayBeUp) {
    // Seen from above a floor in z = 0 hides what is below.
    std::ofstream(path("floor.obj")) << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    const auto render = [&](const char* up, const char* picture) {
        return error({"render", path("floor.obj"), "--backend", "cpu-kdtree", "--size", "16x16",
                      "--up", up, "-o", path(picture), "--quiet"});
    };
    ASSERT_EQ(render("y", "y.png"), "");
    ASSERT_EQ(render("z", "z.png"), "");
    EXPECT_NE(bytes("y.png"), bytes("z.png"));
    EXPECT_THAT(render("w", "w.png"), testing::HasSubstr("--up: 'w' is none of x, y, z"));
    EXPECT_THAT(error({"render", "dragons-2", "--frames", "0", "--up", "z"}),
                testing::HasSubstr("--up and a camera path cannot be given together"));
}

TEST_F(CommandTest, OneOfSeveralWorldsIsChosen) {
    const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]";
    std::ofstream(path("a.pbrt")) << "WorldBegin " << triangle << " WorldEnd WorldBegin "
                                  << triangle << "\n"
                                  << triangle << " WorldEnd";
    testing::internal::CaptureStdout();
    ASSERT_EQ(error({"info", path("a.pbrt"), "--world", "2", "--json"}), "");
    EXPECT_EQ(nlohmann::json::parse(testing::internal::GetCapturedStdout())["triangles"], 2);
    EXPECT_THAT(error({"info", path("a.pbrt"), "--world", "3"}),
                testing::HasSubstr("found 2 worlds, expected 3"));
    EXPECT_THAT(error({"info", path("a.pbrt"), "--world", "0"}),
                testing::HasSubstr("--world needs a whole number from 1"));
}

TEST_F(CommandTest, AFileThatIsNotThereMayBeMisspelt) {
    std::ofstream(path("dragon.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* name : {"dragn.obj", "dragonobj", "Dragon.obj"})
        EXPECT_THAT(error({"info", path(name)}), testing::HasSubstr("did you mean 'dragon.obj'?"))
            << name;
    std::ofstream(path("walk.csv")) << "0,0,9,0,0,0\n";
    EXPECT_THAT(error({"render", "box", "--camera-path", path("wlak.csv")}),
                testing::HasSubstr("did you mean 'walk.csv'?"));
    std::ofstream(path("one.png")) << "x";
    testing::internal::CaptureStderr();
    error({"diff", path("onne.png"), path("one.png")}); // diff prints its errors itself
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::HasSubstr("did you mean 'one.png'?"));
}

TEST_F(CommandTest, NamesReachTheTerminalPrintable) {
    const char* name = "a\n\033[31mred\xc2\x9b"
                       "2Jö.obj";
    std::ofstream(path(name)) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \033[2J\nf 1 2 3\nf 1 2\n";
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    ASSERT_EQ(error({"render", path(name), "--backend", "cpu-kdtree", "--size", "8x8", "-o",
                     path("\033.png")}),
              "");
    ASSERT_EQ(error({"info", path(name)}), "");
    const std::string all =
        testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    EXPECT_THAT(all, testing::HasSubstr("a\\n\\x1b[31mred\\u009b2Jö.obj"));
    EXPECT_THAT(all, testing::HasSubstr("faces with fewer than three corners left out"));
    EXPECT_THAT(all, testing::HasSubstr("'\\x1b[2J'"));
    EXPECT_THAT(all, testing::HasSubstr("wrote      "));
    EXPECT_EQ(all.find('\033'), std::string::npos) << all;
    EXPECT_EQ(all.find("\xc2\x9b"), std::string::npos) << all;
}

/// Arguments that are refused, and a part of the sentence that says why.
struct Refused {
    Arguments arguments;
    const char* part;
};

/// path: of a file in an empty folder.
std::vector<Refused> refused_arguments(const std::string& folder,
                                       const std::function<std::string(const char*)>& path) {
    const std::string out = path("out.png");
    return {
        {{}, "no command given"},
        {{"rendr"}, "did you mean 'render'?"},
        {{"render"}, "SCENE is required"},
        {{"render", path("none.ply"), "-o", out}, "none.ply"},
        {{"render", folder, "-o", out}, "is a directory"},
        {{"render", "bxo", "-o", out}, "bxo"},
        {{"render", "box", "-o", path("no/out.png")}, "does not exist"},
        {{"render", "box", "-o", path("out.tiff")}, "neither .png nor .exr"},
        {{"render", "box", "-o", out, "--stats", path("no/s.json")}, "does not exist"},
        {{"render", "box", "-o", out, "--gpu-memory", "abc"},
         "--gpu-memory: 'abc' is no memory size"},
        {{"render", "box", "-o", out, "--size", "40"}, "--size needs WIDTHxHEIGHT"},
        {{"render", "box", "-o", out, "--camera", "1,2"}, "--camera needs"},
        {{"render", "box", "-o", out, "--light", "-1"}, "--light needs x,y,z"},
        {{"render", "box", "-o", out, "--max-depth", "-1"}, "--max-depth needs"},
        {{"render", "box", "-o", out, "--backend", "gpu-gird"}, "did you mean 'gpu-grid'?"},
        {{"render", "box", "-o", out, "--backend", "embree", "--leaves", "4"}, "means nothing"},
        {{"render", "box", "-o", out, "--level1", "grid"},
         "--level1 means nothing to the backend auto; thesis-two-level has it"},
        {{"render", "box", "-o", out, "--backend", "thesis-two-level", "--level1", "kdtree"},
         "--level1: 'kdtree' is none of kd, grid, bvh"},
        {{"render", "box", "-o", out, "--backend", "thesis-two-level", "--level1", "grid",
          "--level1-build", "bottom-up"},
         "a grid is built top-down"},
        {{"render", "box", "-o", out, "--frames", "1:2"}, "box has no camera path"},
        {{"render", path("a.ply"), "-o", out, "--frames", "0"},
         "a.ply' has no camera path, and nothing in it moves"},
        {{"render", "cloth", "-o", out, "--frames", "1:2"},
         "no place for the number of each of 2 frames"},
        {{"render", "cloth", "-o", path("##.png"), "--frames", "1:1000000"},
         "there is no frame 1000000; a scene that moves has frames 0 to 999999"},
        {{"render", "dragons-22", "-o", out, "--frames", "0"}, "must be from 1 to 21"},
        {{"render", "dragons-2", "-o", out, "--frames", "0:1"},
         "no place for the number of each of 2 frames"},
        {{"render", "dragons-2", "-o", out, "--frames", "7:107"}, "there is no frame 107"},
        {{"render", "dragons-2", "-o", path("no/##.png"), "--frames", "7:8"}, "does not exist"},
        {{"render", "dragons-2", "--frames", "0", "--camera", "0,0,1,0,0,0"}, "given together"},
        {{"render", "box", "--camera-path", "a.csv", "--camera", "0,0,1,0,0,0"},
         "--camera and --camera-path cannot be given together"},
        {{"render", "box", "-o", out, "--camera-path", path("none.csv")}, "none.csv"},
        {{"render", "box", "-o", out, "--model", "a.ply"}, "not with 'box'"},
        {{"info", path("b.ply"), "--model", "a.ply"}, "--model goes with the test scenes"},
        {{"trace", "dragons-1", "--model", path("none.ply")}, "none.ply"},
        {{"render", "box", "-o", out, "--backend", "cpu-kdtree", "--leaves", "4"}, "means nothing"},
        {{"render", "box", "-o", out, "--camera", "0,0,1e101,0,0,0"}, "within 1e+100"},
        {{"render", "box", "-o", out, "--stats", ""}, "--stats needs a value"},
        {{"render", "box", "-o", out, "--device", ""}, "--device needs a value"},
        {{"render", "box", "-o", ""}, "--output needs a value"},
        {{"render", "box", "-o", out, "--quiet=maybe"}, "--quiet takes no value"},
        {{"info", path("none.obj")}, "none.obj"},
        {{"trace", path("none.obj")}, "none.obj"},
        {{"convert", path("a.ply")}, "OUT is required"},
        {{"convert", "box", path("box.stl")}, "ends in none of .ply, .obj, .ovc"},
        {{"convert", "box", path("no/box.ply")}, "does not exist"},
        {{"render", "box", "-o", out, "--jitter", "2"}, "--jitter"},
    };
}

TEST_F(CommandTest, AnErrorIsOneSentenceAndWritesNothing) {
    const auto cases =
        refused_arguments(fs::path(folder_).string(), [&](const char* name) { return path(name); });
    for (const auto& c : cases) {
        const std::string sentence = error(c.arguments);
        EXPECT_THAT(sentence, testing::HasSubstr(c.part));
        EXPECT_THAT(sentence, testing::Not(testing::HasSubstr("\n")));
        EXPECT_TRUE(folder_.file_count() == 0) << c.part;
    }
}

/// Returns arguments that render dragons-2 with a model small enough for a test.
static Arguments small_dragons(const std::string& model, const std::string& output,
                               const char* size = "32x32") {
    return {"render", "dragons-2", "--model", model, "--backend",
            "embree", "--size",    size,      "-o",  output};
}

TEST_F(CommandTest, RendersFramesOfThePathWithStatisticsOfEach) {
    const std::string model = path("model.ply");
    ASSERT_EQ(error({"convert", "sphere-2", model, "--quiet"}), "");
    Arguments arguments = small_dragons(model, path("d-###.png"));
    arguments.insert(arguments.end(),
                     {"--frames", "0:60:30", "--stats", path("s.json"), "--quiet"});
    ASSERT_EQ(error(arguments), "");
    for (const char* name : {"d-000.png", "d-030.png", "d-060.png"})
        EXPECT_TRUE(fs::exists(path(name))) << name;
    std::ifstream file(path("s.json"));
    const nlohmann::json stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats["triangles"], 204800 + 2 * 320);
    ASSERT_EQ(stats["frames"].size(), 3u);
    uint64_t shadow = 0;
    for (const nlohmann::json& frame : stats["frames"]) {
        EXPECT_EQ(frame["complete"], true);
        EXPECT_EQ(frame["rays"]["primary"], 1024);
        shadow += frame["rays"]["shadow"].get<uint64_t>();
    }
    EXPECT_EQ(stats["frames"][2]["frame"], 60);
    EXPECT_EQ(stats["rays"]["primary"], 3 * 1024);
    EXPECT_EQ(stats["rays"]["shadow"], shadow);

    // The same frame alone, and from a file, is the same picture.
    Arguments alone = small_dragons(model, path("alone.png"));
    alone.insert(alone.end(), {"--frames", "30", "--quiet"});
    ASSERT_EQ(error(alone), "");
    EXPECT_EQ(bytes("alone.png"), bytes("d-030.png"));
    EXPECT_NE(bytes("d-000.png"), bytes("d-030.png"));
    const Camera camera = test_scene_path("dragons-2")->at(30);
    std::ofstream(path("path.csv"))
        << fmt::format("{},{},{},{},{},{}\n", camera.eye.x, camera.eye.y, camera.eye.z,
                       camera.target.x, camera.target.y, camera.target.z);
    Arguments from_file = small_dragons(model, path("file-#.png"));
    from_file.insert(from_file.end(), {"--camera-path", path("path.csv"), "--quiet"});
    ASSERT_EQ(error(from_file), "");
    EXPECT_EQ(bytes("file-0.png"), bytes("d-030.png"));
}

TEST_F(CommandTest, AnInterruptedSequenceKeepsItsFinishedFrames) {
    const std::string model = path("model.ply");
    ASSERT_EQ(error({"convert", "sphere-2", model, "--quiet"}), "");
    Arguments arguments = small_dragons(model, path("####.png"), "256x256");
    arguments.insert(arguments.end(), {"--frames", "0:99", "--stats", path("s.json"), "--quiet"});
    std::thread user([&] {
        while (!fs::exists(path("0001.png")))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::raise(SIGINT);
    });
    testing::internal::CaptureStderr();
    const Result<int> code = run_command(arguments);
    user.join();
    const std::string said = testing::internal::GetCapturedStderr();
    ASSERT_TRUE(code);
    EXPECT_EQ(*code, kExitInterrupted);
    std::ifstream file(path("s.json"));
    const nlohmann::json stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats["complete"], false);
    const size_t saved = stats["frames"].size();
    EXPECT_GE(saved, 2u);
    EXPECT_LT(saved, 100u);
    EXPECT_THAT(said, testing::HasSubstr(fmt::format(
                          "{} of 100 frames are saved, frame {} is the next", saved, saved)));
    const auto pictures = [&] {
        size_t count = 0;
        for (const auto& entry : fs::directory_iterator(folder_))
            count += entry.path().extension() == ".png";
        return count;
    };
    EXPECT_EQ(pictures(), saved);

    // --continue renders the rest, and leaves the files that are there.
    const auto first_written = fs::last_write_time(path("0000.png"));
    Arguments more = small_dragons(model, path("####.png"), "256x256");
    more.insert(more.end(), {"--frames", fmt::format("0:{}", saved + 1), "--quiet", "--continue"});
    ASSERT_EQ(error(more), "");
    EXPECT_EQ(pictures(), saved + 2);
    EXPECT_EQ(fs::last_write_time(path("0000.png")), first_written);
    const std::string next = fmt::format("{:04}.png", saved);
    Arguments alone = small_dragons(model, path("alone-####.png"), "256x256");
    alone.insert(alone.end(), {"--frames", fmt::format("{}", saved), "--quiet"});
    ASSERT_EQ(error(alone), "");
    EXPECT_EQ(bytes(next.c_str()), bytes(("alone-" + next).c_str()))
        << "perhaps begun by one run and ended by another";
}

TEST_F(CommandTest, DiffEndsAsIdiffDoes) {
    const std::string scenes[][2] = {{"box", "a"}, {"mirrors", "b"}};
    for (const auto& [scene, name] : scenes)
        ASSERT_EQ(error({"render", scene, "--backend", "cpu-kdtree", "--size", "24x18", "--quiet",
                         "--aov", "id", "-o", path((name + ".png").c_str()), "-o",
                         path((name + ".exr").c_str())}),
                  "");
    ASSERT_EQ(error({"render", "box", "--backend", "cpu-kdtree", "--size", "18x24", "--quiet", "-o",
                     path("turned.png")}),
              "");
    std::ofstream(path("text.png")) << "no picture";
    const auto diff = [&](Arguments words) {
        words.insert(words.begin(), "diff");
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int code = *run_command(words);
        std::fflush(stdout);
        testing::internal::GetCapturedStdout();
        testing::internal::GetCapturedStderr();
        return code;
    };
    const std::string a = path("a.png"), b = path("b.png");
    EXPECT_EQ(diff({a, a}), 0);
    EXPECT_EQ(diff({path("a.exr"), path("a.exr"), "--json"}), 0);
    EXPECT_EQ(diff({a, b, "--fail", "1"}), 1);
    EXPECT_EQ(diff({a, b}), 2);
    EXPECT_EQ(diff({a, path("a.exr"), "--fail", "0.002", "--warn", "0.002"}), 0)
        << "half a code, and what rounding adds";
    EXPECT_EQ(diff({a, path("turned.png")}), 3);
    EXPECT_EQ(diff({a, path("none.png")}), 4);
    EXPECT_EQ(diff({a, path("text.png")}), 4);
    EXPECT_EQ(diff({a}), 4);
    EXPECT_EQ(diff({a, b, "--fail", "little"}), 4);
    EXPECT_EQ(diff({a, b, "-o", a}), 4) << "no input is written over";
    EXPECT_EQ(diff({a, b, "-o", path("d.png"), "-q"}), 2);
    EXPECT_EQ(diff({path("a.exr"), path("b.exr"), "-o", path("d.exr")}), 2);
    EXPECT_THAT(bytes("d.exr"), testing::HasSubstr("id.prim"));
    EXPECT_EQ(diff({path("d.png"), a, "--fail", "2", "--warn", "2"}), 0);
}

TEST_F(CommandTest, ScenesListsCountsAndFrames) {
    testing::internal::CaptureStdout();
    ASSERT_EQ(error({"scenes"}), "");
    std::fflush(stdout);
    const std::string text = testing::internal::GetCapturedStdout();
    for (const char* part : {"dragons-N", "7,364,817", "12,748,510", "100 frames", "275 frames"})
        EXPECT_THAT(text, testing::HasSubstr(part));
}

TEST_F(CommandTest, WritesOverNeitherItsInputNorItself) {
    const std::string mesh = path("mesh.ply"), picture = path("d.png");
    ASSERT_EQ(error({"convert", "box", mesh, "--quiet"}), "");
    const Arguments cases[] = {{"render", mesh, "-o", picture, "--stats", mesh},
                               {"render", mesh, "-o", picture, "--stats", picture},
                               {"render", mesh, "-o", picture, "-o", folder_ / "." / "d.png"},
                               {"convert", mesh, mesh}};
    for (const Arguments& arguments : cases) {
        EXPECT_THAT(error(arguments), testing::EndsWith("are the same file"));
        EXPECT_FALSE(fs::exists(picture));
    }
}

TEST_F(CommandTest, EveryCommandHasHelpWithExamples) {
    for (const Command& command : commands()) {
        testing::internal::CaptureStdout();
        EXPECT_EQ(*run_command({std::string(command.name), "--help"}), kExitOk);
        std::fflush(stdout);
        EXPECT_THAT(testing::internal::GetCapturedStdout(),
                    testing::HasSubstr("overcast " + std::string(command.name)));
    }
}

/// Returns the text that a command prints on standard output.
static std::string printed(const Arguments& arguments) {
    testing::internal::CaptureStdout();
    EXPECT_TRUE(run_command(arguments));
    std::fflush(stdout);
    return testing::internal::GetCapturedStdout();
}

TEST_F(CommandTest, HelpAndVersionAreWordsToo) {
    EXPECT_EQ(printed({"help", "render"}), printed({"render", "--help"}));
    EXPECT_EQ(printed({"help"}), printed({"--help"}));
    EXPECT_THAT(error({"help", "rendr"}), testing::HasSubstr("did you mean 'render'?"));
    EXPECT_EQ(printed({"version"}), printed({"--version"}));
    EXPECT_EQ(printed({"-V"}), printed({"--version"}));
    EXPECT_THAT(printed({"--version"}),
                testing::ContainsRegex("\nwith(out)? libovercast-textures.so: surfaces show "
                                       ".*\nwith(out)? libovercast-mpi.so: processes "));
}

TEST_F(CommandTest, ConvertSaysWhatItLeavesOut) {
    testing::internal::CaptureStderr();
    ASSERT_EQ(error({"convert", "mirrors", path("a.ply")}), "");
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::AllOf(testing::HasSubstr("only triangles are kept; left out of "),
                               testing::HasSubstr(" material")));
    testing::internal::CaptureStderr();
    ASSERT_EQ(error({"convert", "mirrors", path("b.ply"), "--quiet"}), "");
    ASSERT_EQ(error({"convert", path("a.ply"), path("c.ply")}), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(CommandTest, InfoIsJsonForPrograms) {
    testing::internal::CaptureStdout();
    ASSERT_EQ(error({"info", "box", "--json"}), "");
    std::fflush(stdout);
    const nlohmann::json info = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    for (const char* key : {"triangles", "unique_triangles", "instances", "dropped", "bounds",
                            "meshes", "needs", "left_out", "plan"})
        EXPECT_TRUE(info.contains(key)) << key;
    EXPECT_EQ(info["triangles"], 30);
    EXPECT_EQ(info["bounds"]["min"].size(), 3u);
}

TEST_F(CommandTest, StrictMakesAnErrorOfWhatAPbrtSceneLacks) {
    std::ofstream(path("odd.pbrt"))
        << "WorldBegin\nShape \"sphere\"\nFurniture\nShape \"plymesh\" \"string filename\" "
           "\"none.ply\"\nWorldEnd\n";
    const std::string scene = path("odd.pbrt"), out = path("a.png");
    testing::internal::CaptureStderr();
    EXPECT_EQ(
        error({"render", scene, "--backend", "cpu-kdtree", "--size", "8x8", "-o", out, "--quiet"}),
        "");
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::AllOf(testing::HasSubstr("odd.pbrt:3: "), testing::HasSubstr("Furniture"),
                               testing::HasSubstr("none.ply")));
    fs::remove(out);
    for (const Arguments& arguments :
         {Arguments{"render", scene, "--strict", "-o", out}, Arguments{"info", "--strict", scene},
          Arguments{"convert", scene, path("a.ply"), "--strict"}})
        EXPECT_THAT(error(arguments), testing::AllOf(testing::HasSubstr("odd.pbrt:3: "),
                                                     testing::HasSubstr("Furniture")));
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(path("a.ply")));
}

TEST_F(CommandTest, MoreTrianglesThanAllowedAreRefusedWithTheirCount) {
    std::ofstream(path("two.pbrt")) << "WorldBegin\nShape \"sphere\"\nShape \"sphere\"\n"
                                       "WorldEnd\n"; // 1,520 triangles each
    const std::string scene = path("two.pbrt");
    EXPECT_EQ(error({"convert", scene, path("a.ply"), "--max-triangles", "3040"}), "");
    EXPECT_TRUE(fs::exists(path("a.ply")));
    EXPECT_THAT(error({"convert", scene, path("b.ply"), "--max-triangles", "3039"}),
                testing::AllOf(testing::HasSubstr("3040 triangles"),
                               testing::HasSubstr("at most 3039"),
                               testing::HasSubstr("--max-triangles")));
    EXPECT_FALSE(fs::exists(path("b.ply")));
    for (const char* wrong : {"0", "-1", "many", "4294967295"})
        EXPECT_THAT(error({"info", scene, "--max-triangles", wrong}),
                    testing::HasSubstr("--max-triangles needs a whole number from 1 to "));
}

TEST_F(CommandTest, RoundShapesAreCutAsFinelyAsAskedFor) {
    std::ofstream(path("ball.pbrt")) << "WorldBegin\nShape \"sphere\"\nWorldEnd\n";
    const std::string scene = path("ball.pbrt");
    EXPECT_EQ(error({"convert", scene, path("fine.ply"), "--tolerance", "0.001"}), "");
    EXPECT_EQ(error({"convert", scene, path("coarse.ply"), "--tolerance", "0.1"}), "");
    EXPECT_GT(fs::file_size(path("fine.ply")), 20 * fs::file_size(path("coarse.ply")));
    for (const char* wrong : {"0", "-0.1", "0.00009", "0.6", "fine", "nan", "0.1x"})
        EXPECT_EQ(error({"info", scene, "--tolerance", wrong}),
                  fmt::format("--tolerance needs a number from 0.0001 to 0.5, not '{}'", wrong));
}

TEST_F(CommandTest, ReportSaysWhichReportsThereAre) {
    EXPECT_EQ(error({"report"}), "the report needs a folder: overcast report -o DIR");
    EXPECT_EQ(error({"report", "--only", "error"}),
              "the report needs a folder: overcast report -o DIR");
    EXPECT_THAT(error({"report", "--only", "stabilty"}),
                testing::AllOf(testing::StartsWith("no report is called 'stabilty'; there are "),
                               testing::EndsWith("did you mean 'stability'?")));
    EXPECT_EQ(error({"report", "-o", path("r"), "--rays", "5"}),
              "--rays goes with --only stability, leaks or grid");
    EXPECT_EQ(error({"report", "--only", "leaks", "--scene", "box"}),
              "--scene goes with the page, not with --only stability, leaks or grid");
    EXPECT_EQ(error({"report", "--only", "leaks", "--rays", "1e-3"}),
              "--rays needs a whole number from 1 to 1e+12, such as 1e8, not '1e-3'");
    EXPECT_EQ(error({"report", "--only", "leaks", "--case", "teapot"}),
              "--case: no case of the report has 'teapot' in its name");
    EXPECT_EQ(error({"report", "--only", "leaks", "--times", "3"}),
              "--times means nothing to the report leaks; there is --rays");
    EXPECT_EQ(error({"report", "--only", "stability", "--rays", "3"}),
              "--rays means nothing to the report stability; there is --times");
    EXPECT_THAT(error({"report", "--only", "stability", "--kernel", "vertex"}),
                testing::HasSubstr("'vertex' is none of auto, fragment, compute"));
    EXPECT_THAT(error({"report", "--only", "stability", "--data", path("none")}),
                testing::HasSubstr("holds no meshes/stanford-dragon/dragon_vrip.ply"));
}

} // namespace ovc
