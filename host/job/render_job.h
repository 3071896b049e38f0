// SPDX-License-Identifier: Apache-2.0
// RenderJob holds the arguments of `overcast render`, parsed and checked; render() executes it.
#pragma once

#include "host/arguments/arguments.h"
#include "host/backend/backend.h"
#include "host/job/development.h"
#include "host/output/aov.h"
#include "host/output/denoiser.h"
#include "host/render/render.h"
#include "host/scene/scene_pictures.h"
#include "host/scene/scene_source.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// The maximum of --max-depth.
inline constexpr uint32_t kMaxDepth = 1000;

/// The maximum of --samples.
inline constexpr uint32_t kMaxSamples = 65536;

/// The maximum of --threads.
inline constexpr uint32_t kMaxThreads = 1024;

/// The part of the picture that is rendered, in pixels from its top left corner.
struct Crop {
    uint32_t left = 0;
    uint32_t top = 0;
    ImageSize size;
};

/// One picture of a sequence.
struct Shot {
    uint32_t frame = 0;           // in the camera path, where there is one
    std::optional<Camera> camera; // none: the scene's own
    Moment moment{};
};

struct RenderJob {
    SceneArguments scene;
    std::vector<std::string> outputs; // not empty; with a # for each digit of a shot's frame
    std::optional<ImageSize> size;    // none: the scene's, else 512 x 512
    std::optional<Camera> camera;
    std::optional<int> up; // the axis that is up in the picture, 0 to 2; none: the scene's, else y
    std::optional<Crop> crop;
    std::vector<Shot> shots; // empty: one picture, from `camera` or the scene's own
    std::vector<Light> lights;
    RenderOptions render;
    std::optional<double> lens_radius; // of the pictures' cameras; 0: no lens; none: their own
    std::optional<double> focus;       // the lens's distance; none: the cameras' target
    Development development;
    const Denoiser* denoiser = nullptr; // that finished pictures go through; or null
    bool view = false;                  // a window shows the picture, and each frame
    std::optional<uint32_t> max_depth;  // none: the scene's, else that of `render`
    std::optional<uint32_t> samples;    // camera rays a pixel; none: the scene's, else 1
    BackendOptions backend;
    Aovs aovs;                                       // in the outputs that take layers
    int png_bits = 8;                                // per channel, 8 or 16
    uint64_t texture_memory = kDefaultTextureMemory; // for the texels of pictures
    std::string cache; // the folder where scenes and levels are kept; empty: none
    std::string stats;
    std::string progress;     // the file or "-" that ProgressLines go to; empty: none
    bool go_on = false;       // continues an interrupted run from its files
    uint32_t threads = 0;     // maximum; 0: as many as there are cores
    std::string command_line; // as the user gave it, for files that keep it
    LogLevel log_level = LogLevel::Info;
    bool quiet = false;
};

/// Builds the structure once and renders every shot. Returns the exit code.
Result<int> render(const RenderJob& job);

} // namespace ovc
