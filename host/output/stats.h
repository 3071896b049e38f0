// SPDX-License-Identifier: Apache-2.0
// What a rendering took: as JSON for programs (docs/reference/stats.md) and as a few lines for
// people.
#pragma once

#include "host/render/render.h"
#include "host/scene/scene_summary.h"
#include "plugin/overcast.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// One picture of a run.
struct FrameStats {
    uint32_t frame = 0; // its number in the camera path; 0 for a picture without one
    RenderReport report;
    ovc_statistics tracing{}; // what was counted for this frame alone
    std::optional<ovc_active> active;
    uint64_t host_peak_bytes = 0; // of the process, up to its end
    double seconds_scene = 0; // before: reading the scene at its moment, and updating what is built
    double seconds_output = 0;
    double seconds = 0; // from its first ray to its last file
};

/// What `after` counts on top of `before`, two readings of one backend. What does not count up
/// (leaves, bytes of the structure, peaks) is that of `after`.
ovc_statistics counted_between(const ovc_statistics& before, const ovc_statistics& after);

/// Returns `now`, and what `earlier` has counted besides: a reading of another structure.
ovc_statistics counted_besides(const ovc_statistics& earlier, const ovc_statistics& now);

/// The counts of one of several ranks.
struct RankStats {
    ovc_statistics tracing{};
    RayCounts rays;
    uint64_t host_peak_bytes = 0;
    double seconds_cpu = 0;

    /// Returns the time in which it traced rays, its own or those of others.
    double seconds_busy() const { return tracing.seconds_trace - tracing.seconds_waiting; }
};

struct RenderStats {
    std::string scene;
    uint32_t width = 0;
    uint32_t height = 0;
    RenderReport report; // all frames together
    ovc_statistics tracing{};
    std::vector<FrameStats> frames; // those that are finished, and for a single picture also a part
    std::string renderer;
    std::vector<RankStats> ranks; // of a run of several; else empty, as the next
    std::vector<std::string> rank_names;
    std::vector<LeftOut> left_out;
    uint64_t frames_there = 0; // of an earlier run, not rendered
    bool scene_from_cache = false;
    double seconds_import = 0;
    double seconds_output = 0;
    double seconds_total = 0;

    /// Appends the frame and adds it to the totals.
    void add(const FrameStats& frame);
};

/// The document of docs/reference/stats.md, with a line end.
std::string stats_json(const RenderStats& stats);

/// The entry of that document's `frames`, in one line without its end.
std::string frame_json(const FrameStats& frame);

/// One line about a frame, without a line end.
std::string frame_summary(const FrameStats& frame);

/// A few lines for the terminal, with a line end.
std::string stats_summary(const RenderStats& stats);

/// The most memory this process has had resident so far.
uint64_t host_peak_bytes();

} // namespace ovc
