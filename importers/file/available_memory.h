// SPDX-License-Identifier: Apache-2.0
// How much memory a scene may still take.
#pragma once

#include <cstdint>

namespace ovc {

/// Bytes the system says can be had without swapping, no more than what this process' control
/// group leaves it. A guess for refusing what can never fit; huge where nothing is known.
uint64_t available_memory();

} // namespace ovc
