// SPDX-License-Identifier: Apache-2.0
// Pictures of one scene by several programs and settings: what each costs, and how far it is from
// the picture that is right.
#pragma once

#include "core/file/image.h"
#include "core/result.h"
#include "host/bench/workload.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

/// A command that leaves a picture.
struct PictureChoice {
    std::string name; // "certified, 4 samples"
    std::vector<std::string> command;
    std::filesystem::path picture; // .exr, or .ppm of linear light
    std::filesystem::path stats;   // of `overcast render --stats`; empty: another program's
};

struct PictureCost {
    std::string name;
    std::vector<double> seconds;     // of wall clock, whole processes, one a run
    std::vector<double> cpu_seconds; // of all threads
    std::optional<uint64_t> host_peak_bytes, gpu_peak_bytes, bytes_in; // of overcast
    double rmse = 0; // over red, green and blue of all pixels, of linear light; white is 1
};

struct PictureRace {
    std::vector<PictureCost> choices; // as asked for
    bool complete = false;            // false: it was stopped
};

/// Linear light. Error: a sentence that names the file.
Result<Image> read_linear_picture(const std::filesystem::path& path);

/// Over the colors of all pixels, opacity left out. Pictures of one size (asserted).
double color_rmse(const Image& a, const Image& b);

/// Runs the reference once, whose picture is right, then each choice, in turn, `runs` times. Error:
/// a program that fails, a picture of another size.
Result<PictureRace> race_pictures(const PictureChoice& reference,
                                  std::span<const PictureChoice> choices, uint32_t runs,
                                  const StopRequest& stop);

/// `overcast render` of this program on a file of POV-Ray's language, and the settings in `words`.
PictureChoice overcast_picture(const std::string& name, const std::filesystem::path& scene,
                               uint32_t size, const std::vector<std::string>& words,
                               const std::filesystem::path& stem);
/// povray on the same file. depth: so many rays a pixel each way; 1: one through its middle.
PictureChoice povray_picture(const std::string& name, const std::filesystem::path& scene,
                             uint32_t size, uint32_t depth, const std::filesystem::path& stem);

} // namespace ovc
