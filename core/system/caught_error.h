// SPDX-License-Identifier: Apache-2.0
// caught_error(): makes an Error of an exception where it can go no further, such as at the top of
// a thread, which it would leave by ending the process.
#pragma once

#include "core/result.h"

#include <exception>
#include <new>

namespace ovc {

/// Returns an error whose sentence is so short that its string takes no memory.
inline Error out_of_memory() noexcept {
    return {"out of memory", ErrorKind::OutOfMemory};
}

/// Returns the exception that the caller's catch block has caught; out_of_memory() where it is
/// std::bad_alloc, or where there is no memory for its sentence.
inline Error caught_error() noexcept try {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return {error.what()};
    } catch (...) {
        return {"unknown error"};
    }
} catch (const std::bad_alloc&) {
    return out_of_memory();
}

} // namespace ovc
