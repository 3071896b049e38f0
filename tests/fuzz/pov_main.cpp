// SPDX-License-Identifier: Apache-2.0
// The libFuzzer target: fuzz_pov CORPUS -max_len=4096 (docs/design/fuzzing.md).
#include "tests/fuzz/pov.h"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data,
                                                                             size_t size) {
    ovc::fuzz_pov(data, size);
    return 0;
}
