// SPDX-License-Identifier: Apache-2.0
// What a rendering took: as JSON for programs (docs/stats.md) and as a few lines for people.
#pragma once

#include "host/whitted_batched.h"
#include "plugin/overcast.h"

#include <cstdint>
#include <string>

namespace ovc {

struct RenderStats {
    std::string scene;
    uint32_t width = 0;
    uint32_t height = 0;
    RenderReport report;
    ovc_statistics tracing{};
    std::string renderer;
    double seconds_import = 0;
    double seconds_output = 0;
    double seconds_total = 0;
};

/// The document of docs/stats.md, with a line end.
std::string stats_json(const RenderStats& stats);

/// A few lines for the terminal, with a line end.
std::string stats_summary(const RenderStats& stats);

/// The most memory this process has had resident so far.
uint64_t host_peak_bytes();

} // namespace ovc
