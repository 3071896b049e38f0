// SPDX-License-Identifier: Apache-2.0
// A picture is made of the light on a film, and written to files: linear, or for a display.
#pragma once

#include "core/file/pixel_source.h"
#include "core/result.h"
#include "host/film/film.h"
#include "host/output/output.h"
#include "host/output/tone_mapping.h"

#include <optional>
#include <span>
#include <string>

namespace ovc {

/// The steps from the light on a film to the tones of its files.
struct Development {
    std::optional<Exposure> exposure;
    ToneMap tone_map = ToneMap::None; // of files for displays
};

struct DevelopedImage {
    PixelSource light;           // linear, after its exposure
    std::optional<double> stops; // of that exposure, where there is one
};

/// Returns the linear light of a film, which outlives it. gamma: of the scene (Scene::gamma).
PixelSource light_of(const Film& film, double gamma);

/// Returns the picture that is made of linear light.
DevelopedImage develop(PixelSource light, const Development& how);

/// Returns what a display shows of it: linear light again.
PixelSource for_display(const DevelopedImage& developed, const Development& how);

/// Writes the picture to each file: its light to formats that hold layers, and tones for a display
/// to others. contents: besides the exposure, which it notes. It tries every file; on errors it
/// returns the first.
Result<Done> save_picture(const DevelopedImage& developed, std::span<const std::string> files,
                          const Development& how, FileContents contents);

} // namespace ovc
