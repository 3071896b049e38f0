// SPDX-License-Identifier: Apache-2.0
// RenderJob: what `overcast render` was asked for, understood and checked; and its execution.
#pragma once

#include "host/aov.h"
#include "host/arguments.h"
#include "host/backend.h"
#include "host/scene_source.h"
#include "host/whitted.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// The most that --max-depth may ask for.
inline constexpr uint32_t kMostDepth = 1000;

/// One picture of a sequence.
struct Shot {
    uint32_t frame = 0; // in the camera path
    Camera camera;
};

/// Algorithm 5 or 6 of the thesis. Auto is batched, which shades faster where all is resident
/// (docs/benchmarks.md).
enum class RenderMode { Auto, Batched, Mixed };

struct RenderJob {
    SceneArguments scene;
    std::vector<std::string> outputs; // with a # for each digit of the frame, where there are shots
    std::optional<ImageSize> size;    // none: the scene's, else 512 x 512
    std::optional<Camera> camera;
    std::vector<Shot> shots; // empty: one picture, from `camera` or the scene's own
    std::vector<Light> lights;
    WhittedOptions whitted;
    std::optional<uint32_t> max_depth; // none: the scene's, else that of `whitted`
    RenderMode mode = RenderMode::Auto;
    BackendOptions backend;
    Aovs aovs;         // in the outputs that take layers
    std::string cache; // folder where scenes and levels are kept; empty: none
    std::string stats;
    bool quiet = false;
};

/// Builds the structure once and renders every shot. The result is the exit code.
Result<int> render(const RenderJob& job);

} // namespace ovc
