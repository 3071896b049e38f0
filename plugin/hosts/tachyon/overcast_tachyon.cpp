// SPDX-License-Identifier: Apache-2.0
// overcast-tachyon: Debian's tachyon, whose triangles Overcast finds.
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;

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

/// Bytes of "256M"; nothing for what is no such number.
static std::optional<uint64_t> bytes_of(const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const uint64_t number = std::strtoull(text.c_str(), &end, 10);
    if (text.empty() || text[0] < '0' || text[0] > '9' || errno != 0)
        return std::nullopt;
    const std::string_view unit = end;
    const int shift = unit == "K"    ? 10
                      : unit == "M"  ? 20
                      : unit == "G"  ? 30
                      : unit.empty() ? 0
                                     : -1;
    if (shift < 0 || number == 0 || number > UINT64_MAX >> shift)
        return std::nullopt;
    return number << shift;
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

int main(int argc, char** argv) {
    std::vector<char*> command = {const_cast<char*>("tachyon")};
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool device = word == "--device";
        if (word == "--help")
            std::fputs(kHelp, stdout);
        if (!device && word != "--gpu-memory") {
            command.push_back(argv[i]);
            continue;
        }
        if (++i == argc)
            return fail(word + " is followed by nothing; expected " +
                        (device ? "the name of a device" : "bytes, such as 256M"));
        const std::optional<uint64_t> bytes = device ? 0 : bytes_of(argv[i]);
        if (!bytes)
            return fail("--gpu-memory " + std::string(argv[i]) +
                        " is no number of bytes; expected such as 256M");
        setenv(device ? "OVC_TACHYON_DEVICE" : "OVC_TACHYON_GPU_MEMORY",
               device ? argv[i] : std::to_string(*bytes).c_str(), /* overwrite= */ 1);
    }
    std::fflush(stdout);
    const std::optional<fs::path> library = find_library();
    if (!library)
        return fail(std::string(kLibrary) + " is neither beside this program nor in ../lib of it");
    const char* others = std::getenv("LD_PRELOAD");
    const std::string preload =
        library->string() + (others && *others ? ":" + std::string(others) : "");
    setenv("LD_PRELOAD", preload.c_str(), /* overwrite= */ 1);
    command.push_back(nullptr);
    execvp(command[0], command.data());
    return fail("cannot run tachyon: " + std::string(std::strerror(errno)) +
                "; Debian's package tachyon has it");
}
