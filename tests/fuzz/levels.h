// SPDX-License-Identifier: Apache-2.0
// The fuzzer and the tests of saved levels restore damaged levels and trace rays through them.
#pragma once

#include "plugin/build/built_scene.h"

#include <cstddef>
#include <cstdint>

namespace ovc {

/// Returns the scene of a soup as TwoLevel builds it, within these limits.
BuiltScene build_for_test(const Soup& soup, const LeafLimits& limits);

/// Damages saved levels as `data` says (core/file/test_archive.h), makes the checksums right if its
/// first byte is odd, and traces rays through what comes back. Aborts where that goes wrong.
void fuzz_levels(const uint8_t* data, size_t size);

} // namespace ovc
