// SPDX-License-Identifier: Apache-2.0
#include "core/file/file_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace ovc {
namespace {

constexpr size_t kRecord = 12;

/// Two rows of records, and the sums that a writer makes of them.
struct Rows {
    std::vector<uint64_t> records{300, 0, 128};
    std::vector<std::byte> bytes = std::vector<std::byte>(428 * kRecord);
    std::vector<uint64_t> sums;

    Rows() {
        for (size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = std::byte(i * i >> 4);
    }

    /// Writes in parts of so many bytes.
    void write(size_t part) {
        std::vector<uint64_t> runs;
        for (const uint64_t count : records)
            runs.push_back(count * kRecord);
        uint64_t passed = 0;
        const ByteSink sink = [&](Bytes more) {
            passed += more.size();
            return true;
        };
        sums.clear();
        const ByteSink summing = summing_blocks(sink, runs, kRecord, sums);
        for (size_t at = 0; at < bytes.size(); at += part)
            summing(Bytes(bytes).subspan(at, std::min(part, bytes.size() - at)));
        EXPECT_EQ(passed, bytes.size());
    }
};

TEST(FileBlocks, HaveTheSameSumsInWhateverPartsTheyCome) {
    Rows rows;
    rows.write(rows.bytes.size());
    const auto expected = rows.sums;
    EXPECT_EQ(expected.size(), 3u + 1u);
    for (const size_t part : {size_t(1), size_t(100), kRecord * kBlockRecords, size_t(2000)}) {
        rows.write(part);
        EXPECT_EQ(rows.sums, expected) << part;
    }
}

TEST(FileBlocks, GiveAnyRecordsAndNoWrongOnes) {
    Rows rows;
    rows.write(1000);
    bool fails = false;
    BlockReader reader{[&](uint64_t offset, std::span<std::byte> to) {
                           std::ranges::copy(Bytes(rows.bytes).subspan(offset, to.size()),
                                             to.begin());
                           return !fails;
                       },
                       BlockCache(kRecord * kBlockRecords, 1), rows.sums};
    const FileBlocks first(reader, 0, 300, kRecord, 0);
    const FileBlocks last(reader, 300 * kRecord, 128, kRecord, 3);
    std::vector<std::byte> to;
    const auto read = [&](const FileBlocks& blocks, uint64_t from, uint64_t count) {
        to.resize(count * kRecord);
        return blocks.read(from, to);
    };
    for (const auto& [from, count] : {std::pair(0, 300), {127, 2}, {299, 1}, {5, 0}, {250, 50}}) {
        ASSERT_TRUE(read(first, uint64_t(from), uint64_t(count)));
        EXPECT_EQ(std::memcmp(to.data(), rows.bytes.data() + size_t(from) * kRecord, to.size()), 0);
    }
    ASSERT_TRUE(read(last, 0, 128));
    EXPECT_EQ(std::memcmp(to.data(), rows.bytes.data() + 300 * kRecord, to.size()), 0);
    rows.bytes[310 * kRecord] ^= std::byte(1);
    const FileBlocks again(reader, 300 * kRecord, 128, kRecord, 3);
    EXPECT_TRUE(read(again, 0, 128)); // from the cache
    BlockReader anew{reader.read, BlockCache(kRecord * kBlockRecords, 1), rows.sums};
    EXPECT_FALSE(read(FileBlocks(anew, 300 * kRecord, 128, kRecord, 3), 100, 1));
    EXPECT_TRUE(read(FileBlocks(anew, 0, 300, kRecord, 0), 100, 1));
    fails = true;
    EXPECT_TRUE(read(FileBlocks(anew, 0, 300, kRecord, 0), 100, 1));
    EXPECT_FALSE(read(FileBlocks(anew, 0, 300, kRecord, 0), 200, 1));
}

} // namespace
} // namespace ovc
