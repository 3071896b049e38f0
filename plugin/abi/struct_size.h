// SPDX-License-Identifier: Apache-2.0
// Structs of the ABI, of this header or of an earlier one.
#pragma once

#include "core/text/format_text.h"
#include "plugin/structure/failure.h"

#include <cstddef>
#include <cstring>

namespace ovc {

/// Throws for a struct_size that is not of this header, nor of an earlier one, which had `least`
/// bytes at least.
template <class T>
void check_size(const char* name, size_t size, size_t least = sizeof(T)) {
    if (size < least || size > sizeof(T))
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      format_text("{}.struct_size is {}, expected sizeof({}) = {}", name, size,
                                  name, sizeof(T))};
}

/// The struct, with zeros for what an earlier header lacked. Throws as check_size().
template <class T>
T whole(const char* name, const T* given, size_t least = sizeof(T)) {
    check_size<T>(name, given->struct_size, least);
    T full{};
    std::memcpy(&full, given, given->struct_size);
    full.struct_size = sizeof(T);
    return full;
}

} // namespace ovc
