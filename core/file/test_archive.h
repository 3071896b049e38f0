// SPDX-License-Identifier: Apache-2.0
// Archives in memory for tests and fuzzers. Their checksums can be made right again after damage,
// so that the checks behind them are tested as well.
#pragma once

#include "core/file/archive.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace ovc::test {

/// Bytes aligned as those of a mapped file, which may grow.
class ArchiveMemory {
public:
    ArchiveMemory() = default;
    explicit ArchiveMemory(Bytes bytes) { append(bytes); }

    void append(Bytes bytes) {
        resize(size_ + bytes.size());
        if (!bytes.empty())
            std::memcpy(data() + size_ - bytes.size(), bytes.data(), bytes.size());
    }
    void resize(size_t size) {
        lines_.resize((size + sizeof(Line) - 1) / sizeof(Line));
        size_ = size;
    }
    ByteSink sink() {
        return [this](Bytes bytes) {
            append(bytes);
            return true;
        };
    }

    size_t size() const { return size_; }
    std::byte* data() { return reinterpret_cast<std::byte*>(lines_.data()); }
    Bytes bytes() const { return {reinterpret_cast<const std::byte*>(lines_.data()), size_}; }

private:
    struct alignas(kPartAlignment) Line {
        std::byte bytes[kPartAlignment];
    };
    std::vector<Line> lines_;
    size_t size_ = 0;
};

/// Makes the checksums of an archive right for its parts as they are now, as far as header, table
/// and end still say where those are.
inline void reseal(ArchiveMemory& memory) {
    constexpr size_t kEndBytes = 40, kHeaderBytes = 64;
    if (memory.size() < kHeaderBytes + kEndBytes)
        return;
    uint64_t table = 0, parts = 0;
    std::byte* end = memory.data() + memory.size() - kEndBytes;
    std::memcpy(&table, end, 8);
    std::memcpy(&parts, end + 8, 8);
    const uint64_t room = memory.size() - kEndBytes;
    if (table > room || parts > (room - table) / sizeof(ArchivePart))
        return;
    for (uint64_t i = 0; i < parts; ++i) {
        std::byte* at = memory.data() + table + i * sizeof(ArchivePart);
        ArchivePart part;
        std::memcpy(&part, at, sizeof(part));
        if (part.offset <= room && part.bytes <= room - part.offset)
            part.checksum = checksum_of(memory.bytes().subspan(part.offset, part.bytes));
        std::memcpy(at, &part, sizeof(part));
    }
    Checksum frame;
    frame.add(memory.bytes().first(kHeaderBytes));
    frame.add(memory.bytes().subspan(table, parts * sizeof(ArchivePart)));
    const uint64_t sum = frame.value();
    std::memcpy(end + 16, &sum, 8);
}

/// Damages an archive as a fuzzer's bytes say. Six of them name a place and the damage to do there;
/// an odd number of bytes left cuts the archive off.
inline void damage(ArchiveMemory& memory, std::span<const uint8_t> orders) {
    constexpr size_t kOrder = 6;
    for (; orders.size() >= kOrder && memory.size() > 8; orders = orders.subspan(kOrder)) {
        uint32_t place = 0;
        std::memcpy(&place, orders.data(), 4);
        std::byte* at = memory.data() + place % (memory.size() - 8);
        const uint64_t values[] = {0, 1, ~uint64_t(0), 0x7ff0000000000000, 0x7fffffff, 0x80000000};
        const uint8_t kind = orders[4];
        if (kind < 128)
            *at = std::byte(orders[5]);
        else if (kind < 160)
            *at ^= std::byte(1 << orders[5] % 8);
        else
            std::memcpy(at, &values[orders[5] % std::size(values)], kind < 208 ? 8 : 4);
    }
    if (orders.size() % 2)
        memory.resize(memory.size() * orders[0] / 256);
}

} // namespace ovc::test
