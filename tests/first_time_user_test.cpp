// SPDX-License-Identifier: Apache-2.0
// Tests what goes wrong in a user's first hour, through a shell. Every command ends with one
// sentence, or quietly, and leaves no half-written file.
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kCommand = OVC_BINARY_DIR "/bin/overcast";

class FirstTimeUser : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::path(testing::TempDir()) / ("ovc_" + name + "_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Runs the script in bash, for its PIPESTATUS, in the test's own folder. $o is the command.
    test::CommandResult bash(const std::string& script) const {
        return test::run_shell("cd '" + folder_.string() + "' && o=" + kCommand + " bash -c '" +
                               script + "'");
    }

    bool is_folder_empty() const { return fs::is_empty(folder_); }

    fs::path folder_;
};

void expect_one_sentence(const test::CommandResult& run, const std::string& part) {
    EXPECT_EQ(run.exit_code, 1) << run.output;
    const std::string sentence = test::without_remarks(run.output);
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

TEST_F(FirstTimeUser, ReadsHelpWithoutStrayEscapes) {
    for (const char* command : {"render", "info", "trace", "convert", "devices", "doctor", "scenes",
                                "report", "bench", "diff", "completion", "man"}) {
        const auto help = bash("$o " + std::string(command) + " --help");
        EXPECT_EQ(help.exit_code, 0) << help.output;
        EXPECT_THAT(help.output, testing::Not(HasSubstr("\\"))) << command;
    }
}

/// The library of tests/broken_kernel differs from this one by a line of its kernel.
TEST_F(FirstTimeUser, HearsFromTheDoctorWhetherADeviceAnswersRight) {
    const auto right = bash("$o doctor");
    if (right.output.find("device     none") != right.output.npos)
        GTEST_SKIP() << right.output;
    EXPECT_EQ(right.exit_code, 0) << right.output;
    EXPECT_THAT(right.output, HasSubstr("answers    far-terrain: right, of "));
    EXPECT_THAT(right.output, testing::Not(HasSubstr("computes wrong")));
    const auto broken = bash("OVC_PLUGIN=" OVC_BINARY_DIR "/bin/libovercast-broken.so $o doctor");
    EXPECT_EQ(broken.exit_code, 1) << broken.output;
    EXPECT_THAT(broken.output, HasSubstr("rays are answered unlike double precision"));
    EXPECT_THAT(broken.output, HasSubstr("to do      The device's driver computes wrong"));
}

/// Commands that trace on the software renderer say so once, and not with --quiet.
TEST_F(FirstTimeUser, HearsOnceThatThereIsNoGpuWhereRaysAreTraced) {
    const std::string devices = bash("$o devices").output;
    if (devices.find("\n1 ") != devices.npos || devices.find("(software)") == devices.npos)
        GTEST_SKIP() << "there is a GPU, or no device at all:\n" << devices;
    for (const char* traces :
         {"render box --size 8x8", "trace box < /dev/null",
          "bench box --only certified --workloads primary --size 8x8 --repeats 1"}) {
        const std::string said = bash("$o " + std::string(traces)).output;
        const size_t first = said.find("overcast: no GPU found; using the software renderer ");
        EXPECT_NE(first, said.npos) << traces << ":\n" << said;
        EXPECT_EQ(said.find("no GPU", first + 20), said.npos) << traces << ":\n" << said;
    }
    for (const char* silent :
         {"render box --size 8x8 -q", "render box --size 8x8 --quiet --stats s.json",
          "convert box b.ovc", "convert box b.ply -q", "trace box --log-level warning < /dev/null"})
        EXPECT_EQ(bash("$o " + std::string(silent)).output, "") << silent;
    EXPECT_THAT(bash("$o info box").output, testing::Not(HasSubstr("no GPU")));
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
    // For a program that writes a file, a limit on its size is the same as a full disk.
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
    // Root may write anywhere, so the command runs as another user.
    const std::string as_user =
        geteuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups " : "";
    if (!as_user.empty() && bash(as_user + "$o --version").exit_code != 0)
        GTEST_SKIP() << "no other user can run the command here";
    expect_one_sentence(bash(as_user + "$o render box -o closed/a.png"),
                        "the folder cannot be written to: Permission denied");
    EXPECT_TRUE(fs::is_empty(folder_ / "closed"));
}

/// The command finds out before it reads anything, for none of the inputs exists.
TEST_F(FirstTimeUser, NamesAFolderThatTakesNoFiles) {
    for (const char* words :
         {"render no.ply -o /proc/a.png", "render no.ply --stats /proc/s.json",
          "convert no.ply /proc/a.ply", "convert no.ply /proc/a.ovc",
          "diff no.png no.png -o /proc/a.png; exit $(($? == 4))",
          "bench no.ply --json /proc/a.json", "report --only grid -o /proc/report"})
        expect_one_sentence(bash("$o " + std::string(words)), "/proc/");
    EXPECT_TRUE(is_folder_empty());
}

TEST_F(FirstTimeUser, IsToldWhereThereIsNothingToContinue) {
    const std::string render = "$o render box --size 8x8 --continue ";
    EXPECT_THAT(bash(render).output,
                HasSubstr("--continue: there is no out.unfinished.film to go on with"));
    EXPECT_THAT(bash(render).output, HasSubstr("all is there in out.png"));
    fs::remove(folder_ / "out.png");
    EXPECT_EQ(bash(render + "-q").output, "");
    std::ofstream(folder_ / "path.csv") << "0,0,9,0,0,0,40\n0,0,8,0,0,0,40\n";
    const std::string frames = render + "--camera-path path.csv -o f-#.png ";
    EXPECT_THAT(bash(frames + "--frames 0:0").output,
                HasSubstr("--continue: there is no frame f-#.png to go on with"));
    EXPECT_THAT(bash(frames).output, testing::Not(HasSubstr("to go on with")))
        << "frame 0 is there";
}

TEST_F(FirstTimeUser, AsksForMoreMemoryThanThereIs) {
    expect_one_sentence(bash("$o render box --gpu-memory 9999T"),
                        "--gpu-memory: '9999T' is more memory than any device has");
    EXPECT_TRUE(is_folder_empty());
    const std::string warned = "warning: --gpu-memory: 900.0 TiB is more than the ";
    for (const char* words : {"render box --size 8x8 -q", "info box", "trace box < /dev/null"})
        EXPECT_THAT(bash("$o " + std::string(words) + " --gpu-memory 900T").output,
                    HasSubstr(warned))
            << words;
    EXPECT_EQ(bash("$o render box --size 8x8 -q --gpu-memory 100M").output, "");
}

TEST_F(FirstTimeUser, IsToldWhatATerminalIsReadFor) {
    if (bash("command -v script").exit_code != 0)
        GTEST_SKIP() << "script, which makes a terminal, is not installed";
    const std::string told = "reading rays from the terminal, one a line: ox oy oz dx dy dz";
    EXPECT_THAT(bash("script -qec \"$o trace box\" /dev/null < /dev/null").output, HasSubstr(told));
    EXPECT_THAT(bash("$o trace box < /dev/null").output, testing::Not(HasSubstr("reading rays")));
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
        // 141 is the exit code that a shell reports for SIGPIPE, which ends any tool here.
        EXPECT_THAT(run.output, testing::ContainsRegex("codes (141 )?(0|141) 0")) << c.script;
        EXPECT_THAT(run.output, testing::Not(HasSubstr("overcast:"))) << c.script;
    }
}

} // namespace
} // namespace ovc
