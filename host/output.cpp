// SPDX-License-Identifier: Apache-2.0
// The table of image formats, the checks before rendering, and the rename at the end.
#include "host/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace ovc {

namespace fs = std::filesystem;

struct ImageFormat {
    std::string_view extension;
    Result<Done> (*write)(const Image&, const fs::path&);
};

static constexpr ImageFormat kFormats[] = {{".png", write_png}, {".exr", write_exr}};

static const ImageFormat* format_of(const fs::path& path) {
    std::string extension = path.extension();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    for (const ImageFormat& format : kFormats)
        if (format.extension == extension)
            return &format;
    return nullptr;
}

static fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Result<Done> check_writable(std::string_view what, const fs::path& path) {
    const fs::path folder = folder_of(path);
    std::error_code ignored;
    if (path.empty())
        return Error{fmt::format("the {} file has an empty name", what)};
    if (!fs::exists(folder, ignored))
        return Error{fmt::format("the folder '{}' of the {} file '{}' does not exist",
                                 folder.string(), what, path.string())};
    if (!fs::is_directory(folder, ignored))
        return Error{fmt::format("'{}' of the {} file '{}' is no folder", folder.string(), what,
                                 path.string())};
    if (fs::is_directory(path, ignored))
        return Error{fmt::format("the {} file '{}' is a folder", what, path.string())};
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{fmt::format("the folder '{}' of the {} file '{}' cannot be written to: {}",
                                 folder.string(), what, path.string(), std::strerror(errno))};
    return Done{};
}

Result<Done> check_image_output(const fs::path& path) {
    if (!format_of(path))
        return Error{
            fmt::format("the output file '{}' ends in neither .png nor .exr", path.string())};
    return check_writable("output", path);
}

Result<Done> write_whole(const fs::path& path,
                         const std::function<Result<Done>(const fs::path&)>& write) {
    // In the same folder, for a rename across file systems would copy; the process id keeps two
    // runs apart.
    const fs::path temporary =
        folder_of(path) / fmt::format(".{}.{}.part", path.filename().string(), getpid());
    const auto failed = [&](const std::string& why) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        return Error{fmt::format("cannot write '{}': {}", path.string(), why)};
    };
    if (const Result<Done> written = write(temporary); !written)
        return failed(written.error().message);
    std::error_code error;
    fs::rename(temporary, path, error);
    if (error)
        return failed(error.message());
    return Done{};
}

Result<Done> save_image(const Image& image, const fs::path& path) {
    return write_whole(path, [&](const fs::path& temporary) -> Result<Done> {
        const ImageFormat* format = format_of(path);
        if (!format)
            return Error{"its extension is neither .png nor .exr"};
        return format->write(image, temporary);
    });
}

Result<Done> save_text(std::string_view text, const fs::path& path) {
    return write_whole(path, [&](const fs::path& temporary) -> Result<Done> {
        std::ofstream file(temporary, std::ios::binary);
        file << text;
        file.close();
        if (!file)
            return Error{std::strerror(errno)};
        return Done{};
    });
}

} // namespace ovc
