// SPDX-License-Identifier: Apache-2.0
// Progress shows a line about the picture that is being rendered, on a terminal.
#pragma once

#include "core/system/stopwatch.h"
#include "host/backend/backend.h"
#include "host/render/render.h"
#include "host/terminal/terminal_line.h"

#include <cstdint>
#include <string>

namespace ovc {

class Progress {
public:
    /// label: the beginning of the line, such as "frame 7: "; may be empty. pixels_there: the
    /// pixels of pixel_count that an earlier run has done. shown: false keeps it silent even on a
    /// terminal.
    Progress(const Backend& backend, std::string label, uint64_t pixel_count, uint64_t pixels_there,
             bool shown);

    void update(const RenderReport& report);

private:
    /// Returns a text such as "40 s left, ", or an empty one while there is no estimate.
    std::string left(uint64_t pixels_done, double seconds) const;

    const Backend& backend_;
    std::string label_;
    uint64_t pixel_count_;
    uint64_t pixels_there_;
    TerminalLine line_;
    Stopwatch watch_;
    double last_seconds_ = 0;
};

} // namespace ovc
