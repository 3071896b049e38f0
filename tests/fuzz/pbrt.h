// SPDX-License-Identifier: Apache-2.0
// The fuzzer and the test of damaged files read a text as a scene through this function.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ovc {

/// Reads `size` bytes as a .pbrt file, with a small limit of triangles, lenient and strict. Aborts
/// where the outcome is neither a sound scene nor one sentence about it.
void fuzz_pbrt(const uint8_t* data, size_t size);

} // namespace ovc
