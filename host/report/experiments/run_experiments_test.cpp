// SPDX-License-Identifier: Apache-2.0
// Tests experiments whose runs are shell scripts: finished runs are kept, failures are reported,
// and a stopped run is as if it had not begun.
#include "host/report/experiments/run_experiments.h"

#include "host/bench/programs/scratch_folder.h"
#include "host/report/experiments/raw_results.h"

#include <gmock/gmock.h>

#include <fstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class RunExperiments : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(scratch.path() / "raw" / "scripts");
        scripts.clear();
    }

    /// Adds a script that writes result.json to its own folder, $0.
    void add(const std::string& key, const std::string& script) {
        scripts.push_back({key, {"-c", script, "{}"}, "result.json", 1});
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
    Outcome run(
        const std::function<bool()>& stop = [] { return false; },
        std::string_view chosen = "") const {
        const Experiment experiment{
            "scripts", "Scripts", "shell scripts", [](const ReportPlan&) { return scripts; },
            {},        {}};
        Result<std::vector<Outcome>> outcomes =
            run_experiments(std::span(&experiment, 1), chosen, {},
                            {"sh", "a build", scratch.path(), stop, [](const std::string&) {}});
        EXPECT_TRUE(outcomes);
        return outcomes->at(0);
    }

    static std::vector<ReportRun> scripts; // static, because Experiment::runs cannot capture
    ScratchFolder scratch = std::move(*ScratchFolder::make());
};

std::vector<ReportRun> RunExperiments::scripts;

TEST_F(RunExperiments, KeepResultsAndDoNotRepeatThem) {
    add("one", counted("one", "echo '{\"n\": 1}' > $0/result.json"));
    add("two", counted("two", "echo '{\"n\": 2}' > $0/result.json"));
    for (int again = 0; again < 2; ++again) {
        const Outcome outcome = run();
        ASSERT_EQ(outcome.results.size(), 2u);
        EXPECT_EQ(outcome.results[0].result["n"], 1);
        EXPECT_EQ(outcome.results[1].result["n"], 2);
        EXPECT_TRUE(outcome.complete);
    }
    EXPECT_EQ(times("one"), 1u);
    EXPECT_EQ(times("two"), 1u);
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path() / "raw" / "scripts"), {}), 2);
}

TEST_F(RunExperiments, SetVariablesOfTheEnvironment) {
    add("plain", "echo \"{\\\"n\\\": \\\"$OF_A_RUN\\\"}\" > $0/result.json");
    scripts.push_back(scripts[0]);
    scripts[1].variables = {"OF_A_RUN=set"};
    const Outcome outcome = run();
    ASSERT_EQ(outcome.results.size(), 2u);
    EXPECT_EQ(outcome.results[0].result["n"], "");
    EXPECT_EQ(outcome.results[1].result["n"], "set")
        << "another command, so not the first's result";
}

TEST_F(RunExperiments, SayWhatFailedAndGoOn) {
    add("bad", "echo the reason >&2; exit 1");
    add("broken", "echo '{\"n\": ' > $0/result.json");
    add("good", "echo '{\"n\": 3}' > $0/result.json");
    const Outcome outcome = run();
    EXPECT_THAT(outcome.failures,
                testing::ElementsAre("bad: the reason", testing::StartsWith("broken: ")));
    ASSERT_EQ(outcome.results.size(), 1u);
    EXPECT_EQ(outcome.results[0].run.key, "good");
}

/// Commands that find wrong answers write their figures all the same.
TEST_F(RunExperiments, TakeFiguresOfARunThatFoundSomethingWrongAndRunItAgain) {
    add("wrong",
        counted("wrong", "echo '{\"n\": 4}' > $0/result.json; echo 4 are wrong >&2; exit 1"));
    for (int again = 0; again < 2; ++again) {
        const Outcome outcome = run();
        ASSERT_EQ(outcome.results.size(), 1u);
        EXPECT_THAT(outcome.remarks, testing::ElementsAre("wrong: 4 are wrong"));
    }
    EXPECT_EQ(times("wrong"), 2u);
}

TEST_F(RunExperiments, ForgetWhatWasStopped) {
    add("first", "echo '{\"n\": 1}' > $0/result.json");
    add("second", "echo '{\"n\": 2}' > $0/result.json; exec sleep 50");
    int looks = 0;
    const fs::path first =
        raw_path(scratch.path(), Experiment{"scripts", "", "", {}, {}, {}}, scripts[0], "a build");
    const Outcome outcome = run([&] { return fs::exists(first) && ++looks > 3; });
    EXPECT_FALSE(outcome.complete);
    EXPECT_EQ(outcome.results.size(), 1u);
    EXPECT_EQ(std::distance(fs::directory_iterator(first.parent_path()), {}), 1)
        << "the folder of the second is gone";
}

TEST_F(RunExperiments, TakeWhatIsThereOfThoseThatAreNotChosen) {
    add("one", "echo '{\"n\": 1}' > $0/result.json");
    add("two", counted("two", "echo '{\"n\": 2}' > $0/result.json"));
    EXPECT_FALSE(run([] { return false; }, "another").complete);
    EXPECT_EQ(times("two"), 0u);
    EXPECT_TRUE(run([] { return false; }, "scripts").complete);
    const Outcome outcome = run([] { return false; }, "another");
    EXPECT_TRUE(outcome.complete);
    EXPECT_EQ(outcome.results.size(), 2u);
    EXPECT_EQ(times("two"), 1u);
}

/// A program that is built anew, or that loads another library, is another build.
TEST(RawResults, AreOfOneBuild) {
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
    const Experiment experiment{"e", "", "", {}, {}, {}};
    EXPECT_NE(raw_path("", experiment, {}, "one"), raw_path("", experiment, {}, "two"));
}

TEST(RawResults, AreOfOneCommand) {
    const ScratchFolder scratch = std::move(*ScratchFolder::make());
    const Experiment experiment{"e", "", "", {}, {}, {}};
    const ReportRun run{"key", {"bench", "--size", "8x8"}, "r.json", 1};
    const fs::path path = raw_path(scratch.path(), experiment, run, "a build");
    ReportRun other = run;
    other.words[2] = "9x9";
    EXPECT_NE(raw_path(scratch.path(), experiment, other, "a build"), path);
    EXPECT_FALSE(load_raw(path, run));
    fs::create_directories(path.parent_path());
    ASSERT_TRUE(save_raw(path, {run, {{"x", 5}}}, "a build", 1.5));
    ASSERT_TRUE(load_raw(path, run));
    EXPECT_EQ(load_raw(path, run)->result["x"], 5);
    fs::resize_file(path, fs::file_size(path) - 5);
    EXPECT_FALSE(load_raw(path, run));
}

} // namespace
} // namespace ovc
