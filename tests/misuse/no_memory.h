// SPDX-License-Identifier: Apache-2.0
// NoMemory: lets memory run out at any allocation of a thread, or of the library.
#pragma once

namespace ovc::test {

/// While it lives, operator new makes `allocations` more and then throws std::bad_alloc: on this
/// thread, from then on, in the library and outside; or on all threads, once, for the library's own
/// code. Drivers are spared, which end the process.
class NoMemory {
public:
    enum class Of { ThisThread, Library };
    explicit NoMemory(int allocations, Of threads = Of::ThisThread);
    ~NoMemory();
    NoMemory(const NoMemory&) = delete;

    /// Whether an allocation was refused.
    bool was_missed() const;
};

} // namespace ovc::test
