// SPDX-License-Identifier: Apache-2.0
// Output: image formats by extension, and files that appear whole or not at all.
#pragma once

#include "core/file/image.h"
#include "core/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// Whether `path` can be written: its folder takes a new file, which is removed again, and what is
/// there already is a file, or a device or FIFO that is written to as it is. `what` names the file
/// in the error: "output", "statistics".
Result<Done> check_writable(std::string_view what, const std::filesystem::path& path);

/// check_writable, and the extension is one of an image format of ours.
Result<Done> check_image_output(const std::filesystem::path& path);

/// A file of the command line and what it is there for: "input", "output".
struct NamedFile {
    std::string_view what;
    std::filesystem::path path;
};

/// Whether no two of the files are the same, whatever links lead there.
Result<Done> check_distinct(std::span<const NamedFile> files);

/// A channel besides the picture's, a word a pixel, in the order of its pixels.
struct Layer {
    enum class Type { Float, Uint };

    std::string name; // as OpenEXR has it: "depth.Z"
    Type type = Type::Float;
    std::vector<uint32_t> values; // of a Float its bits
};

/// Whether files of this name hold layers.
bool takes_layers(const std::filesystem::path& path);

/// A name and a text that an .exr file keeps with the picture.
struct FileNote {
    std::string name; // "overcast:version"
    std::string text;
};

/// What goes into a file besides its picture, as far as its format has room for it.
struct FileContents {
    std::vector<Layer> layers;   // .exr
    std::vector<FileNote> notes; // .exr
    int png_bits = 8;            // a channel, 8 or 16
};

/// Writes `image` in the format of the extension. On an error what was at `path` stays, and nothing
/// else remains; so it is with save_text.
Result<Done> save_image(const Image& image, const std::filesystem::path& path,
                        const FileContents& contents = {});

/// Writes `text`.
Result<Done> save_text(std::string_view text, const std::filesystem::path& path);

/// The bytes of a file in one format each; the error says only what went wrong.
Result<std::string> encode_png(const Image& image, const FileContents& contents = {});
Result<std::string> encode_exr(const Image& image, const FileContents& contents = {});

} // namespace ovc
