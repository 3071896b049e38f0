// SPDX-License-Identifier: Apache-2.0
// Reads rays from one file descriptor and writes their hits to another, in batches: the loop of
// `overcast trace`.
#pragma once

#include "core/result.h"
#include "host/backend/backend.h"

#include <cstddef>

namespace ovc {

struct TraceOptions {
    bool any = false; // occlusion; answers "hit" or "miss", in binary one byte, 1 or 0
    bool binary =
        false; // in: 8 doubles a ray; out: 3 doubles and 2 uint32 a hit; both as the C ABI has them
    size_t batch_rays = size_t(1) << 18; // at least 1
};

/// Reads rays until the end of `in` and answers each on `out` in order. A batch ends when it is
/// full or no more input is waiting, so that a program at both ends of a pipe gets its answers. An
/// Error names the line, or in binary the ray; the rays before it have been answered.
Result<Done> trace_stream(Backend& backend, int in, int out, const TraceOptions& options);

} // namespace ovc
