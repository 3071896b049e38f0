// SPDX-License-Identifier: Apache-2.0
// The table of the C ABI, and its structs with their size set, for tests and fuzzers.
#pragma once

#include "plugin/overcast.h"

namespace ovc::test {

inline const ovc_api& api() {
    return *ovc_get_api(OVC_ABI_VERSION);
}

template <class T>
T sized() {
    T value{};
    value.struct_size = sizeof(T);
    return value;
}

} // namespace ovc::test
