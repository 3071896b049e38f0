// SPDX-License-Identifier: Apache-2.0
// Tests the completion and the man page with the shells and with groff, where they are installed.
#include "tests/run_command.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace ovc {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsSupersetOf;

constexpr const char* kOvercast = OVC_BINARY_DIR "/bin/overcast";

bool is_installed(const std::string& program) {
    return test::run_shell("command -v " + program).exit_code == 0;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

/// Returns the words that bash offers for the last of these. As in bash, "=" is a word by itself.
std::vector<std::string> bash_offers(const std::string& words) {
    const std::string script = "source <(" + std::string(kOvercast) +
                               " completion bash); cd " OVC_SOURCE_DIR "; COMP_WORDS=(" + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _overcast; "
                               "printf \"%s\\n\" \"${COMPREPLY[@]}\"";
    return lines_of(test::run_shell("bash -c '" + script + "'").output);
}

TEST(BashCompletion, OffersCommandsOptionsChoicesScenesAndFiles) {
    if (!is_installed("bash"))
        GTEST_SKIP() << "bash is not installed";
    EXPECT_THAT(bash_offers("overcast re"), ElementsAre("render", "report"));
    EXPECT_THAT(bash_offers("overcast \"\""),
                IsSupersetOf({"trace", "diff", "completion", "help", "--version"}));
    EXPECT_THAT(bash_offers("overcast render --ou"), ElementsAre("--output", "--outfile"));
    EXPECT_THAT(bash_offers("overcast render --mode \"\""),
                ElementsAre("auto", "batched", "mixed"));
    EXPECT_THAT(bash_offers("overcast render --mode = mi"), ElementsAre("mixed"));
    EXPECT_THAT(bash_offers("overcast render --mode = "), IsSupersetOf({"auto", "mixed"}));
    EXPECT_THAT(bash_offers("overcast info --backend cpu"), ElementsAre("cpu-kdtree"));
    EXPECT_THAT(bash_offers("overcast render pla"), IsSupersetOf({"plants"}));
    EXPECT_THAT(bash_offers("overcast render dragons"), Contains("dragons-"));
    EXPECT_THAT(bash_offers("overcast render READ"), ElementsAre("README.md"));
    EXPECT_THAT(bash_offers("overcast diff a.png READ"), ElementsAre("README.md"));
    EXPECT_THAT(bash_offers("overcast completion f"), ElementsAre("fish"));
    EXPECT_THAT(bash_offers("overcast help tr"), ElementsAre("trace"));
    EXPECT_THAT(bash_offers("overcast render --size 1"), ElementsAre("")) << "nothing to offer";
}

/// Completion must offer the same options as a command's --help lists.
TEST(BashCompletion, OffersEveryOptionOfTheHelp) {
    if (!is_installed("bash"))
        GTEST_SKIP() << "bash is not installed";
    for (const char* command : {"render", "trace", "bench", "report", "diff"}) {
        const std::string help = test::run_shell(std::string(kOvercast) + " " + command +
                                                 " --help | grep -oE '^  -[-a-z0-9,]+'")
                                     .output;
        std::vector<std::string> offered = bash_offers("overcast " + std::string(command) + " -");
        size_t options = 0;
        for (std::string line : lines_of(help)) {
            std::istringstream names(line);
            for (std::string name; std::getline(names, name, ',');) {
                name.erase(0, name.find_first_not_of(' '));
                EXPECT_THAT(offered, Contains(name)) << command;
                ++options;
            }
        }
        EXPECT_GT(options, 5u) << help;
        EXPECT_EQ(options, offered.size()) << command;
    }
}

TEST(ZshCompletion, IsAScript) {
    if (!is_installed("zsh"))
        GTEST_SKIP() << "zsh is not installed";
    const auto checked =
        test::run_shell(std::string(kOvercast) + " completion zsh > /tmp/ovc_zsh_$$ && zsh -n "
                                                 "/tmp/ovc_zsh_$$; code=$?; rm /tmp/ovc_zsh_$$; "
                                                 "exit $code");
    EXPECT_EQ(checked.exit_code, 0) << checked.output;
    EXPECT_EQ(checked.output, "");
}

/// Returns the command that runs if somebody types "overcast rend", a tab and return after these
/// commands.
std::string zsh_runs(const std::string& setup) {
    const std::string script = "zmodload zsh/zpty; zpty shell \"TERM=dumb zsh -f -i\"; "
                               "zpty -w shell '" +
                               setup +
                               "; overcast() { print \"ran $*.\" }; print rea\"\"dy'; "
                               "while zpty -r shell line && [[ $line != *ready* ]]; do :; done; "
                               "zpty -w -n shell $'overcast rend\\t\\n'; "
                               "while zpty -r shell line; do "
                               "case $line in (*ran*|*found*) print -r -- $line; break; esac; done";
    const std::string file = testing::TempDir() + "ovc_zsh_" + std::to_string(getpid());
    std::ofstream(file) << script;
    const auto run = test::run_shell("HOME=/nonexistent timeout 60 zsh -f " + file);
    std::remove(file.c_str());
    return run.output;
}

TEST(ZshCompletion, WorksSourcedAndAutoloaded) {
    if (!is_installed("zsh"))
        GTEST_SKIP() << "zsh is not installed";
    const std::string source = "source <(" + std::string(kOvercast) + " completion zsh)";
    const std::string compinit = "autoload -Uz compinit; compinit -D -u";
    EXPECT_THAT(zsh_runs(source), testing::HasSubstr("ran render."));
    EXPECT_THAT(zsh_runs(compinit + "; " + source), testing::HasSubstr("ran render."));
    const std::string folder = testing::TempDir() + "ovc_zfunc_" + std::to_string(getpid());
    ASSERT_EQ(test::run_shell("mkdir -p " + folder + " && " + kOvercast + " completion zsh > " +
                              folder + "/_overcast")
                  .exit_code,
              0);
    EXPECT_THAT(zsh_runs("fpath=(" + folder + " $fpath); " + compinit),
                testing::HasSubstr("ran render."));
    test::run_shell("rm -r " + folder);
}

TEST(FishCompletion, OffersCommandsOptionsAndChoices) {
    if (!is_installed("fish"))
        GTEST_SKIP() << "fish is not installed";
    const auto offers = [](const std::string& words) {
        return test::run_shell("HOME=/nonexistent fish --no-config -c '" + std::string(kOvercast) +
                               " completion fish | source; complete -C \"" + words + "\"'")
            .output;
    };
    EXPECT_THAT(offers("overcast rend"), testing::StartsWith("render\t"));
    EXPECT_THAT(offers("overcast render --mode "), testing::HasSubstr("batched"));
    EXPECT_THAT(offers("overcast diff --hard"), testing::HasSubstr("--hardfail"));
    EXPECT_THAT(offers("overcast info pla"), testing::HasSubstr("plants"));
}

TEST(ManPage, IsSoundRoffWithEveryOptionOfTheHelp) {
    if (!is_installed("groff"))
        GTEST_SKIP() << "groff is not installed";
    const std::string set =
        std::string(kOvercast) + " man | groff -man -Tascii -ww -P-cbou -rLL=200n";
    const auto complaints = test::run_shell("{ " + set + "; } 2>&1 >/dev/null");
    EXPECT_EQ(complaints.output, "");
    const auto page = test::run_shell(set);
    EXPECT_EQ(page.exit_code, 0);
    for (const char* part :
         {"NAME", "overcast - ray tracing", "overcast render SCENE", "--gpu-memory SIZE",
          "-o, --output, --outfile FILE", "overcast diff A B", "--hardfail X",
          "overcast render dragon.ply -o d.png -o d.exr --size 1920x1080", "EXIT STATUS",
          "OVC_PLUGIN"})
        EXPECT_THAT(page.output, testing::HasSubstr(part));
}

} // namespace
} // namespace ovc
