// SPDX-License-Identifier: Apache-2.0
// Runs the command as a user does, plugin and all. Bad input gets one sentence and writes nothing,
// and the picture does not depend on the budget.
#include "tests/real_data.h"
#include "tests/run_command.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CommandLine : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 ("overcast_" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
                  std::to_string(getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    test::CommandResult overcast(const std::string& arguments,
                                 const std::string& environment = "") const {
        return test::run_shell("cd '" + folder.string() + "' && " + environment +
                               " " OVC_BINARY_DIR "/bin/overcast " + arguments);
    }

    std::string bytes(const char* name) const {
        std::ifstream in(folder / name, std::ios::binary);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    }

    void write(const char* name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }

    fs::path folder;
};

std::string binary_ply_header(int vertices, int faces) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

/// Returns whether the statistics of a rendering report that `part`, scene or levels, came from a
/// cache.
bool from_cache(const std::string& stats, const std::string& part) {
    const size_t at = stats.find("\"from_cache\"");
    EXPECT_NE(at, stats.npos);
    return stats.find("\"" + part + "\": true", at) < stats.find('}', at);
}

TEST_F(CommandLine, ASceneFileHoldsTheSceneAndWhatIsBuiltOfIt) {
    ASSERT_EQ(overcast("render mirrors -o direct.png --size 48x32 --quiet").exit_code, 0);
    ASSERT_EQ(overcast("convert mirrors m.ovc").exit_code, 0);
    const auto rendered = overcast("render m.ovc -o file.png --size 48x32 --quiet --stats s.json");
    ASSERT_EQ(rendered.exit_code, 0) << rendered.output;
    EXPECT_EQ(bytes("file.png"), bytes("direct.png"));
    EXPECT_TRUE(from_cache(bytes("s.json"), "levels"));
    // With other options, the scene comes from the file and the levels are built.
    ASSERT_EQ(overcast("render m.ovc --leaves 40 -o other.png --size 48x32 --quiet --stats s.json")
                  .exit_code,
              0);
    EXPECT_EQ(bytes("other.png"), bytes("direct.png"));
    EXPECT_FALSE(from_cache(bytes("s.json"), "levels"));
    ASSERT_EQ(overcast("convert m.ovc m.ply --quiet").exit_code, 0);
    ASSERT_EQ(overcast("convert mirrors direct.ply --quiet").exit_code, 0);
    EXPECT_EQ(bytes("m.ply"), bytes("direct.ply"));
}

TEST_F(CommandLine, ADamagedSceneFileIsRefusedOrMended) {
    ASSERT_EQ(overcast("render box -o direct.png --size 32x32 --quiet").exit_code, 0);
    ASSERT_EQ(overcast("convert box b.ovc").exit_code, 0);
    const std::string whole = bytes("b.ovc");
    size_t refused = 0, mended = 0;
    for (size_t at = 0; at < whole.size(); at += whole.size() / 12) {
        std::string damaged = whole;
        damaged[at] ^= 0x10;
        write("d.ovc", damaged);
        fs::remove(folder / "d.png");
        const auto result = overcast("render d.ovc -o d.png --size 32x32 --quiet");
        if (result.exit_code == 1) {
            ++refused;
            EXPECT_THAT(result.output, HasSubstr("d.ovc: the file "));
            EXPECT_FALSE(fs::exists(folder / "d.png"));
            continue;
        }
        ASSERT_EQ(result.exit_code, 0) << result.output;
        mended += result.output.find("building anew: what was saved ") != std::string::npos;
        EXPECT_EQ(bytes("d.png"), bytes("direct.png")) << at;
    }
    EXPECT_GT(refused, 0u);
    EXPECT_GT(mended, 0u);
    write("d.ovc", whole.substr(0, whole.size() - 1));
    EXPECT_EQ(overcast("render d.ovc -o d.png").exit_code, 1);
}

TEST_F(CommandLine, TheCacheIsUsedRefreshedAndMended) {
    ASSERT_EQ(overcast("convert box box.ply --quiet").exit_code, 0);
    ASSERT_EQ(overcast("convert mirrors other.ply --quiet").exit_code, 0);
    const auto render = [&](const std::string& options) {
        const auto result = overcast("render box.ply --size 32x32 --stats s.json --cache kept " +
                                     options + " -o a.png");
        EXPECT_EQ(result.exit_code, 0) << result.output;
        return result.output;
    };
    const auto expect = [&](bool scene, bool levels, const char* picture) {
        EXPECT_EQ(from_cache(bytes("s.json"), "scene"), scene);
        EXPECT_EQ(from_cache(bytes("s.json"), "levels"), levels);
        EXPECT_EQ(bytes("a.png"), bytes(picture));
    };
    const auto kept = [&] {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder / "kept"))
            files.push_back(entry.path());
        return files;
    };
    ASSERT_EQ(overcast("render box.ply --size 32x32 --quiet -o box.png").exit_code, 0);
    ASSERT_EQ(overcast("render other.ply --size 32x32 --quiet -o other.png").exit_code, 0);
    render("");
    expect(false, false, "box.png");
    render("");
    expect(true, true, "box.png");
    ASSERT_EQ(kept().size(), 1u);

    fs::copy(folder / "other.ply", folder / "box.ply", fs::copy_options::overwrite_existing);
    EXPECT_THAT(render(""), HasSubstr("box.ply has changed"));
    expect(false, false, "other.png");
    render("");
    expect(true, true, "other.png");

    std::fstream(kept()[0], std::ios::in | std::ios::out | std::ios::binary).seekp(0).put('x');
    EXPECT_THAT(render(""), HasSubstr("does not begin as ovc scene does"));
    expect(false, false, "other.png");
    render("");
    expect(true, true, "other.png");

    render("--leaves 40");
    expect(false, false, "other.png");
    EXPECT_EQ(kept().size(), 2u) << "a file for each set of options";
    render("--leaves 40");
    expect(true, true, "other.png");
    render("--backend cpu-kdtree");
    expect(true, false, "other.png");

    write("file", "");
    EXPECT_THAT(overcast("render box --cache file").output, HasSubstr("'file' is no folder"));
}

/// llvmpipe has no vectors of 512 bits for fragment kernels.
TEST_F(CommandLine, AFragmentVariantIsAKernelAsAnyOther) {
    const auto asked = [&](const std::string& kernel) {
        return overcast("trace sphere-3 --any --log-level error " + kernel, "echo 0 0 9 0 0 -1 |");
    };
    const test::CommandResult result =
        asked("--kernel-variant fragment,both-sides,registers=8,images");
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_EQ(result.output, asked("").output);
}

/// Its users cannot call the library, and llvmpipe has no vectors of 512 bits for fragment kernels.
TEST_F(CommandLine, GivesNoAdviceForHosts) {
    for (const char* arguments :
         {"info box --log-level info", "convert box b.ovc --log-level info",
          "render box --size 8x8 -o a.png --kernel fragment",
          "render box --size 8x8 -o a.png --backend single-texture",
          "bench box --size 8x8 --repeats 1 --only certified-fragment,thesis-two-level"}) {
        const test::CommandResult result = overcast(arguments);
        EXPECT_EQ(result.exit_code, 0) << arguments;
        EXPECT_THAT(result.output, testing::Not(HasSubstr("prepare_process"))) << arguments;
    }
}

TEST_F(CommandLine, NeedsNobodyWhoTakesItsMessages) {
    const std::string render = "render box --size 32x24 --progress p.json ";
    ASSERT_EQ(overcast(render + "-o a.png").exit_code, 0);
    for (const char* lost : {"2>&-", "2>/dev/full"}) {
        const test::CommandResult result = overcast(render + "-o b.png " + lost);
        EXPECT_EQ(result.exit_code, 0) << lost << result.output;
        EXPECT_EQ(bytes("b.png"), bytes("a.png")) << lost;
        EXPECT_EQ(bytes("p.json").front(), '{') << lost;
    }
    EXPECT_EQ(overcast("render no-such-scene 2>/dev/full").exit_code, 1);
}

TEST_F(CommandLine, TellsThatItsOutputIsLost) {
    ASSERT_EQ(overcast("render box --size 8x8 -o a.png -q").exit_code, 0);
    const std::pair<const char*, int> cases[] = {
        {"bench box --size 8x8 --repeats 1 --only cpu-kdtree >/dev/full", 1},
        {"diff a.png a.png >/dev/full", 4},
        {"diff a.png a.png >&-", 4},
        {"--version >/dev/full", 1},
        {"render box --size 8x8 -o b.png -q --progress - >/dev/full", 1},
        {"render box --size 8x8 -o c.png -q --progress /dev/full", 1}};
    for (const auto& [arguments, code] : cases) {
        const test::CommandResult result = overcast(arguments);
        EXPECT_EQ(result.exit_code, code) << arguments;
        EXPECT_THAT(result.output, testing::AnyOf(HasSubstr("cannot write to standard output"),
                                                  HasSubstr("No space left")))
            << arguments;
    }
    EXPECT_EQ(bytes("c.png"), bytes("a.png"));
}

TEST_F(CommandLine, AReaderOfProgressMayStop) {
    const test::CommandResult result =
        overcast("render box --size 64x64 --samples 16 -o a.png -q --progress p",
                 "mkfifo p && { head -n 1 p >/dev/null & } &&");
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_TRUE(fs::exists(folder / "a.png"));
}

TEST_F(CommandLine, BadInputIsOneSentenceExitOneAndNothingWritten) {
    write("empty.ply", "");
    write("cut.ply", binary_ply_header(3, 1) + std::string(20, '\0'));
    write("outside.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
                         "float y\nproperty float z\n"
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n");
    write("scene.xyz", "0 0 0\n");
    fs::create_directories(folder / "folder.ply");
    const struct {
        const char* arguments;
        // The sentence must contain all of these.
        std::vector<const char*> parts;
        const char* environment = "";
    } cases[] = {
        {"none.ply", {"none.ply", "no such file"}},
        {"empty.ply", {"empty.ply", "empty"}},
        {"folder.ply", {"folder.ply", "directory"}},
        {"cut.ply", {"cut.ply", "byte"}},
        {"outside.ply", {"outside.ply", "9"}},
        {"scene.xyz", {"scene.xyz", "xyz"}},
        {"box --gpu-memory 1K", {"1024 bytes is too small", "smallest that works is 40964 bytes"}},
        {"box --gpu-memory abc", {"--gpu-memory", "abc"}},
        {"box -o nowhere/out.png", {"nowhere", "does not exist"}},
        {"box --device 'no such card'", {"no device is called 'no such card'", "there is 0 '"}},
        {"box",
         {"EGL_PLATFORM is set to 'nonsense'", "'device' and 'surfaceless'"},
         "EGL_PLATFORM=nonsense"},
        {"box --kernel fragment --device llvmpipe",
         {"LP_NATIVE_VECTOR_WIDTH is 512", "take the compute kernel"},
         "LP_NATIVE_VECTOR_WIDTH=512"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.arguments);
        const test::CommandResult run =
            overcast(std::string("render ") + c.arguments, c.environment);
        EXPECT_EQ(run.exit_code, 1);
        const std::string sentence = test::without_remarks(run.output);
        EXPECT_EQ(std::count(sentence.begin(), sentence.end(), '\n'), 1) << sentence;
        EXPECT_THAT(sentence, testing::StartsWith("overcast: "));
        for (const char* part : c.parts)
            EXPECT_THAT(sentence, HasSubstr(part));
        for (const auto& entry : fs::directory_iterator(folder))
            EXPECT_THAT(entry.path().extension().string(), testing::AnyOf(".ply", ".xyz"))
                << entry.path();
    }
}

TEST_F(CommandLine, ThePictureDoesNotDependOnBudgetLeavesOrBackend) {
    const struct {
        const char* options;
        const char* name;
    } variants[] = {{"", "default"},
                    {"--gpu-memory 4M", "budget"},
                    {"--leaves 37", "leaves"},
                    {"--leaf-triangles 1000000", "one leaf"},
                    {"--backend cpu-kdtree", "cpu"}};
    for (const char* scene : {"plants-1", "mirrors"}) {
        for (const auto& v : variants) {
            const test::CommandResult run =
                overcast(std::string("render ") + scene + " --size 200x150 --quiet " + v.options +
                         " -o '" + v.name + ".png'");
            ASSERT_EQ(run.exit_code, 0) << run.output;
            EXPECT_EQ(bytes("default.png"), bytes((std::string(v.name) + ".png").c_str()))
                << scene << ", " << v.name;
        }
    }
}

TEST_F(CommandLine, TheDragonInTwelveMegabytesIsTheSamePicture) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const std::string dragon = (*data / "meshes/stanford-dragon/dragon_vrip.ply.gz").string();
    const auto whole = overcast("render '" + dragon + "' --quiet -o whole.png");
    const auto budget =
        overcast("render '" + dragon + "' --quiet -o budget.png --gpu-memory 12M --stats s.json");
    ASSERT_EQ(whole.exit_code, 0) << whole.output;
    ASSERT_EQ(budget.exit_code, 0) << budget.output;
    EXPECT_EQ(bytes("whole.png"), bytes("budget.png"));
    EXPECT_THAT(bytes("s.json"), HasSubstr("\"gpu_budget_bytes\": 12582912"));
}

/// Returns the first number of that key in a JSON text, or -1 if there is none.
double number(const std::string& text, const std::string& key) {
    const size_t at = text.find("\"" + key + "\": ");
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + key.size() + 4));
}

TEST_F(CommandLine, InfoTellsThePlanThatRenderThenKeepsTo) {
    const auto info = overcast("info plants-1 --json --gpu-memory 2M 2>/dev/null");
    ASSERT_EQ(info.exit_code, 0) << info.output;
    const auto render =
        overcast("render plants-1 --quiet --size 64x48 --gpu-memory 2M --stats s.json");
    ASSERT_EQ(render.exit_code, 0) << render.output;
    const std::string stats = bytes("s.json");
    for (const char* key : {"leaves", "level2_bytes", "gpu_budget_bytes"})
        EXPECT_NEAR(number(info.output, key) / number(stats, key), 1, 0.1) << key;
    EXPECT_LT(number(info.output, "resident_pages"), number(info.output, "leaves"));
    EXPECT_GT(number(info.output, "smallest_budget_bytes"), 40964);
    const auto text = overcast("info plants-1 --gpu-memory 64K 2>/dev/null");
    EXPECT_THAT(text.output, HasSubstr("64.0 KiB is too small"));
    const auto cpu = overcast("info box --backend cpu-kdtree");
    EXPECT_THAT(cpu.output, HasSubstr("plan       none: a backend on the CPU has no plan"));
    const auto thesis = overcast("info box --backend skip-bvh 2>/dev/null");
    EXPECT_THAT(thesis.output, HasSubstr("what skip-bvh takes is known only once it is built"));
}

TEST_F(CommandLine, PathTracingMakesOnePictureInBothModesAndOfTheSceneFile) {
    write("lamp.pbrt", R"(LookAt 0 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
Material "matte" "rgb Kd" [0.6 0.5 0.4]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-4 0 -4 -4 0 4 4 0 4 4 0 -4]
AttributeBegin
Material "dielectric"
Translate 0 0.7 0
Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 9]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 3 -1 1 3 -1 1 3 1 -1 3 1]
AttributeEnd
)");
    const std::string how = " --integrator path --samples 4 --size 24x24 --quiet -o ";
    const auto batched = overcast("render lamp.pbrt --stats s.json" + how + "batched.png");
    ASSERT_EQ(batched.exit_code, 0) << batched.output;
    EXPECT_GT(number(bytes("s.json"), "bounce"), 24 * 24);
    ASSERT_EQ(overcast("render lamp.pbrt --mode mixed" + how + "mixed.png").exit_code, 0);
    EXPECT_EQ(bytes("batched.png"), bytes("mixed.png"));
    ASSERT_EQ(overcast("convert lamp.pbrt lamp.ovc").exit_code, 0);
    ASSERT_EQ(overcast("render lamp.ovc" + how + "file.png").exit_code, 0);
    EXPECT_EQ(bytes("batched.png"), bytes("file.png"));
    ASSERT_EQ(overcast("render lamp.pbrt --size 24x24 --quiet -o whitted.png").exit_code, 0);
    EXPECT_NE(bytes("batched.png"), bytes("whitted.png"));
    const auto unknown = overcast("render lamp.pbrt --integrator pth");
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_THAT(unknown.output, HasSubstr("did you mean 'path'?"));
}

/// Holds for a scene file too, although its reader does not know lamps.
TEST_F(CommandLine, OnlyWhoeverSimplifiesLampsWarnsOfIt) {
    write("lamp.pbrt", R"(WorldBegin
AreaLightSource "diffuse" "rgb L" [9 9 9]
Shape "trianglemesh" "integer indices" [0 1 2] "point P" [-1 3 -1 1 3 -1 1 3 1]
)");
    EXPECT_EQ(overcast("convert lamp.pbrt lamp.ovc").output, "") << "no light is asked for";
    for (const std::string scene : {"lamp.pbrt", "lamp.ovc"}) {
        const auto said = [&](const std::string& options) {
            return overcast("render " + scene + " --quiet --size 8x8 " + options).output;
        };
        EXPECT_EQ(said(""), "overcast: warning: " + scene +
                                ": area lights shine from a few points on them, and shadows are "
                                "hard; --integrator path has them as they are\n");
        EXPECT_EQ(said("--light 0,9,0"), "") << "the lamps are not asked";
        EXPECT_EQ(said("--integrator path"), "");
    }
}

TEST_F(CommandLine, CtrlCDuringABuildEndsItSoon) {
    // A build takes from half a second to six here, so the signal comes during it.
    const auto run = test::run_shell(OVC_BINARY_DIR "/bin/overcast render dragons-21 --quiet -o '" +
                                     folder.string() +
                                     "/never.png' & pid=$!; sleep 2; kill -INT $pid; wait $pid");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, HasSubstr("interrupted"));
    EXPECT_FALSE(fs::exists(folder / "never.png")) << run.output;
}

TEST_F(CommandLine, LayersOfWhatTheCameraSees) {
    EXPECT_EQ(overcast("render box --aov depth,normal,id -o a.exr --quiet --size 20x20").exit_code,
              0);
    EXPECT_THAT(bytes("a.exr"), HasSubstr("depth.Z"));
    EXPECT_THAT(bytes("a.exr"), HasSubstr("id.prim"));
    EXPECT_EQ(
        overcast(
            "render knot --aov leaf,passes,flagged -o b.exr --quiet --size 64x64 --gpu-memory 12M")
            .exit_code,
        0);
    EXPECT_THAT(bytes("b.exr"), HasSubstr("passes"));
    const auto png = overcast("render box --aov depth -o a.png");
    EXPECT_EQ(png.exit_code, 1);
    EXPECT_THAT(png.output, HasSubstr("--aov needs an output that holds layers: -o FILE.exr"));
}

TEST_F(CommandLine, TellsTheWorkingSetOfEachFrame) {
    const auto run = overcast("render plants-1 --quiet --size 64x48 --leaves 30 --frames 0:1 -o "
                              "'p-##.png' --working-set --stats s.json");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const std::string stats = bytes("s.json");
    const double active = number(stats, "pages");
    EXPECT_GT(active, 0);
    EXPECT_LE(active, number(stats, "leaves"));
    EXPECT_THAT(stats, HasSubstr("\"new_bytes\""));
    const auto without = overcast("render box --working-set -o a.png");
    EXPECT_EQ(without.exit_code, 1);
    EXPECT_THAT(without.output,
                HasSubstr("--working-set is told in the statistics: --stats FILE.json"));
}

TEST_F(CommandLine, TraceAnswersOneLineARay) {
    const auto run = test::run_shell("printf '0 0 5 0 0 -1\\n0 0 5 0 0 1\\n' | " OVC_BINARY_DIR
                                     "/bin/overcast trace sphere-0 2>/dev/null");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 2) << run.output;
    EXPECT_THAT(run.output, testing::EndsWith("miss\n"));
}

} // namespace
} // namespace ovc
