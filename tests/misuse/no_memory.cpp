// SPDX-License-Identifier: Apache-2.0
// NoMemory: counts in the operator new of the program, which serves its libraries too.
#include "tests/misuse/no_memory.h"

#include <cstdlib>
#include <new>

namespace ovc::test {

static constexpr int kUnlimited = -1;
static thread_local int allowed = kUnlimited;
static thread_local bool missed = false;

NoMemory::NoMemory(int allocations) {
    allowed = allocations;
    missed = false;
}

NoMemory::~NoMemory() {
    allowed = kUnlimited;
}

bool NoMemory::was_missed() const {
    return missed;
}

static void* allocate(size_t bytes) {
    if (allowed == 0) {
        missed = true;
        throw std::bad_alloc();
    }
    if (allowed > 0)
        --allowed;
    void* const memory = std::malloc(bytes > 0 ? bytes : 1);
    if (!memory)
        throw std::bad_alloc();
    return memory;
}

} // namespace ovc::test

void* operator new(size_t bytes) {
    return ovc::test::allocate(bytes);
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}
