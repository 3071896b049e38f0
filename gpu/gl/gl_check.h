// SPDX-License-Identifier: Apache-2.0
// GL's error flag as a sentence.
#pragma once

#include "core/result.h"

namespace ovc {

/// Takes the errors that GL has kept since it was last asked. doing: "tracing a pass". Needs the
/// context current.
Result<Done> check_gl(const char* doing);

} // namespace ovc
