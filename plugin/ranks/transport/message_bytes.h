// SPDX-License-Identifier: Apache-2.0
// MessageBytes: the memory of a message. Messages come and go by the thousand, in a few sizes; the
// system would clear the pages of each anew, so some of their memory is kept for the next.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace ovc {

/// Bytes that are not set at first. Only moved.
class MessageBytes {
public:
    MessageBytes() = default;
    explicit MessageBytes(size_t size) : block_(kept().take(size)), size_(size) {}
    ~MessageBytes() {
        if (block_.bytes) // else kept() may not be there yet, and there may be no memory for it
            kept().give_back(std::move(block_));
    }
    MessageBytes(MessageBytes&& other) noexcept
        : block_(std::exchange(other.block_, {})), size_(std::exchange(other.size_, 0)) {}
    MessageBytes& operator=(MessageBytes&& other) noexcept {
        std::swap(block_, other.block_);
        std::swap(size_, other.size_);
        return *this;
    }

    std::byte* data() const { return block_.bytes.get(); }
    size_t size() const { return size_; }

private:
    struct Block {
        std::unique_ptr<std::byte[]> bytes;
        size_t size = 0;
    };

    /// Blocks that no message has. Any thread.
    class Kept {
    public:
        Kept() { blocks_.reserve(kMaxBlocks); } // so that give_back() does not throw

        Block take(size_t size) {
            {
                const std::lock_guard lock(mutex_);
                const auto fits = [&](const Block& block) {
                    return block.size >= size && block.size / 2 <= size;
                };
                const auto found = std::ranges::find_if(blocks_, fits);
                if (found != blocks_.end()) {
                    bytes_ -= found->size;
                    std::swap(*found, blocks_.back());
                    Block block = std::move(blocks_.back());
                    blocks_.pop_back();
                    return block;
                }
            }
            return {std::make_unique_for_overwrite<std::byte[]>(size), size};
        }
        void give_back(Block block) noexcept {
            constexpr size_t kMin = size_t(1) << 16; // less the C library keeps by itself
            constexpr size_t kMaxBytes = size_t(8) << 20;
            if (block.size < kMin)
                return;
            const std::lock_guard lock(mutex_);
            if (bytes_ + block.size > kMaxBytes || blocks_.size() == kMaxBlocks)
                return;
            bytes_ += block.size;
            blocks_.push_back(std::move(block));
        }

    private:
        static constexpr size_t kMaxBlocks = 64;
        std::mutex mutex_;
        std::vector<Block> blocks_;
        size_t bytes_ = 0;
    };
    static Kept& kept() {
        static Kept* const all = new Kept; // never gone, for messages may be there at exit
        return *all;
    }

    Block block_;
    size_t size_ = 0;
};

} // namespace ovc
