// SPDX-License-Identifier: Apache-2.0
// Turns GL's error flag into a sentence.
#pragma once

#include "core/result.h"

namespace ovc {

/// Clears GL's error flags. doing: "tracing a pass", for the message. The context must be current.
/// Error: the first flag; GL_OUT_OF_MEMORY is of the kind OutOfGpuMemory.
Result<Done> check_gl(const char* doing);

} // namespace ovc
