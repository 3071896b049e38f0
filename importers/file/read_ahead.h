// SPDX-License-Identifier: Apache-2.0
// ReadAhead: a thread that reads a few blocks further than its user is.
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace ovc {

/// The thread lives as long as this does. One that is started for each block would stand still
/// while the device loads its driver: dlopen and the start of a thread share a lock of the loader,
/// for some 80 ms.
class ReadAhead {
public:
    /// What was read at once. damage: empty, or why it ends early.
    struct Block {
        std::vector<unsigned char> bytes;
        std::string damage;
    };

    /// read: fills a block, and is not called again after one that is empty or damaged. Blocks are
    /// used again with what they held.
    explicit ReadAhead(std::function<void(Block&)> read);

    /// The next block, valid until the next call; after the last one, one that is empty. Throws
    /// what `read` threw.
    const Block& next();

private:
    static constexpr size_t kBlocks = 4;

    void run(const std::stop_token& stop);

    const std::function<void(Block&)> read_;
    std::array<Block, kBlocks> blocks_; // by turns
    const Block none_;
    std::mutex mutex_; // of what follows
    std::condition_variable_any changed_;
    size_t begun_ = 0; // blocks that next() gave out
    size_t read_blocks_ = 0;
    bool ended_ = false;
    std::exception_ptr failure_; // what `read` threw
    std::jthread thread_;        // the last: it uses all the others
};

} // namespace ovc
