// SPDX-License-Identifier: Apache-2.0
// QueuedScene: a scene of two-level as the thesis has it, with level 1 on the CPU, the pages of its
// leaves, and the pool that they take turns in. Based on: thesis, section 3.3 (algorithm 2).
#pragma once

#include "core/system/log.h"
#include "gpu/gl/gl_thread.h"
#include "plugin/build/built_scene.h"
#include "plugin/overcast.h"
#include "plugin/thesis/level1/level1_walk.h"
#include "plugin/thesis/queued/leaf_passes.h"

#include <memory>

namespace ovc::thesis {

struct QueuedOptions {
    uint64_t budget_bytes = 0;   // 0: the device's default
    uint64_t leaf_triangles = 0; // 0: a tenth of the scene
    uint64_t leaves = 0;         // about this many, where leaf_triangles is 0; 0: ten
    bool certify = true;         // false: fast precision
    ovc_level1 level1 = OVC_LEVEL1_KD_TREE;
    ovc_level1_build build = OVC_LEVEL1_BUILD_TOP_DOWN;
};

struct QueuedScene {
    QueuedScene(const Soup& soup, GlThread& gl_, bool certify_)
        : built(soup), gl(gl_), certify(certify_) {}
    ~QueuedScene();
    QueuedScene(const QueuedScene&) = delete;

    BuiltScene built;
    GlThread& gl;
    bool certify;
    ovc::MemoryPlan plan;
    Level1Walk walk;
    std::unique_ptr<LeafPasses> passes; // made and destroyed on the thread of gl; none: no leaves
    ovc_statistics statistics{sizeof(ovc_statistics)};
};

/// Returns the scene, which the soup and the thread must outlive. Error: a budget that is too
/// small, with the smallest that works; too many triangles; GL's refusals.
Result<std::unique_ptr<QueuedScene>> build_queued_scene(const Soup& soup, GlThread& gl,
                                                        const QueuedOptions& options,
                                                        const LogSink& log,
                                                        BuildProgress* progress = nullptr);

} // namespace ovc::thesis
