// SPDX-License-Identifier: Apache-2.0
// The libFuzzer targets fuzz_ply, fuzz_obj and fuzz_ovc: OVC_FUZZED says which
// (docs/design/fuzzing.md).
#include "tests/fuzz/importers.h"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data,
                                                                             size_t size) {
    ovc::OVC_FUZZED(data, size);
    return 0;
}
