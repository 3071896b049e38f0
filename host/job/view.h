// SPDX-License-Identifier: Apache-2.0
// A view of a scene becomes a picture: it is rendered, and written to the job's outputs.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "host/job/render_job.h"
#include "host/job/watchers.h"
#include "host/output/stats.h"
#include "host/render/stage.h"
#include "host/terminal/interrupt.h"

#include <string>
#include <vector>

namespace ovc {

/// A picture's number, and the camera that takes it.
struct View {
    uint32_t frame = 0;
    Camera camera;
};

/// The scene of several views, the backend on its stage, and those who watch.
struct SceneOfViews {
    const RenderJob& job;
    const PicturePart& part;
    Scene& scene;
    Stage& stage;
    const InterruptGuard& interrupt;
    const LogSink& log;
    Watchers& watchers;
};

/// Returns the files that a frame's picture goes to.
std::vector<std::string> outputs_of(const RenderJob& job, uint32_t frame);

/// Renders a picture. Where it is interrupted, its pixels are kept beside its outputs, and
/// stats.report is not complete. begun: how long its scene took, and the stage's statistics before
/// that.
Result<Done> render_view(const SceneOfViews& of, const View& view, const FrameStats& begun,
                         RenderStats& stats);

} // namespace ovc
