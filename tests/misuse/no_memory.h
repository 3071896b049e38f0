// SPDX-License-Identifier: Apache-2.0
// NoMemory: lets memory run out for one thread, at any of its allocations.
#pragma once

namespace ovc::test {

/// While it lives, this thread's operator new, the library's included, makes `allocations` more and
/// then throws std::bad_alloc. Other threads, and with them the drivers', are spared.
class NoMemory {
public:
    explicit NoMemory(int allocations);
    ~NoMemory();
    NoMemory(const NoMemory&) = delete;

    /// Whether an allocation was refused.
    bool was_missed() const;
};

} // namespace ovc::test
