// SPDX-License-Identifier: Apache-2.0
// ReadAhead is a thread that reads a few blocks further than its user.
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

/// The thread lives as long as this object. A thread per block would stand still for some 80 ms
/// while the device loads its driver, because dlopen and the start of a thread share a lock of the
/// loader.
class ReadAhead {
public:
    /// The bytes of one call of `read`, and why they end early; `damage` is empty if they do not.
    struct Block {
        std::vector<unsigned char> bytes;
        std::string damage;
    };

    /// `read` fills a block; it is not called again after a block that is empty or damaged. It gets
    /// blocks back with their old contents. Must not be empty.
    explicit ReadAhead(std::function<void(Block&)> read);

    /// Returns the next block, valid until the next call; after the last one, an empty block.
    /// Rethrows the exception of `read`.
    const Block& next();

private:
    static constexpr size_t kBlocks = 4;

    void run(const std::stop_token& stop);

    const std::function<void(Block&)> read_;
    std::array<Block, kBlocks> blocks_; // used in turn
    const Block none_;
    std::mutex mutex_; // guards the members below
    std::condition_variable_any changed_;
    size_t begun_ = 0; // calls of next()
    size_t read_blocks_ = 0;
    bool ended_ = false;
    std::exception_ptr failure_; // thrown by `read`
    std::jthread thread_;        // last, because it uses all other members
};

} // namespace ovc
