// SPDX-License-Identifier: Apache-2.0
#include "gpu/gl/gl_libraries.h"

#include "core/text/format_text.h"
#include "core/text/lower_case.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

namespace ovc {

namespace fs = std::filesystem;

namespace {

/// Opens a library for good. Returns the reason if that fails, else nothing.
std::string refusal_of(const char* library) {
    if (dlopen(library, RTLD_LAZY | RTLD_LOCAL))
        return {};
    const char* reason = dlerror();
    return reason ? reason : "no reason given";
}

/// dlerror() has no codes; these are the words of glibc and musl when they cannot map memory.
bool is_for_memory(const std::string& reason) {
    for (const char* words : {"annot allocate memory", "failed to map segment", "ut of memory"})
        if (reason.find(words) != std::string::npos)
            return true;
    return false;
}

Error missing(const std::string& reasons, const char* packages) {
    if (is_for_memory(reasons))
        return {format_text("no memory to load OpenGL: {}; allow this process more address space "
                            "(ulimit -v)",
                            reasons),
                ErrorKind::OutOfMemory};
    return {format_text("OpenGL is missing: {}; install {}", reasons, packages)};
}

bool is_true(const char* value) {
    if (!value)
        return false;
    const std::string text = lower_case(value);
    return text == "1" || text == "true" || text == "yes" || text == "y" || text == "t" ||
           text == "on";
}

fs::path home_folder() {
    if (const char* home = std::getenv("HOME"); home && *home)
        return home;
    passwd user{};
    passwd* found = nullptr;
    char room[4096];
    if (getpwuid_r(getuid(), &user, room, sizeof(room), &found) == 0 && found && found->pw_dir)
        return found->pw_dir;
    return {};
}

} // namespace

Result<Done> open_gl_libraries() {
    if (const std::string reason = refusal_of("libEGL.so.1"); !reason.empty())
        return missing(reason, "libegl1");
    const std::string reason = refusal_of("libOpenGL.so.0");
    if (reason.empty())
        return Done{};
    const std::string other = refusal_of("libGL.so.1");
    if (other.empty())
        return Done{};
    return missing(reason + "; " + other, "libopengl0 (or libgl1)");
}

std::optional<fs::path> mesa_shader_cache() {
    if (is_true(std::getenv("MESA_SHADER_CACHE_DISABLE")) ||
        is_true(std::getenv("MESA_GLSL_CACHE_DISABLE")))
        return std::nullopt;
    for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
        if (const char* value = std::getenv(name); value && *value)
            return fs::path(value) / "mesa_shader_cache";
    if (const fs::path home = home_folder(); !home.empty())
        return home / ".cache" / "mesa_shader_cache";
    return std::nullopt;
}

Result<Done> reserve_shader_cache_index(const fs::path& folder) {
    constexpr off_t kIndexBytes = 8 + 65536 * 20; // src/util/disk_cache_os.c of Mesa 17 to 24
    std::error_code failed;
    fs::create_directories(folder, failed);
    const int file =
        open((folder / "index").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file < 0) // Mesa cannot open it either, and goes without a cache
        return Done{};
    const int refused = posix_fallocate(file, 0, kIndexBytes);
    close(file);
    if (refused != ENOSPC && refused != EDQUOT)
        return Done{};
    return Error{
        format_text("the disk is full under Mesa's shader cache, {}, where its driver "
                    "would crash: free {} KiB there, or set MESA_SHADER_CACHE_DISABLE=true "
                    "or MESA_SHADER_CACHE_DIR to another folder",
                    folder.string(), (kIndexBytes + 1023) / 1024)};
}

} // namespace ovc
