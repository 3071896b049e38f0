// SPDX-License-Identifier: Apache-2.0
// Writes images, in formats by extension, and other files. They appear whole or not at all.
#pragma once

#include "core/file/pixel_source.h"
#include "core/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// Checks that `path` can be written: its folder takes a new file, which is removed again, and if
/// the path exists it is a file, or a device or FIFO, which is written to as it is. `what` names
/// the file in the error: "output", "statistics".
Result<Done> check_writable(std::string_view what, const std::filesystem::path& path);

/// Checks the same, and that the extension is that of an image format of ours.
Result<Done> check_image_output(const std::filesystem::path& path);

/// A file of the command line and its purpose: "input", "output".
struct NamedFile {
    std::string_view what;
    std::filesystem::path path;
};

/// Checks that no two of the files are the same, whatever links lead there.
Result<Done> check_distinct(std::span<const NamedFile> files);

/// A channel besides the picture's: a word for each pixel, in the order of the picture's pixels.
struct Layer {
    enum class Type { Float, Uint };

    std::string name; // in OpenEXR's form: "depth.Z"
    Type type = Type::Float;
    std::vector<uint32_t> values; // a Float as its bits
};

/// Returns whether files of this name hold layers.
bool takes_layers(const std::filesystem::path& path);

/// A name and a text that an .exr file keeps with the picture.
struct FileNote {
    std::string name; // "overcast:version"
    std::string text;
};

/// The contents of a file besides its picture; a format without room for them drops them.
struct FileContents {
    std::vector<Layer> layers;   // .exr
    std::vector<FileNote> notes; // .exr
    int png_bits = 8;            // per channel, 8 or 16
};

/// Writes `image` in the format of the extension. On an error the file that was at `path` stays,
/// and nothing else remains.
Result<Done> save_image(const PixelSource& image, const std::filesystem::path& path,
                        const FileContents& contents = {});

/// Writes `text`; errors leave the same as those of save_image().
Result<Done> save_text(std::string_view text, const std::filesystem::path& path);

/// Each returns the bytes of a file in its format. The error does not name the file.
Result<std::string> encode_png(const PixelSource& image, const FileContents& contents = {});
Result<std::string> encode_exr(const PixelSource& image, const FileContents& contents = {});

} // namespace ovc
