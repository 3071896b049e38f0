// SPDX-License-Identifier: Apache-2.0
// Archive: it writes front to back, and believes nothing when it reads.
#include "core/file/archive.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>

namespace ovc {
namespace {

using Name = std::array<char, 16>;

struct Header {
    Name kind{};
    uint32_t version = 0;
    uint32_t byte_order = 0;
    std::array<char, 40> zeros{};
};
static_assert(sizeof(Header) == kPartAlignment);

struct End {
    uint64_t table = 0;
    uint64_t parts = 0;
    uint64_t checksum = 0;
    Name mark{};
};
static_assert(sizeof(End) == 40);

constexpr uint32_t kByteOrder = 0x01020304;
constexpr std::string_view kEndMark = "overcast's end";

Name name_of(std::string_view text) {
    assert(text.size() < sizeof(Name));
    Name name{};
    std::copy(text.begin(), text.end(), name.begin());
    return name;
}

template <class T>
Bytes bytes_of_one(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

/// Reads a T at an offset that need not be aligned.
template <class T>
T read_at(Bytes bytes, uint64_t offset) {
    assert(offset <= bytes.size() && sizeof(T) <= bytes.size() - offset);
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

} // namespace

ArchiveWriter::ArchiveWriter(ByteSink sink, std::string_view kind, uint32_t version)
    : sink_(std::move(sink)) {
    Header header;
    header.kind = name_of(kind);
    header.version = version;
    header.byte_order = kByteOrder;
    frame_.add(bytes_of_one(header));
    pass_on(bytes_of_one(header));
}

void ArchiveWriter::pass_on(Bytes bytes) {
    wanted_ = wanted_ && (bytes.empty() || sink_(bytes));
    offset_ += bytes.size();
}

void ArchiveWriter::end_part() {
    if (!parts_.empty()) {
        parts_.back().bytes = offset_ - parts_.back().offset;
        parts_.back().checksum = part_.value();
    }
    const std::array<std::byte, kPartAlignment> zeros{};
    pass_on(std::span(zeros).first((kPartAlignment - offset_ % kPartAlignment) % kPartAlignment));
    assert(offset_ % kPartAlignment == 0);
}

void ArchiveWriter::begin(std::string_view name) {
    end_part();
    part_ = Checksum();
    parts_.push_back({name_of(name), offset_});
}

void ArchiveWriter::write(Bytes bytes) {
    assert(!parts_.empty());
    part_.add(bytes);
    pass_on(bytes);
}

bool ArchiveWriter::finish() {
    end_part();
    End end;
    end.table = offset_;
    end.parts = parts_.size();
    const Bytes table = bytes_of(std::span<const ArchivePart>(parts_));
    frame_.add(table);
    end.checksum = frame_.value();
    end.mark = name_of(kEndMark);
    pass_on(table);
    pass_on(bytes_of_one(end));
    return wanted_;
}

Result<Archive> Archive::open(Bytes bytes, std::string_view kind, uint32_t version) {
    assert(reinterpret_cast<uintptr_t>(bytes.data()) % kPartAlignment == 0);
    if (bytes.size() < sizeof(Header) + sizeof(End))
        return Error{"is too short to be whole"};
    const auto header = read_at<Header>(bytes, 0);
    if (header.kind != name_of(kind))
        return Error{"does not begin as " + std::string(kind) + " does"};
    if (header.byte_order != kByteOrder)
        return Error{"is from a machine with another order of bytes"};
    if (header.version != version)
        return Error{"is of version " + std::to_string(header.version) + ", expected " +
                     std::to_string(version)};
    const auto end = read_at<End>(bytes, bytes.size() - sizeof(End));
    const uint64_t table_end = bytes.size() - sizeof(End);
    if (end.mark != name_of(kEndMark))
        return Error{"is cut off"};
    if (end.table > table_end || end.table % kPartAlignment ||
        (table_end - end.table) / sizeof(ArchivePart) != end.parts ||
        (table_end - end.table) % sizeof(ArchivePart))
        return Error{"is damaged: its table is out of place"};
    const Bytes table = bytes.subspan(end.table, table_end - end.table);
    Checksum frame;
    frame.add(bytes.first(sizeof(Header)));
    frame.add(table);
    if (frame.value() != end.checksum)
        return Error{"is damaged: the checksum of its table is wrong"};
    Archive archive;
    archive.bytes_ = bytes.first(end.table);
    archive.parts_ = {reinterpret_cast<const ArchivePart*>(table.data()), size_t(end.parts)};
    for (const ArchivePart& part : archive.parts_)
        if (part.offset % kPartAlignment || part.offset > end.table ||
            part.bytes > end.table - part.offset)
            return Error{"is damaged: a part of it is out of place"};
    return archive;
}

const ArchivePart* Archive::find(std::string_view name) const {
    const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const ArchivePart& part) {
        return part.name == name_of(name);
    });
    return found == parts_.end() ? nullptr : &*found;
}

Bytes Archive::unchecked(std::string_view name) const {
    const ArchivePart* part = find(name);
    return part ? bytes_.subspan(part->offset, part->bytes) : Bytes();
}

Result<Bytes> Archive::part(std::string_view name) const {
    const ArchivePart* found = find(name);
    if (!found)
        return Error{"has no part '" + std::string(name) + "'"};
    const Bytes bytes = unchecked(name);
    if (checksum_of(bytes) != found->checksum)
        return Error{"is damaged: the checksum of its part '" + std::string(name) + "' is wrong"};
    return bytes;
}

Error Archive::wrong_size(std::string_view name) {
    return {"is damaged: its part '" + std::string(name) + "' has the wrong size"};
}

} // namespace ovc
