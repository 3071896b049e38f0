// SPDX-License-Identifier: Apache-2.0
// Draws pictures of one scene with several programs and settings, and measures what each costs and
// how far it is from a reference picture.
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

/// A command that writes a picture to a file.
struct PictureChoice {
    std::string name; // "certified, 4 samples"
    std::vector<std::string> command;
    std::filesystem::path picture; // .exr, or .ppm of linear light
    std::filesystem::path stats;   // from `overcast render --stats`; empty for another program
};

struct PictureCost {
    std::string name;
    std::vector<double> seconds;     // wall clock of whole processes, one for each run
    std::vector<double> cpu_seconds; // of all threads
    std::optional<uint64_t> host_peak_bytes, gpu_peak_bytes, bytes_in; // overcast alone has these
    double rmse = 0; // over red, green and blue of all pixels, in linear light; white is 1
};

struct PictureRace {
    std::vector<PictureCost> choices; // in the order given
    bool complete = false;            // false: the race was stopped
};

/// Returns the picture of an .exr or .ppm file in linear light. Error: a sentence that names the
/// file.
Result<Image> read_linear_picture(const std::filesystem::path& path);

/// Returns the root mean square difference over the colors of all pixels, without opacity. Both
/// pictures have the same size (asserted).
double color_rmse(const Image& a, const Image& b);

/// Runs the reference once, then the choices in turn, `runs` times, and compares the picture of
/// each with the reference's. Error: a program that fails, a picture of another size.
Result<PictureRace> race_pictures(const PictureChoice& reference,
                                  std::span<const PictureChoice> choices, uint32_t runs,
                                  const StopRequest& stop);

/// Returns the command `overcast render` of this program on a file of POV-Ray's language, with the
/// settings in `words`. stem: the picture's path without its extension.
PictureChoice overcast_picture(const std::string& name, const std::filesystem::path& scene,
                               uint32_t size, const std::vector<std::string>& words,
                               const std::filesystem::path& stem);
/// Returns the command povray on the same file. depth: rays a pixel in each direction; 1: one ray
/// through its middle.
PictureChoice povray_picture(const std::string& name, const std::filesystem::path& scene,
                             uint32_t size, uint32_t depth, const std::filesystem::path& stem);

} // namespace ovc
