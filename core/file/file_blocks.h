// SPDX-License-Identifier: Apache-2.0
// FileBlocks: records that lie one behind the other in a file, in blocks that have a checksum each,
// so that a few records can be read and checked without all others.
#pragma once

#include "core/file/archive.h"
#include "core/file/block_cache.h"

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The records of a block. A record is what a file has of a triangle: three corners, normals or
/// texture coordinates.
inline constexpr uint32_t kBlockRecords = 128;

inline constexpr uint64_t blocks_of(uint64_t records) {
    return (records + kBlockRecords - 1) / kBlockRecords;
}

/// Reads for all FileBlocks of a file.
struct BlockReader {
    ReadBytes read;
    BlockCache cache;
    std::vector<uint64_t> sums;            // of all blocks
    std::atomic<uint64_t> cached_bytes{0}; // that were read into the cache
};

class FileBlocks {
public:
    /// Records from `offset` on, whose blocks have the sums from number first_sum on. The reader
    /// outlives this.
    FileBlocks(BlockReader& reader, uint64_t offset, uint64_t records, size_t record_bytes,
               uint64_t first_sum)
        : reader_(reader),
          offset_(offset),
          records_(records),
          record_bytes_(record_bytes),
          first_sum_(first_sum) {}

    uint64_t records() const { return records_; }
    size_t record_bytes() const { return record_bytes_; }

    /// Fills `to` with whole records from `first` on. Any number of threads may call this. Returns
    /// false, and makes `to` arbitrary, where they cannot be read or their checksum is wrong.
    bool read(uint64_t first, std::span<std::byte> to) const;
    /// Does so without a look at checksums, for a caller who has some of its own.
    bool read_unchecked(uint64_t first, std::span<std::byte> to) const;

private:
    bool fill(uint64_t block, std::span<std::byte> to) const;

    BlockReader& reader_;
    const uint64_t offset_;
    const uint64_t records_;
    const size_t record_bytes_;
    const uint64_t first_sum_;
};

/// Returns a sink that passes everything on, and appends the checksums of blocks to `sums`. runs:
/// the bytes of each row of records that comes; blocks do not reach from one into the next. All
/// outlive the sink.
ByteSink summing_blocks(const ByteSink& sink, std::span<const uint64_t> runs, size_t record_bytes,
                        std::vector<uint64_t>& sums);

} // namespace ovc
