// SPDX-License-Identifier: Apache-2.0
// Tests experiments whose runs are shell scripts: finished runs are kept, failures are reported,
// and a stopped run is as if it had not begun.
#include "host/report/experiments/run_experiments.h"

#include "host/bench/programs/scratch_folder.h"
#include "host/report/experiments/experiment_file.h"

#include <gmock/gmock.h>

#include <fstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class RunExperiments : public testing::Test {
protected:
    void SetUp() override { scripts.clear(); }

    /// Adds a script that writes result.json to its own folder, $0.
    ReportRun& add(const std::string& key, const std::string& script) {
        ReportRun run{key, {"-c", script, "{}"}, "result.json", 1};
        run.timed = false;
        scripts.push_back(run);
        return scripts.back();
    }
    /// Returns a script that also adds a line to the file `name` each time it runs.
    std::string counted(const std::string& name, const std::string& script) const {
        return "echo run >> '" + (scratch.path() / name).string() + "'; " + script;
    }
    size_t times(const std::string& name) const {
        std::ifstream file(scratch.path() / name);
        size_t lines = 0;
        for (std::string line; std::getline(file, line);)
            ++lines;
        return lines;
    }
    /// Returns the troubles.
    std::vector<std::string> run(
        const std::function<bool()>& stop = [] { return false; },
        const std::string& build = "a build", const ReportPlan& plan = {}) const {
        const Experiment experiment{"scripts", "shell scripts",
                                    [](const ReportPlan&) { return scripts; }};
        const auto troubles =
            run_experiments(std::span(&experiment, 1), "", plan,
                            {"sh", build, scratch.path(), stop, [](const std::string&) {}});
        EXPECT_TRUE(troubles);
        return *troubles;
    }
    Json file() const {
        std::ifstream in(scratch.path() / "scripts.json");
        return Json::parse(in);
    }

    static std::vector<ReportRun> scripts; // static, because Experiment::runs cannot capture
    ScratchFolder scratch = std::move(*ScratchFolder::make());
};

std::vector<ReportRun> RunExperiments::scripts;

TEST_F(RunExperiments, KeepResultsAndDoNotRepeatThem) {
    add("one", counted("one", "echo '{\"n\": 1}' > $0/result.json"));
    add("two", counted("two", "echo '{\"n\": 2}' > $0/result.json"));
    for (int again = 0; again < 2; ++again) {
        EXPECT_THAT(run(), testing::IsEmpty());
        EXPECT_EQ(file()["schema"], "overcast-report-1");
        EXPECT_EQ(file()["complete"], true);
        ASSERT_EQ(file()["runs"].size(), 2u);
        EXPECT_EQ(file()["runs"][1]["result"]["n"], 2);
        EXPECT_EQ(file()["runs"][1]["attempts"], 1);
        EXPECT_TRUE(file()["runs"][1]["load"]["others_during"].is_number());
    }
    EXPECT_EQ(times("one"), 1u);
    run([] { return false; }, "another build");
    EXPECT_EQ(times("one"), 2u);
    scripts[0].words[1] += " # another command";
    run([] { return false; }, "another build");
    EXPECT_EQ(times("one"), 3u);
    EXPECT_EQ(times("two"), 2u);
}

TEST_F(RunExperiments, SetVariablesAndRunWhatComesBefore) {
    ReportRun& one = add("one", "echo \"{\\\"n\\\": \\\"$OF_A_RUN $(cat $0/made)\\\"}\" > "
                                "$0/result.json; mkdir $0/kernels; echo 12345 > $0/kernels/k");
    one.variables = {"OF_A_RUN=set"};
    one.before = {"-c", "echo made > $0/made", "{}"};
    EXPECT_THAT(run(), testing::IsEmpty());
    EXPECT_EQ(file()["runs"][0]["result"]["n"], "set made");
    EXPECT_EQ(file()["runs"][0]["kernel_bytes"], 6);
}

TEST_F(RunExperiments, SayWhatFailedAndGoOn) {
    add("bad", "echo the reason >&2; exit 1");
    add("broken", "echo '{\"n\": ' > $0/result.json");
    add("refused", "echo too large >&2; exit 1").may_refuse = true;
    add("good", "echo '{\"n\": 3}' > $0/result.json");
    EXPECT_THAT(run(), testing::ElementsAre("scripts, bad: the reason",
                                            testing::StartsWith("scripts, broken: ")));
    ASSERT_EQ(file()["runs"].size(), 4u);
    EXPECT_TRUE(file()["runs"][0]["result"].is_null());
    EXPECT_EQ(file()["runs"][2]["result"]["refused"], "too large");
    EXPECT_EQ(file()["runs"][3]["result"]["n"], 3);
}

TEST_F(RunExperiments, TakeTheSizeThatIsAskedForAndItsHeightForSquares) {
    for (const char* table : {"--sweep", "--pictures"}) {
        ReportRun& run = add(table, "echo \"{\\\"size\\\": \\\"$3\\\"}\" > $0/result.json");
        run.words.insert(run.words.end(), {table, "--size", "9x9"});
    }
    EXPECT_TRUE(run([] { return false; }, "a build", {.size = "64x40"}).empty());
    EXPECT_EQ(file()["runs"][0]["result"]["size"], "64x40");
    EXPECT_EQ(file()["runs"][1]["result"]["size"], "40x40");
}

/// Commands that find wrong answers write their figures all the same.
TEST_F(RunExperiments, TakeFiguresOfARunThatFoundSomethingWrongAndRunItAgain) {
    add("wrong",
        counted("wrong", "echo '{\"n\": 4}' > $0/result.json; echo 4 are wrong >&2; exit 1"));
    for (int again = 0; again < 2; ++again) {
        EXPECT_THAT(run(), testing::ElementsAre("scripts, wrong: 4 are wrong"));
        EXPECT_EQ(file()["runs"][0]["result"]["n"], 4);
    }
    EXPECT_EQ(times("wrong"), 2u);
}

TEST_F(RunExperiments, TakeAVerdictForAResult) {
    add("judges", "echo '{\"n\": 5}' > $0/result.json; echo a line fails >&2; exit 1").judges =
        true;
    add("silent", "echo no figures >&2; exit 1").judges = true;
    EXPECT_THAT(run(), testing::ElementsAre("scripts, silent: no figures"));
    EXPECT_EQ(file()["runs"][0]["result"]["n"], 5);
}

TEST_F(RunExperiments, ForgetWhatWasStopped) {
    add("first", "echo '{\"n\": 1}' > $0/result.json");
    add("second", "echo '{\"n\": 2}' > $0/result.json; exec sleep 50");
    int looks = 0;
    run([&] { return fs::exists(scratch.path() / "scripts.json") && ++looks > 3; });
    EXPECT_EQ(file()["complete"], false);
    EXPECT_EQ(file()["runs"].size(), 1u);
    EXPECT_FALSE(fs::exists(scratch.path() / "part"));
}

/// A program that is built anew, or that loads another library, is another build.
TEST(BuildText, IsOfTheProgramAndItsLibraries) {
    const ScratchFolder scratch = std::move(*ScratchFolder::make());
    const fs::path program = scratch.path() / "program";
    const auto build_of = [&](const std::string& text) {
        std::ofstream(program) << text;
        return build_text(program);
    };
    const std::string first = build_of("first");
    EXPECT_NE(build_of("other"), first);
    EXPECT_EQ(build_of("first"), first);
    const fs::path library = scratch.path() / "library.so";
    std::ofstream(library) << "library";
    ::setenv("OVC_PLUGIN", library.c_str(), /* overwrite= */ 1);
    EXPECT_NE(build_text(program), first);
    ::unsetenv("OVC_PLUGIN");
}

} // namespace
} // namespace ovc
