// SPDX-License-Identifier: Apache-2.0
// overcast-tachyon: Debian's tachyon, whose triangles Overcast finds.
#include "plugin/hosts/tachyon/settings.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
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

/// Beside this program, or in ../lib of it.
static std::optional<fs::path> find_library() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& path : {folder / kLibrary, folder.parent_path() / "lib" / kLibrary})
        if (!error && fs::exists(path, error))
            return path;
    return std::nullopt;
}

/// The environment that brings the library into tachyon and, where OVC_PLUGIN names another
/// libovercast.so, that one before ours.
static void preload(const fs::path& library) {
    std::string list;
    if (const char* plugin = std::getenv("OVC_PLUGIN"); plugin && *plugin)
        list = std::string(plugin) + ":";
    list += library;
    if (const char* others = std::getenv("LD_PRELOAD"); others && *others)
        list += ":" + std::string(others);
    setenv("LD_PRELOAD", list.c_str(), /* overwrite= */ 1);
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
    const std::optional<fs::path> library = find_library();
    if (!library)
        return fail(std::string(kLibrary) + " is neither beside this program nor in ../lib of it");
    preload(*library);
    command.push_back(nullptr);
    execvp(command[0], command.data());
    return fail("cannot run tachyon: " + std::string(std::strerror(errno)) +
                "; Debian's package tachyon has it");
}
