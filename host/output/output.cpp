// SPDX-License-Identifier: Apache-2.0
// The table of image formats, the checks before rendering, and the writing of files.
#include "host/output/output.h"

#include "importers/file/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace ovc {

namespace fs = std::filesystem;

struct ImageFormat {
    std::string_view extension;
    bool layers;
    Result<std::string> (*encode)(const PixelSource&, const FileContents&);
};

static constexpr ImageFormat kFormats[] = {{".png", false, encode_png}, {".exr", true, encode_exr}};

static const ImageFormat* format_of(const fs::path& path) {
    std::string extension = path.extension();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    for (const ImageFormat& format : kFormats)
        if (format.extension == extension)
            return &format;
    return nullptr;
}

Result<Done> check_writable(std::string_view what, const fs::path& path) {
    if (path.empty())
        return Error{fmt::format("the {} file has an empty name", what)};
    if (const Result<Done> fine = OutputFile::check(path); !fine)
        return Error{fmt::format("the {} file {}", what, fine.error().message)};
    return Done{};
}

Result<Done> check_image_output(const fs::path& path) {
    if (!format_of(path))
        return Error{
            fmt::format("the output file '{}' ends in neither .png nor .exr", path.string())};
    return check_writable("output", path);
}

Result<Done> check_distinct(std::span<const NamedFile> files) {
    for (size_t i = 0; i < files.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (is_same_output(files[j].path, files[i].path))
                return Error{fmt::format("the {} file '{}' and the {} file '{}' are the same file",
                                         files[j].what, files[j].path.string(), files[i].what,
                                         files[i].path.string())};
    return Done{};
}

bool takes_layers(const fs::path& path) {
    const ImageFormat* format = format_of(path);
    return format && format->layers;
}

Result<Done> save_image(const PixelSource& image, const fs::path& path,
                        const FileContents& contents) {
    const ImageFormat* format = format_of(path);
    if (!format)
        return Error{
            fmt::format("the output file '{}' ends in neither .png nor .exr", path.string())};
    const Result<std::string> bytes = format->encode(image, contents);
    if (!bytes)
        return Error{
            fmt::format("{}: cannot be written: {}", path.string(), bytes.error().message)};
    return save_text(*bytes, path);
}

Result<Done> save_text(std::string_view text, const fs::path& path) {
    Result<OutputFile> file = OutputFile::create(path);
    if (!file)
        return file.error();
    file->write(text);
    return file->commit();
}

} // namespace ovc
