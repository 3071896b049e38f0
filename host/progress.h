// SPDX-License-Identifier: Apache-2.0
// Progress: one line on a terminal that overwrites itself; nothing on a pipe.
#pragma once

#include "core/stopwatch.h"
#include "host/backend.h"
#include "host/render.h"

#include <cstdint>
#include <string>

namespace ovc {

class Progress {
public:
    /// label: what the line begins with, such as "frame 7, "; may be empty. shown: false keeps it
    /// silent even on a terminal.
    Progress(const Backend& backend, std::string label, uint64_t pixel_count, bool shown);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(const RenderReport& report);

private:
    const Backend& backend_;
    std::string label_;
    uint64_t pixel_count_;
    bool shown_;
    Stopwatch watch_;
    double last_seconds_ = 0;
};

} // namespace ovc
