// SPDX-License-Identifier: Apache-2.0
#include "importers/file/read_ahead.h"

#include <cassert>
#include <utility>

namespace ovc {

ReadAhead::ReadAhead(std::function<void(Block&)> read)
    : read_(std::move(read)), thread_([this](const std::stop_token& stop) { run(stop); }) {
    assert(read_);
}

const ReadAhead::Block& ReadAhead::next() {
    std::unique_lock lock(mutex_);
    ++begun_; // gives the block before back to the thread
    changed_.notify_all();
    changed_.wait(lock, [&] { return ended_ || read_blocks_ >= begun_; });
    if (read_blocks_ >= begun_)
        return blocks_[(begun_ - 1) % kBlocks];
    if (failure_)
        std::rethrow_exception(failure_);
    return none_;
}

void ReadAhead::run(const std::stop_token& stop) {
    for (size_t next = 0;; ++next) {
        {
            // The thread may fill all blocks except the one that the user has.
            std::unique_lock lock(mutex_);
            const auto is_free = [&] { return next + 1 < begun_ + kBlocks; };
            if (!changed_.wait(lock, stop, is_free) || stop.stop_requested())
                return;
        }
        Block& block = blocks_[next % kBlocks];
        std::exception_ptr failure;
        try {
            read_(block);
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        assert(read_blocks_ == next && !ended_);
        failure_ = failure;
        read_blocks_ = failure ? next : next + 1;
        ended_ = failure || block.bytes.empty() || !block.damage.empty();
        changed_.notify_all();
        if (ended_)
            return;
    }
}

} // namespace ovc
