// SPDX-License-Identifier: Apache-2.0
// RenderJob: what `overcast render` was asked for, understood and checked; and its execution.
#pragma once

#include "host/arguments.h"
#include "host/backend.h"
#include "host/scene_source.h"
#include "host/whitted_batched.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// One picture of a sequence.
struct Shot {
    uint32_t frame = 0; // in the camera path
    Camera camera;
};

struct RenderJob {
    SceneArguments scene;
    std::vector<std::string> outputs; // with a # for each digit of the frame, where there are shots
    ImageSize size;
    std::optional<Camera> camera;
    std::vector<Shot> shots; // empty: one picture, from `camera` or the scene's own
    std::vector<PointLight> lights;
    WhittedOptions whitted;
    BackendOptions backend;
    std::string stats;
    bool quiet = false;
};

/// Builds the structure once and renders every shot. The result is the exit code.
Result<int> render(const RenderJob& job);

} // namespace ovc
