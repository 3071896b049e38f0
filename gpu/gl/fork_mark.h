// SPDX-License-Identifier: Apache-2.0
// ForkMark: tells whether this process is the one that made the mark, or was forked from it since:
// there a device's thread does not exist, nor do a driver's, and who waits for them waits for ever.
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

    /// One load: a page that the kernel wipes in the child. Where it cannot (Linux before 4.14), a
    /// system call.
    bool forked() const {
        return page_ ? *page_ == 0 : getpid() != process_;
    }

private:
    static constexpr size_t kBytes = 4096; // rounded up to a page where pages are larger

    const pid_t process_ = getpid();
    uint32_t* page_ = nullptr;
};

} // namespace ovc
