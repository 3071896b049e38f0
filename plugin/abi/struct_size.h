// SPDX-License-Identifier: Apache-2.0
// Checks and reads structs of the ABI that may be those of an earlier header.
#pragma once

#include "core/text/format_text.h"
#include "plugin/structure/failure.h"

#include <cassert>
#include <cstddef>
#include <cstring>

namespace ovc {

/// Throws a Failure for a struct_size that is neither that of this header nor of an earlier one,
/// whose fields are whole. min_size: the size of T in the first header that had it.
template <class T>
void check_size(const char* name, size_t size, size_t min_size = sizeof(T)) {
    assert(min_size <= sizeof(T));
    if (size < min_size || size > sizeof(T) || size % alignof(T) != 0)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      format_text("{}.struct_size is {}, expected sizeof({}) = {}", name, size,
                                  name, sizeof(T))};
}

/// Returns the struct, with zeros for fields that an earlier header lacked. Throws as check_size().
template <class T>
T whole(const char* name, const T* given, size_t min_size = sizeof(T)) {
    check_size<T>(name, given->struct_size, min_size);
    T full{};
    std::memcpy(&full, given, given->struct_size);
    full.struct_size = sizeof(T);
    return full;
}

} // namespace ovc
