// SPDX-License-Identifier: Apache-2.0
// Output: image formats by extension, and files that appear whole or not at all.
#pragma once

#include "core/image.h"
#include "core/result.h"

#include <filesystem>
#include <functional>
#include <string_view>

namespace ovc {

/// Whether `path` can be written: its folder exists and lets us write, and it is no folder itself.
/// `what` names the file in the error: "output", "statistics".
Result<Done> check_writable(std::string_view what, const std::filesystem::path& path);

/// check_writable, and the extension is one of an image format of ours.
Result<Done> check_image_output(const std::filesystem::path& path);

/// Writes a file under a temporary name in the folder of `path` and gives it its name once `write`
/// succeeded. On an error what was at `path` stays, and nothing else remains.
Result<Done> write_whole(const std::filesystem::path& path,
                         const std::function<Result<Done>(const std::filesystem::path&)>& write);

/// Writes `image` in the format of the extension, whole.
Result<Done> save_image(const Image& image, const std::filesystem::path& path);

/// Writes `text`, whole.
Result<Done> save_text(std::string_view text, const std::filesystem::path& path);

/// One format each; the error says only what went wrong, the caller names the file.
Result<Done> write_png(const Image& image, const std::filesystem::path& path);
Result<Done> write_exr(const Image& image, const std::filesystem::path& path);

} // namespace ovc
