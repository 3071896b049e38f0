// SPDX-License-Identifier: Apache-2.0
// NoMemory: counts in the operator new of the program, which serves its libraries too.
#include "tests/misuse/no_memory.h"

#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string_view>

namespace ovc::test {

static constexpr int kUnlimited = -1;
static thread_local int allowed = kUnlimited;
static std::atomic<int> allowed_to_all = kUnlimited;
static std::atomic<bool> missed = false;

NoMemory::NoMemory(int allocations, Of threads) {
    missed = false;
    if (threads == Of::ThisThread)
        allowed = allocations;
    else
        allowed_to_all = allocations;
}

NoMemory::~NoMemory() {
    allowed = allowed_to_all = kUnlimited;
}

bool NoMemory::was_missed() const {
    return missed;
}

static bool is_in_library(void* code) {
    Dl_info found{};
    return dladdr(code, &found) != 0 &&
           std::string_view(found.dli_fname).find("libovercast") != std::string_view::npos;
}

/// Takes one of those that the library's threads may make together. Returns false where there is
/// none left, once.
static bool take_of_all(void* caller) {
    if (allowed_to_all == kUnlimited || !is_in_library(caller))
        return true;
    for (int left = allowed_to_all; left != kUnlimited;)
        if (allowed_to_all.compare_exchange_weak(left, left - 1))
            return left > 0; // behind 0 comes kUnlimited
    return true;
}

static void* allocate(size_t bytes, void* caller) {
    if (allowed == 0 || !take_of_all(caller)) {
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
    return ovc::test::allocate(bytes, __builtin_return_address(0));
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}
