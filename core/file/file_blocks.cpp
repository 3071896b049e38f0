// SPDX-License-Identifier: Apache-2.0
// FileBlocks: a block is read whole, and checked, before any of it is believed.
#include "core/file/file_blocks.h"

#include "core/file/checksum.h"

#include <algorithm>
#include <cassert>
#include <memory>

namespace ovc {

bool FileBlocks::read_unchecked(uint64_t first, std::span<std::byte> to) const {
    return reader_.read(offset_ + first * record_bytes_, to);
}

bool FileBlocks::fill(uint64_t block, std::span<std::byte> to) const {
    const uint64_t first = block * kBlockRecords;
    const uint64_t count = std::min<uint64_t>(kBlockRecords, records_ - first);
    const auto whole = to.first(count * record_bytes_);
    reader_.cached_bytes.fetch_add(whole.size(), std::memory_order_relaxed);
    return read_unchecked(first, whole) && checksum_of(whole) == reader_.sums[first_sum_ + block];
}

bool FileBlocks::read(uint64_t first, std::span<std::byte> to) const {
    assert(to.size() % record_bytes_ == 0 && first + to.size() / record_bytes_ <= records_);
    while (!to.empty()) {
        const uint64_t block = first / kBlockRecords, within = first % kBlockRecords;
        const auto part = to.first(std::min(to.size(), (kBlockRecords - within) * record_bytes_));
        const auto fill_block = [&](std::span<std::byte> whole) { return fill(block, whole); };
        if (!reader_.cache.copy(first_sum_ + block, within * record_bytes_, part, fill_block))
            return false;
        to = to.subspan(part.size());
        first += part.size() / record_bytes_;
    }
    return true;
}

namespace {

/// Cuts bytes that come in parts of any size into runs, and those into blocks.
class BlockSums {
public:
    BlockSums(std::span<const uint64_t> runs, size_t record_bytes, std::vector<uint64_t>& sums)
        : runs_(runs), block_bytes_(kBlockRecords * record_bytes), sums_(sums) {}

    void add(Bytes bytes) {
        while (!bytes.empty()) {
            if (left_in_run_ == 0) {
                begin_run();
                continue;
            }
            const uint64_t left = std::min<uint64_t>(block_bytes_ - in_block_, left_in_run_);
            const Bytes part = bytes.first(size_t(std::min<uint64_t>(bytes.size(), left)));
            sum_.add(part);
            in_block_ += part.size();
            left_in_run_ -= part.size();
            if (part.size() == left)
                end_block();
            bytes = bytes.subspan(part.size());
        }
    }

private:
    void begin_run() {
        assert(!runs_.empty());
        left_in_run_ = runs_.front();
        runs_ = runs_.subspan(1);
    }
    void end_block() {
        sums_.push_back(sum_.value());
        sum_ = Checksum();
        in_block_ = 0;
    }

    std::span<const uint64_t> runs_; // that have not begun
    const size_t block_bytes_;
    std::vector<uint64_t>& sums_;
    Checksum sum_;
    uint64_t in_block_ = 0;
    uint64_t left_in_run_ = 0;
};

} // namespace

ByteSink summing_blocks(const ByteSink& sink, std::span<const uint64_t> runs, size_t record_bytes,
                        std::vector<uint64_t>& sums) {
    return [&sink, state = std::make_shared<BlockSums>(runs, record_bytes, sums)](Bytes bytes) {
        state->add(bytes);
        return sink(bytes);
    };
}

} // namespace ovc
