// SPDX-License-Identifier: Apache-2.0
// The sentences on triangles that no structure holds, because no ray can hit them.
#pragma once

#include "core/soup.h"
#include "core/system/log.h"
#include "core/text/format_text.h"

namespace ovc {

/// Says how many triangles a structure leaves out, a warning for each reason.
inline void warn_of_dropped(const Dropped& dropped, const LogSink& log) {
    if (dropped.not_finite)
        say(log, LogLevel::Warning,
            format_text("left out {} triangles with a NaN or infinite corner", dropped.not_finite));
    if (dropped.degenerate)
        say(log, LogLevel::Warning,
            format_text("left out {} triangles without area", dropped.degenerate));
}

} // namespace ovc
