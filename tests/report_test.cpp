// SPDX-License-Identifier: Apache-2.0
// Makes the report as a user does, on a small scene. tests/report has the tests of the page.
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// Measures time against error of a small scene; with a page where Python has what it takes.
class Report : public testing::Test {
protected:
    void SetUp() override {
        has_page =
            test::run_shell("/usr/bin/python3 -c 'import matplotlib, jinja2'").exit_code == 0;
        folder = fs::path(OVC_BINARY_DIR) / "tests" /
                 (std::string("report_") +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder);
    }
    test::CommandResult make(const std::string& before = "", const std::string& after = "") const {
        return test::run_shell(before +
                               " " OVC_BINARY_DIR
                               "/bin/overcast report --quick --only error --scene sphere-4 --size "
                               "64x64 -o '" +
                               folder.string() + "' " + after);
    }

    fs::path folder;
    bool has_page = false;
};

TEST_F(Report, IsOneCommandThatRepeatsNothing) {
    const test::CommandResult made = make();
    EXPECT_THAT(text_of(folder / "error.json"), testing::HasSubstr("\"overcast-report-1\""));
    if (!has_page) {
        EXPECT_THAT(made.output, testing::HasSubstr("apt install"));
        return;
    }
    ASSERT_EQ(made.exit_code, 0) << made.output;
    EXPECT_THAT(text_of(folder / "index.html"), testing::HasSubstr("id=\"scoreboard\""));
    const Json before = Json::parse(text_of(folder / "error.json"))["runs"];
    ASSERT_EQ(make("", "--compare '" + folder.string() + "'").exit_code, 0);
    EXPECT_EQ(Json::parse(text_of(folder / "error.json"))["runs"], before) << "measured again";
    EXPECT_THAT(text_of(folder / "index.html"), testing::HasSubstr("id=\"compare\""));
    const test::CommandResult bad = make("", "--kit /dev/null");
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_THAT(bad.output, testing::HasSubstr("/dev/null is no kit.json"));
}

/// Missing files are said before anything is measured.
TEST_F(Report, RefusesFoldersAndFilesThatAreNotThere) {
    for (const char* option : {"--data", "--compare", "--kit"}) {
        const test::CommandResult made = make("", std::string(option) + " /nowhere");
        EXPECT_EQ(made.exit_code, 1);
        EXPECT_THAT(made.output, testing::HasSubstr(option + std::string(": there is no ")));
        EXPECT_FALSE(fs::exists(folder));
    }
}

/// The JSON is written all the same, and the message says what to install.
TEST_F(Report, SaysWhatIsMissingWithoutPython) {
    const fs::path tools = folder.string() + "_tools";
    fs::create_directories(tools);
    fs::remove(tools / "env");
    fs::create_symlink("/usr/bin/env", tools / "env");
    const test::CommandResult made = make("PATH='" + tools.string() + "'");
    EXPECT_EQ(made.exit_code, 1);
    EXPECT_THAT(made.output, testing::HasSubstr("python3-matplotlib python3-jinja2"));
    EXPECT_TRUE(Json::parse(text_of(folder / "error.json"))["complete"]);
    EXPECT_FALSE(fs::exists(folder / "index.html"));
}

/// The library of tests/broken_kernel differs from this one by a line of its kernel.
TEST_F(Report, ShowsABrokenKernelOnTheScoreboard) {
    const test::CommandResult made =
        make("OVC_PLUGIN=" OVC_BINARY_DIR "/bin/libovercast-broken.so");
    EXPECT_EQ(made.exit_code, 1);
    if (!has_page)
        GTEST_SKIP() << "python3-matplotlib or python3-jinja2 is not installed";
    EXPECT_THAT(made.output, testing::HasSubstr("answered wrong"));
    const Json page = Json::parse(text_of(folder / "page.json"));
    EXPECT_EQ(page["scoreboard"]["exact"]["verdict"], "misses");
    EXPECT_GT(page["scoreboard"]["exact"]["median"], 0);
    const std::string html = text_of(folder / "index.html");
    EXPECT_THAT(html, testing::HasSubstr("class=\"trouble\""));
    EXPECT_THAT(html, testing::HasSubstr("class=\"misses\">misses"));
    for (const Json& workload : page["error"]["scenes"][0]["workloads"])
        for (const Json& one : workload["contenders"])
            if (workload["workload"] == "edges" && one["name"] == "cpu-kdtree") {
                EXPECT_EQ(one["wrong"], 0) << "the line that is broken is the kernel's";
            }
}

} // namespace
} // namespace ovc
