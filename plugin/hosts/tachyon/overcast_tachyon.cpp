// SPDX-License-Identifier: Apache-2.0
// overcast-tachyon: Debian's tachyon, whose triangles Overcast finds.
#include "plugin/hosts/tachyon/settings.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;
using namespace ovc::tachyon;

static constexpr const char* kHelp =
    R"(usage: overcast-tachyon [--device NAME] [--gpu-memory BYTES] [tachyon's own arguments]

Runs the tachyon that PATH leads to, with its own reader of scenes, its own options and its own
shading; the triangles of the scene are found by Overcast. The picture is tachyon's.

  --device NAME        a number as `overcast devices` lists it, or a part of the renderer's name
  --gpu-memory BYTES   with K, M or G, such as 256M; by default what the driver has free
  --help               this text, and then tachyon's
)";

static constexpr const char* kLibrary = "libovercast_tachyon.so";

static int fail(const std::string& sentence) {
    std::fprintf(stderr, "overcast-tachyon: %s\n", sentence.c_str());
    return EXIT_FAILURE;
}

/// Returns the folders of libovercast.so and of ours, for LD_LIBRARY_PATH: this program's own where
/// it was built, else where both were installed. None: they are in neither.
static std::vector<std::string> find_libraries() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    const fs::path installed = (folder / OVC_LIBRARY_FROM_COMMAND).lexically_normal();
    if (!error && fs::exists(folder / kLibrary, error))
        return {folder.string()};
    if (!error && fs::exists(installed / "overcast" / kLibrary, error))
        return {installed.string(), (installed / "overcast").string()};
    return {};
}

/// Puts `more` before what a variable of the environment lists.
static void prepend(const char* variable, const std::string& more) {
    const char* others = std::getenv(variable);
    setenv(variable, (others && *others ? more + ":" + others : more).c_str(),
           /* overwrite= */ 1);
}

/// The environment that brings the library into tachyon and, where OVC_PLUGIN names another
/// libovercast.so, that one before ours. By name, as LD_PRELOAD knows no way to write a blank.
static void preload(const std::vector<std::string>& folders) {
    for (const std::string& folder : folders)
        prepend("LD_LIBRARY_PATH", folder);
    prepend("LD_PRELOAD", kLibrary);
    if (const char* plugin = std::getenv("OVC_PLUGIN"); plugin && *plugin)
        prepend("LD_PRELOAD", plugin);
}

int main(int argc, char** argv) {
    std::vector<char*> command = {const_cast<char*>("tachyon")};
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--help")
            std::fputs(kHelp, stdout);
        const bool device = word == "--device";
        if (!device && word != "--gpu-memory") {
            command.push_back(argv[i]);
            continue;
        }
        if (++i == argc)
            return fail(word + " is followed by nothing; expected " +
                        (device ? "the name of a device" : "bytes, such as 256M"));
        if (!device && !bytes_of(argv[i]))
            return fail(no_bytes(word, argv[i]));
        setenv(device ? kDevice : kGpuMemory, argv[i], /* overwrite= */ 1);
    }
    std::fflush(stdout);
    const std::vector<std::string> folders = find_libraries();
    if (folders.empty())
        return fail(std::string(kLibrary) +
                    " is neither beside this program nor where it installs");
    if (folders.front().find_first_of(":;") != std::string::npos)
        return fail("the libraries are in '" + folders.front() +
                    "'; they are found only in a folder without colons and semicolons");
    if (const char* plugin = std::getenv("OVC_PLUGIN"); plugin && std::strpbrk(plugin, " :"))
        return fail("OVC_PLUGIN is '" + std::string(plugin) +
                    "'; a file is preloaded only from a folder without blanks and colons");
    preload(folders);
    command.push_back(nullptr);
    execvp(command[0], command.data());
    return fail("cannot run tachyon: " + std::string(std::strerror(errno)) +
                "; Debian's package tachyon has it");
}
