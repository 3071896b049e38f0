// SPDX-License-Identifier: Apache-2.0
// caught_error(): makes an Error of an exception where it can go no further, such as at the top of
// a thread, which it would leave by ending the process.
#pragma once

#include "core/result.h"

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace ovc {

/// Returns an error whose sentence is so short that its string takes no memory.
inline Error out_of_memory() noexcept {
    return {"out of memory", ErrorKind::OutOfMemory};
}

/// Returns what to say where the system refuses a thread, for want of memory or because of a limit;
/// nothing where the error is another.
inline std::optional<Error> refused_thread(const std::exception& error) {
    const auto* const of_system = dynamic_cast<const std::system_error*>(&error);
    const bool is_refused =
        of_system ? of_system->code() == std::errc::resource_unavailable_try_again ||
                        of_system->code() == std::errc::not_enough_memory
                  : std::string_view(error.what()).starts_with("pthread_create"); // oneTBB's words
    if (!is_refused)
        return std::nullopt;
    return Error{std::string("the system refuses a thread: out of memory, or a limit (ulimit -u, a "
                             "container's pids) is reached: ") +
                     error.what(),
                 ErrorKind::OutOfMemory};
}

/// Returns the exception that the caller's catch block has caught; out_of_memory() where it is
/// std::bad_alloc, or where there is no memory for its sentence.
inline Error caught_error() noexcept try {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return refused_thread(error).value_or(Error{error.what()});
    } catch (...) {
        return {"unknown error"};
    }
} catch (const std::bad_alloc&) {
    return out_of_memory();
}

} // namespace ovc
