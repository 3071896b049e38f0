// SPDX-License-Identifier: Apache-2.0
// available_memory() estimates how much memory a scene may still take.
#pragma once

#include <cstdint>

namespace ovc {

/// Returns the bytes that the system says it can give without swapping, at most what the control
/// group leaves this process; the max of uint64_t if neither is known. It is a guess, good for
/// refusing scenes that can never fit.
uint64_t available_memory();

} // namespace ovc
