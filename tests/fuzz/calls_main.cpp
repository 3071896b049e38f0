// SPDX-License-Identifier: Apache-2.0
// The libFuzzer target fuzz_calls (docs/design/fuzzing.md).
#include "tests/fuzz/calls.h"

#include <cstdlib>

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data,
                                                                             size_t size) {
    if (!ovc::fuzz_calls(data, size))
        std::abort(); // without a device it would find nothing
    return 0;
}
