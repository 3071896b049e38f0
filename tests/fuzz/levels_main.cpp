// SPDX-License-Identifier: Apache-2.0
// The libFuzzer target fuzz_levels (docs/design/fuzzing.md).
#include "tests/fuzz/levels.h"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data,
                                                                             size_t size) {
    ovc::fuzz_levels(data, size);
    return 0;
}
