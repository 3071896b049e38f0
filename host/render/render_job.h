// SPDX-License-Identifier: Apache-2.0
// RenderJob: what `overcast render` was asked for, understood and checked; and its execution.
#pragma once

#include "host/arguments/arguments.h"
#include "host/backend/backend.h"
#include "host/output/aov.h"
#include "host/render/render.h"
#include "host/scene/scene_source.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// The most that --max-depth may ask for.
inline constexpr uint32_t kMaxDepth = 1000;

/// The most that --samples may ask for.
inline constexpr uint32_t kMaxSamples = 65536;

/// The most that --threads may ask for.
inline constexpr uint32_t kMaxThreads = 1024;

/// What is rendered of the picture.
struct Crop {
    uint32_t left = 0;
    uint32_t top = 0;
    ImageSize size;
};

/// One picture of a sequence.
struct Shot {
    uint32_t frame = 0; // in the camera path
    Camera camera;
};

struct RenderJob {
    SceneArguments scene;
    std::vector<std::string> outputs; // with a # for each digit of the frame, where there are shots
    std::optional<ImageSize> size;    // none: the scene's, else 512 x 512
    std::optional<Camera> camera;
    std::optional<int> up; // the axis that is up in the picture: 0, 1, 2; none: y, or the scene's
    std::optional<Crop> crop;
    std::vector<Shot> shots; // empty: one picture, from `camera` or the scene's own
    std::vector<Light> lights;
    RenderOptions render;
    std::optional<uint32_t> max_depth; // none: the scene's, else that of `render`
    uint32_t samples = 1;              // camera rays a pixel
    BackendOptions backend;
    Aovs aovs;         // in the outputs that take layers
    int png_bits = 8;  // a channel, 8 or 16
    std::string cache; // folder where scenes and levels are kept; empty: none
    std::string stats;
    bool go_on = false;       // from what an interrupted run has left
    uint32_t threads = 0;     // at most; 0: as many as there are cores
    std::string command_line; // as it was given, for files that keep it
    LogLevel log_level = LogLevel::Info;
    bool quiet = false;
};

/// Builds the structure once and renders every shot. The result is the exit code.
Result<int> render(const RenderJob& job);

} // namespace ovc
