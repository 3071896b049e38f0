// SPDX-License-Identifier: Apache-2.0
// ForkMark: tells whether this process made the mark, or was forked since from the one that did. In
// a forked process neither a device's thread nor a driver's threads exist, and waiting for one
// never ends.
#pragma once

#include <cstdint>
#include <sys/mman.h>
#include <unistd.h>

namespace ovc {

class ForkMark {
public:
    ForkMark() {
        void* page =
            mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (page == MAP_FAILED)
            return;
#ifdef MADV_WIPEONFORK
        if (madvise(page, kBytes, MADV_WIPEONFORK) == 0) {
            page_ = static_cast<uint32_t*>(page);
            *page_ = 1;
            return;
        }
#endif
        munmap(page, kBytes);
    }
    ~ForkMark() {
        if (page_)
            munmap(page_, kBytes);
    }
    ForkMark(const ForkMark&) = delete;

    /// One load from a page that the kernel wipes in the child. A kernel that cannot wipe pages
    /// (Linux before 4.14) costs a system call.
    bool forked() const {
        return page_ ? *page_ == 0 : getpid() != process_;
    }

private:
    static constexpr size_t kBytes = 4096; // the system rounds it up to a page

    const pid_t process_ = getpid();
    uint32_t* page_ = nullptr;
};

} // namespace ovc
