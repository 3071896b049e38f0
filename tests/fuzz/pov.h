// SPDX-License-Identifier: Apache-2.0
// The fuzzer and the test of damaged files read a text as a scene through this function.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ovc {

/// Reads `size` bytes as a .pov file, with small limits of words and triangles. Aborts where the
/// outcome is neither a sound scene nor a sentence about it.
void fuzz_pov(const uint8_t* data, size_t size);

} // namespace ovc
