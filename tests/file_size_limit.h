// SPDX-License-Identifier: Apache-2.0
// FileSizeLimit makes writes fail as they do where a disk is full.
#pragma once

#include <csignal>

#include <sys/resource.h>

namespace ovc::test {

/// While this lives, files of this process grow to at most so many bytes. Writing more fails with
/// "File too large".
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*const handler_)(int);
};

} // namespace ovc::test
