// SPDX-License-Identifier: Apache-2.0
// The fuzzers and the tests of damaged files read bytes as a scene through these functions.
#pragma once

#include "core/scene.h"

#include <cstddef>
#include <cstdint>

namespace ovc {

/// Each reads `size` bytes as a file of its kind. Aborts where the outcome is neither a sound scene
/// nor one sentence about it.
void fuzz_ply(const uint8_t* data, size_t size);
void fuzz_obj(const uint8_t* data, size_t size);
/// A picture of POV-Ray, and a file of densities.
void fuzz_pictures(const uint8_t* data, size_t size);
/// Here the bytes say how a scene file is damaged (core/file/test_archive.h); an odd first byte
/// makes the checksums right again.
void fuzz_ovc(const uint8_t* data, size_t size);

/// A scene with something in every field that a scene file keeps.
Scene scene_with_everything();

} // namespace ovc
