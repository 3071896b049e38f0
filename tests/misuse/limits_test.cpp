// SPDX-License-Identifier: Apache-2.0
// Tests hosts on machines that refuse threads, address space, libraries or disk space. A call ends
// with a sentence and a code, or with the right answer, and never ends the process.
#include "gpu/gl/gl_libraries.h"
#include "tests/run_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace ovc {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

/// Runs the C99 host with variables of the environment or a command of the shell in front.
test::CommandResult host(const std::string& before) {
    return test::run_shell(before + " " OVC_BINARY_DIR "/bin/c99_host " OVC_BINARY_DIR
                                    "/bin/libovercast.so.1");
}

class Limits : public testing::Test {
protected:
    void SetUp() override {
        if (host("").exit_code != 0)
            GTEST_SKIP() << "no device, or sanitizers";
    }
};

TEST_F(Limits, APlatformThatIsNoneIsSaidBothWhereDevicesAreListedAndOpened) {
    const auto listed =
        test::run_shell("EGL_PLATFORM=nonsense " OVC_BINARY_DIR "/bin/overcast devices");
    for (const auto& run : {listed, host("EGL_PLATFORM=nonsense")}) {
        EXPECT_EQ(run.exit_code, 1) << run.output;
        EXPECT_THAT(run.output, HasSubstr("EGL_PLATFORM is set to 'nonsense'"));
    }
}

TEST_F(Limits, AThreadThatIsRefusedIsOutOfMemory) {
    int refused = 0;
    for (int threads = 0; threads < 12; ++threads) {
        const auto run = host("OVC_TEST_THREADS=" + std::to_string(threads) +
                              " LD_PRELOAD=" OVC_BINARY_DIR "/bin/librefuse_threads.so");
        ASSERT_THAT(run.exit_code, AnyOf(0, 1)) << threads << " threads: " << run.output;
        if (run.exit_code == 1) {
            EXPECT_THAT(run.output, HasSubstr("the system refuses a thread")) << threads;
        }
        refused += run.exit_code;
    }
    EXPECT_GT(refused, 1);
    EXPECT_LT(refused, 12);
}

TEST_F(Limits, ARenderingWithoutAThreadForItsOtherLaneEndsAndIsWhole) {
    const fs::path picture =
        fs::path(testing::TempDir()) / ("threads_" + std::to_string(getpid()) + ".png");
    std::string expected; // the bytes of the first picture
    for (int threads = 24; threads-- > 0;) {
        fs::remove(picture);
        // So small a budget lets lanes wait for each other.
        const auto run = test::run_shell(
            "OVC_TEST_THREADS=" + std::to_string(threads) +
            " LD_PRELOAD=" OVC_BINARY_DIR "/bin/librefuse_threads.so timeout 60 " OVC_BINARY_DIR
            "/bin/overcast render glass --size 32x32 --gpu-memory 300K -o '" +
            picture.string() + "'");
        ASSERT_THAT(run.exit_code, AnyOf(0, 1)) << threads << " threads: " << run.output;
        if (run.exit_code == 1) {
            EXPECT_THAT(run.output, HasSubstr("the system refuses a thread")) << threads;
            continue;
        }
        std::ifstream file(picture, std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(file), {});
        if (expected.empty())
            expected = bytes;
        EXPECT_EQ(bytes, expected) << threads << " threads";
    }
    EXPECT_FALSE(expected.empty());
    fs::remove(picture);
}

TEST_F(Limits, PagesAreReadWithoutThreadsToReadThemAhead) {
    for (int threads = 0; threads < 4; ++threads) {
        const auto run = test::run_shell(
            "OVC_TEST_THREADS=" + std::to_string(threads) +
            " LD_PRELOAD=" OVC_BINARY_DIR "/bin/librefuse_threads.so " OVC_BINARY_DIR
            "/bin/plugin_test --gtest_filter=PageCache.WhatWasReadAheadMakesRoomForWhatIsNeeded");
        EXPECT_EQ(run.exit_code, 0) << threads << " threads: " << run.output;
    }
}

TEST_F(Limits, LittleAddressSpaceIsASentence) {
    int refused = 0;
    for (int mib = 20; mib < 700; mib += 23) {
        const auto run = host("ulimit -v " + std::to_string(mib * 1024) + ";");
        if (run.exit_code == 127 || run.output.find("error while loading") != std::string::npos)
            continue; // Not even the host itself starts.
        ASSERT_THAT(run.exit_code, AnyOf(0, 1)) << mib << " MiB: " << run.output;
        EXPECT_THAT(run.output, Not(HasSubstr("internal error"))) << mib << " MiB";
        refused += run.exit_code;
    }
    EXPECT_GT(refused, 0);
}

TEST_F(Limits, MissingLibrariesOfOpenGlAreNamedWithTheirPackage) {
    const fs::path folder = fs::path(testing::TempDir()) / ("no_gl_" + std::to_string(getpid()));
    fs::create_directories(folder);
    const auto hide = [&](const char* library) { std::ofstream(folder / library) << "none"; };
    hide("libOpenGL.so.0");
    const auto one = host("LD_LIBRARY_PATH=" + folder.string());
    EXPECT_EQ(one.exit_code, 0) << "libGL.so.1 serves as well: " << one.output;
    hide("libGL.so.1");
    const auto both = host("LD_LIBRARY_PATH=" + folder.string());
    EXPECT_EQ(both.exit_code, 1);
    EXPECT_THAT(both.output, HasSubstr("install libopengl0 (or libgl1)"));
    hide("libEGL.so.1");
    const auto egl = host("LD_LIBRARY_PATH=" + folder.string());
    EXPECT_EQ(egl.exit_code, 1);
    EXPECT_THAT(egl.output, HasSubstr("install libegl1"));
    fs::remove_all(folder);
}

/// Runs body in a process of its own, which has a disk of 64 KiB at `folder`. Returns the result of
/// body, or -1 if the system does not allow such a disk.
template <class Body>
int on_a_small_disk(const fs::path& folder, Body&& body) {
    fs::create_directories(folder);
    const pid_t child = fork();
    if (child == 0) {
        const bool there = unshare(CLONE_NEWNS | (getuid() ? CLONE_NEWUSER : 0)) == 0 &&
                           mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                           mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=64k") == 0;
        _exit(there ? body() : 255);
    }
    int status = 0;
    waitpid(child, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 254;
    return code == 255 ? -1 : code;
}

TEST(ShaderCache, AFullDiskIsToldBeforeTheDriverCrashesOnIt) {
    const fs::path folder = fs::path(testing::TempDir()) / ("disk_" + std::to_string(getpid()));
    const int refused = on_a_small_disk(
        folder, [&] { return reserve_shader_cache_index(folder / "mesa_shader_cache") ? 0 : 1; });
    if (refused < 0)
        GTEST_SKIP() << "no small disk can be mounted here";
    EXPECT_EQ(refused, 1);
    const int code = on_a_small_disk(folder, [&] {
        const auto run = host("MESA_SHADER_CACHE_DIR=" + folder.string());
        const bool told = run.output.find("the disk is full under") != std::string::npos;
        return run.exit_code == 1 && told ? 1 : 2;
    });
    EXPECT_EQ(code, 1);
    const int without = on_a_small_disk(folder, [&] {
        return host("MESA_SHADER_CACHE_DISABLE=true MESA_SHADER_CACHE_DIR=" + folder.string())
            .exit_code;
    });
    EXPECT_EQ(without, 0) << "as the sentence says";
    fs::remove_all(folder);
}

TEST(ShaderCache, ADiskWithRoomIsReserved) {
    const fs::path folder = fs::path(testing::TempDir()) / ("cache_" + std::to_string(getpid()));
    ASSERT_TRUE(reserve_shader_cache_index(folder));
    EXPECT_GT(fs::file_size(folder / "index"), 1'000'000u);
    ASSERT_TRUE(reserve_shader_cache_index(folder)) << "again";
    fs::remove_all(folder);
}

} // namespace
} // namespace ovc
