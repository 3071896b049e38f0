// SPDX-License-Identifier: Apache-2.0
// The libFuzzer target: fuzz_pbrt CORPUS -max_len=4096 (docs/design/fuzzing.md).
#include "tests/fuzz/pbrt.h"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data,
                                                                             size_t size) {
    ovc::fuzz_pbrt(data, size);
    return 0;
}
