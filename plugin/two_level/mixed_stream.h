// SPDX-License-Identifier: Apache-2.0
// The mixed form over two-level: a stream of rays of both kinds.
#pragma once

#include "core/stream/stream.h"
#include "plugin/two_level/pass_runner.h"

namespace ovc {

/// Traces the rays that the host pushes until there are no more. Error of the kind Cancelled: the
/// host stopped it; else: a pass failed.
Result<Done> trace_stream(const Tracing& tracing, PassRunner& passes, StreamHost& host);

} // namespace ovc
