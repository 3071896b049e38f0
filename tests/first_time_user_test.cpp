// SPDX-License-Identifier: Apache-2.0
// What goes wrong in a user's first hour, as a shell has it: each ends with one sentence, or
// quietly, and leaves nothing half done.
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kOvercast = OVC_BINARY_DIR "/bin/overcast";

class FirstTimeUser : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::path(testing::TempDir()) / ("ovc_" + name + "_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// In bash, for its PIPESTATUS, and in a folder of the test's own; $o is the command.
    test::CommandResult bash(const std::string& script) const {
        return test::run_shell("cd '" + folder_.string() + "' && o=" + kOvercast + " bash -c '" +
                               script + "'");
    }

    bool is_folder_empty() const { return fs::is_empty(folder_); }

    fs::path folder_;
};

/// The sentence that is left when warnings are taken away (that there is no GPU, say).
std::string without_warnings(std::string text) {
    for (size_t at; (at = text.find("overcast: warning:")) != std::string::npos;)
        text.erase(at, text.find('\n', at) + 1 - at);
    return text;
}

void expect_one_sentence(const test::CommandResult& run, const std::string& part) {
    EXPECT_EQ(run.exit_code, 1) << run.output;
    const std::string sentence = without_warnings(run.output);
    EXPECT_EQ(std::count(sentence.begin(), sentence.end(), '\n'), 1) << sentence;
    EXPECT_THAT(sentence, testing::StartsWith("overcast: "));
    EXPECT_THAT(sentence, HasSubstr(part));
}

TEST_F(FirstTimeUser, FindsHelpEverywhere) {
    for (const char* words : {"--help", "-h", "help", "help render", "render -h", "diff --help"}) {
        const auto help = bash("$o " + std::string(words) +
                               " 2>stderr; code=$?; cat stderr; rm stderr; exit $code");
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_THAT(help.output, HasSubstr("Examples:")) << words;
    }
    expect_one_sentence(bash("$o"), "see overcast --help");
}

TEST_F(FirstTimeUser, MistypesAndIsToldTheRightWord) {
    expect_one_sentence(bash("$o rendr box"), "did you mean 'render'?");
    expect_one_sentence(bash("$o render box --szie 10x10"), "did you mean '--size'?");
    expect_one_sentence(bash("$o render box --mode mixd"), "did you mean 'mixed'?");
    expect_one_sentence(bash("$o render plnats"), "did you mean \"plants\"?");
    expect_one_sentence(bash("$o render no/such/dragon.ply"), "no such file");
    EXPECT_TRUE(is_folder_empty());
}

TEST_F(FirstTimeUser, InterruptsARendering) {
    const auto run = bash("$o render mirrors --size 2000x2000 --samples 64 --quiet & sleep 2; "
                          "kill -INT $!; wait $!");
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, HasSubstr("interrupted"));
    EXPECT_FALSE(fs::exists(folder_ / "out.png")) << "only a finished picture has the name";
    for (const auto& entry : fs::directory_iterator(folder_))
        EXPECT_THAT(entry.path().filename().string(), HasSubstr("unfinished"));
}

TEST_F(FirstTimeUser, HasAFullDisk) {
    // A limit on a file's size is what a full disk is to a program that writes one.
    const auto file = bash("echo old > out.png; ulimit -f 1; $o render box --size 300x300 --quiet");
    expect_one_sentence(file, "out.png: cannot be written: ");
    EXPECT_EQ(fs::file_size(folder_ / "out.png"), 4u) << "what was there is there";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "nothing is left behind";
    if (!fs::exists("/dev/full"))
        return;
    for (const char* words : {"scenes", "--help", "info box", "man", "completion bash"})
        expect_one_sentence(bash("$o " + std::string(words) + " > /dev/full"),
                            "cannot write to standard output");
    expect_one_sentence(bash("echo 0 0 9 0 0 -1 | $o trace box > /dev/full"),
                        "No space left on device");
}

TEST_F(FirstTimeUser, MayNotWriteThere) {
    fs::create_directory(folder_ / "closed");
    fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::owner_exec |
                                            fs::perms::others_read | fs::perms::others_exec);
    // Root may write anywhere.
    const std::string as_user =
        geteuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups " : "";
    if (!as_user.empty() && bash(as_user + "$o --version").exit_code != 0)
        GTEST_SKIP() << "no other user can run the command here";
    expect_one_sentence(bash(as_user + "$o render box -o closed/a.png"),
                        "the folder cannot be written to: Permission denied");
    EXPECT_TRUE(fs::is_empty(folder_ / "closed"));
}

TEST_F(FirstTimeUser, ClosesAPipeEarly) {
    const struct {
        const char* script;
        const char* first;
    } cases[] = {
        {"$o --help | head -1", "Overcast finds"},
        {"$o info box --json 2>/dev/null | head -c1", "{"},
        {"$o completion bash | head -1", "# Completion"},
        {"$o man | head -1", ".\\\""},
        {"yes -- 0 0 9 0 0 -1 | $o trace box 2>/dev/null | head -1", ""},
    };
    for (const auto& c : cases) {
        const auto run = bash(std::string(c.script) +
                              "; codes=(${PIPESTATUS[@]}); echo; echo codes ${codes[*]}");
        EXPECT_THAT(run.output, testing::StartsWith(c.first));
        // 141 is what a shell makes of SIGPIPE, which every tool ends by.
        EXPECT_THAT(run.output, testing::ContainsRegex("codes (141 )?(0|141) 0")) << c.script;
        EXPECT_THAT(run.output, testing::Not(HasSubstr("overcast:"))) << c.script;
    }
}

} // namespace
} // namespace ovc
