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

static Header header_of(std::string_view kind, uint32_t version) {
    Header header;
    header.kind = name_of(kind);
    header.version = version;
    header.byte_order = kByteOrder;
    return header;
}

ArchiveWriter::ArchiveWriter(ByteSink sink, std::string_view kind, uint32_t version)
    : sink_(std::move(sink)) {
    const Header header = header_of(kind, version);
    frame_.add(bytes_of_one(header));
    pass_on(bytes_of_one(header));
}

static uint64_t aligned(uint64_t offset) {
    return (offset + kPartAlignment - 1) / kPartAlignment * kPartAlignment;
}

ArchiveWriter::ArchiveWriter(ByteSink sink, std::string_view kind, uint32_t version,
                             std::vector<ArchivePart> parts)
    : sink_(std::move(sink)), parts_(std::move(parts)) {
    assert(!parts_.empty());
    frame_.add(bytes_of_one(header_of(kind, version)));
    offset_ = aligned(parts_.back().offset + parts_.back().bytes);
}

void ArchiveWriter::pass_on(Bytes bytes) {
    wanted_ = wanted_ && (bytes.empty() || sink_(bytes));
    offset_ += bytes.size();
}

const std::vector<ArchivePart>& ArchiveWriter::end_part() {
    if (in_part_) {
        parts_.back().bytes = offset_ - parts_.back().offset;
        parts_.back().checksum = part_.value();
        in_part_ = false;
    }
    const std::array<std::byte, kPartAlignment> zeros{};
    pass_on(std::span(zeros).first(size_t(aligned(offset_) - offset_)));
    return parts_;
}

void ArchiveWriter::begin(std::string_view name) {
    end_part();
    part_ = Checksum();
    in_part_ = true;
    parts_.push_back({name_of(name), offset_});
}

void ArchiveWriter::write(Bytes bytes) {
    assert(in_part_);
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

namespace {

/// The bytes of an archive that are looked at first. They claim where its table is.
struct Frame {
    Header header;
    End end;
    uint64_t table_end; // where `end` begins

    uint64_t table_bytes() const { return table_end - end.table; }
};

const Error kTooShort{"is too short to be whole"};

Result<Done> check(const Frame& frame, std::string_view kind, uint32_t version) {
    if (frame.header.kind != name_of(kind))
        return Error{"does not begin as " + std::string(kind) + " does"};
    if (frame.header.byte_order != kByteOrder)
        return Error{"is from a machine with another order of bytes"};
    if (frame.header.version != version)
        return Error{"is of version " + std::to_string(frame.header.version) + ", expected " +
                     std::to_string(version)};
    const End& end = frame.end;
    if (end.mark != name_of(kEndMark))
        return Error{"is cut off"};
    if (end.table > frame.table_end || end.table % kPartAlignment ||
        frame.table_bytes() / sizeof(ArchivePart) != end.parts ||
        frame.table_bytes() % sizeof(ArchivePart))
        return Error{"is damaged: its table is out of place"};
    return Done{};
}

Result<Done> check_table(const Frame& frame, std::span<const ArchivePart> parts) {
    Checksum sum;
    sum.add(bytes_of_one(frame.header));
    sum.add(bytes_of(parts));
    if (sum.value() != frame.end.checksum)
        return Error{"is damaged: the checksum of its table is wrong"};
    for (const ArchivePart& part : parts)
        if (part.offset % kPartAlignment || part.offset > frame.end.table ||
            part.bytes > frame.end.table - part.offset)
            return Error{"is damaged: a part of it is out of place"};
    return Done{};
}

const ArchivePart* find_part(std::span<const ArchivePart> parts, std::string_view name) {
    const auto found = std::ranges::find(parts, name_of(name), &ArchivePart::name);
    return found == parts.end() ? nullptr : &*found;
}

Error no_part(std::string_view name) {
    return {"has no part '" + std::string(name) + "'"};
}

Error wrong_checksum(std::string_view name) {
    return {"is damaged: the checksum of its part '" + std::string(name) + "' is wrong"};
}

} // namespace

Result<Archive> Archive::open(Bytes bytes, std::string_view kind, uint32_t version) {
    assert(reinterpret_cast<uintptr_t>(bytes.data()) % kPartAlignment == 0);
    if (bytes.size() < sizeof(Header) + sizeof(End))
        return kTooShort;
    const uint64_t table_end = bytes.size() - sizeof(End);
    const Frame frame{read_at<Header>(bytes, 0), read_at<End>(bytes, table_end), table_end};
    if (const Result<Done> fine = check(frame, kind, version); !fine)
        return fine.error();
    Archive archive;
    archive.bytes_ = bytes.first(frame.end.table);
    archive.parts_ = {reinterpret_cast<const ArchivePart*>(bytes.data() + frame.end.table),
                      size_t(frame.end.parts)};
    if (const Result<Done> fine = check_table(frame, archive.parts_); !fine)
        return fine.error();
    return archive;
}

const ArchivePart* Archive::find(std::string_view name) const {
    return find_part(parts_, name);
}

Bytes Archive::unchecked(std::string_view name) const {
    const ArchivePart* part = find(name);
    return part ? bytes_.subspan(part->offset, part->bytes) : Bytes();
}

Result<Bytes> Archive::part(std::string_view name) const {
    const ArchivePart* found = find(name);
    if (!found)
        return no_part(name);
    const Bytes bytes = unchecked(name);
    if (checksum_of(bytes) != found->checksum)
        return wrong_checksum(name);
    return bytes;
}

Error Archive::wrong_size(std::string_view name) {
    return {"is damaged: its part '" + std::string(name) + "' has the wrong size"};
}

Result<StoredArchive> StoredArchive::open(ReadBytes read, uint64_t bytes, std::string_view kind,
                                          uint32_t version) {
    constexpr uint64_t kMaxParts = 1000; // no more memory than this for an end that is damaged
    const Error unreadable{"cannot be read"};
    if (bytes < sizeof(Header) + sizeof(End))
        return kTooShort;
    Frame frame{{}, {}, bytes - sizeof(End)};
    if (!read(0, std::as_writable_bytes(std::span(&frame.header, 1))) ||
        !read(frame.table_end, std::as_writable_bytes(std::span(&frame.end, 1))))
        return unreadable;
    if (const Result<Done> fine = check(frame, kind, version); !fine)
        return fine.error();
    std::vector<ArchivePart> parts(std::min(frame.end.parts, kMaxParts));
    if (!read(frame.end.table, std::as_writable_bytes(std::span(parts))))
        return unreadable;
    if (const Result<Done> fine = check_table(frame, parts); !fine)
        return fine.error();
    return StoredArchive(std::move(read), std::move(parts));
}

ArchivePart StoredArchive::place(std::string_view name) const {
    const ArchivePart* found = find_part(parts_, name);
    return found ? *found : ArchivePart{name_of(name)};
}

Result<Done> StoredArchive::read_checked(const ArchivePart& part, std::span<std::byte> to) const {
    const std::string name(part.name.data());
    if (!find_part(parts_, name))
        return no_part(name);
    if (!to.empty() && !read_(part.offset, to)) // the place of no bytes may be null
        return Error{"cannot be read: its part '" + name + "'"};
    if (checksum_of(to) != part.checksum)
        return wrong_checksum(name);
    return Done{};
}

Result<Done> StoredArchive::check_part(std::string_view name) const {
    const ArchivePart* found = find_part(parts_, name);
    if (!found)
        return no_part(name);
    Checksum sum;
    std::vector<std::byte> bytes;
    for (uint64_t at = 0; at < found->bytes; at += bytes.size()) {
        bytes.resize(size_t(std::min<uint64_t>(1 << 20, found->bytes - at)));
        if (!read_(found->offset + at, bytes))
            return Error{"cannot be read: its part '" + std::string(name) + "'"};
        sum.add(bytes);
    }
    return sum.value() == found->checksum ? Result<Done>(Done{}) : wrong_checksum(name);
}

} // namespace ovc
