// SPDX-License-Identifier: Apache-2.0
// Tests programs that run, fail and are missing, and a mesh in other programs' languages.
#include "host/bench/programs/programs.h"
#include "host/bench/programs/run_program.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace ovc {
namespace {

using Words = std::vector<std::string>;

TEST(RunProgram, TimesIt) {
    const Result<double> seconds = run_program(Words{"sleep", "0.2"});
    ASSERT_TRUE(bool(seconds)) << seconds.error().message;
    EXPECT_GE(*seconds, 0.2);
}

TEST(RunProgram, SaysWhatWentWrong) {
    const Result<double> failed =
        run_program(Words{"sh", "-c", "echo first >&2; echo no such scene >&2; exit 3"});
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "sh failed: no such scene");
    const Result<double> missing = run_program(Words{"no-such-program"});
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, testing::HasSubstr("no-such-program cannot be started"));
    EXPECT_FALSE(is_installed("no-such-program"));
    EXPECT_TRUE(is_installed("sh"));
}

/// Two triangles with a common side.
Soup two_triangles() {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0),
                                                   vec3(1, 0, 0), vec3(1, 1, 0.5), vec3(0, 1, 0)}));
    return soup;
}

TEST(Programs, ShareVerticesForPovray) {
    const std::string text = povray_scene(two_triangles(), *shot_of({dvec3(0), dvec3(1)}, 512));
    EXPECT_THAT(text, testing::HasSubstr("vertex_vectors {\n4,\n<0,0,0>"));
    EXPECT_THAT(text, testing::HasSubstr("face_indices {\n2,\n<0,1,2>,\n<1,3,2>\n}"));
}

TEST(Programs, MirrorTheMeshForTachyon) {
    const std::string text = tachyon_scene(two_triangles(), *shot_of({dvec3(0), dvec3(1)}, 512));
    EXPECT_THAT(text, testing::HasSubstr("RESOLUTION 512 512"));
    EXPECT_THAT(text, testing::HasSubstr("TRI V0 1 0 -0 V1 1 1 -0.5 V2 0 1 -0 plain"));
}

TEST(Programs, AreComparedRunByRun) {
    const ProgramsResult result{"dragon.ply",
                                2,
                                512,
                                {{"overcast", "PLY", {1, 0.5, 0.6}, 100},
                                 {"povray", "mesh2 text", {3, 9, 2}, 200},
                                 {"tachyon", "TRI text", {}, 0}},
                                true};
    EXPECT_DOUBLE_EQ(times_as_fast(result, "povray")->median, 2 / 0.6); // of 3, 18 and this
    EXPECT_FALSE(times_as_fast(result, "tachyon"));
    EXPECT_THAT(programs_table(result), testing::HasSubstr("not installed"));
    const auto document = nlohmann::json::parse(programs_json(result));
    EXPECT_DOUBLE_EQ(document["programs"][1]["overcast_times_as_fast"], 2 / 0.6);
    EXPECT_EQ(document["programs"][2]["overcast_times_as_fast"], nullptr);
}

} // namespace
} // namespace ovc
