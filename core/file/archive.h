// SPDX-License-Identifier: Apache-2.0
// Archive: named parts of bytes one after the other, each with a checksum, made to be mapped into
// memory: scene files, the plugin's saved levels, stored programs and unfinished pictures.
//
//   header   64 bytes: kind (16 characters), version (u32), a mark of the byte order (u32), 0
//   parts    each begins at a multiple of 64; zeros in between
//   table    per part: name (16 characters), offset, bytes, checksum (u64 each)
//   end      offset of the table, number of parts, checksum of header and table (u64 each), mark
//
// The end comes last, so that a file that was not written to its end is known at once.
#pragma once

#include "core/file/checksum.h"
#include "core/result.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace ovc {

using Bytes = std::span<const std::byte>;

/// Fills `to` with the bytes from an offset on. Returns false where they cannot be read. Any number
/// of threads may call it.
using ReadBytes = std::function<bool(uint64_t offset, std::span<std::byte> to)>;

/// Takes the next bytes of an archive that is written. Returns false where it wants no more.
using ByteSink = std::function<bool(Bytes)>;

template <class T>
Bytes bytes_of(std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(items);
}

/// Parts begin at multiples of this many bytes, so that their items may be used in place.
inline constexpr size_t kPartAlignment = 64;

struct ArchivePart {
    std::array<char, 16> name{};
    uint64_t offset = 0;
    uint64_t bytes = 0;
    uint64_t checksum = 0;
};
static_assert(sizeof(ArchivePart) == 40);

/// Writes an archive front to back, so that nobody need hold all of it.
class ArchiveWriter {
public:
    /// kind, and the names of parts, have at most 15 characters.
    ArchiveWriter(ByteSink sink, std::string_view kind, uint32_t version);
    /// Goes on behind parts that another writer has ended. The sink continues its bytes.
    ArchiveWriter(ByteSink sink, std::string_view kind, uint32_t version,
                  std::vector<ArchivePart> parts);

    /// Begins a part of this name, to which all that is written next belongs.
    void begin(std::string_view name);
    void write(Bytes bytes);
    template <class T>
    void part(std::string_view name, std::span<const T> items) {
        begin(name);
        write(bytes_of(items));
    }

    /// Ends the part that was begun last, and returns all parts.
    const std::vector<ArchivePart>& end_part();
    /// Ends the archive; call this once. Returns false where the sink wanted no more.
    bool finish();

    /// Returns how many bytes were passed to the sink.
    uint64_t bytes() const { return offset_; }

private:
    void pass_on(Bytes bytes);

    ByteSink sink_;
    Checksum frame_; // over header and table
    std::vector<ArchivePart> parts_;
    Checksum part_;
    bool in_part_ = false;
    uint64_t offset_ = 0;
    bool wanted_ = true;
};

/// A view of an archive's bytes, which must outlive it.
class Archive {
public:
    /// Returns a view of `bytes`, which are aligned to kPartAlignment. Error: not such an archive,
    /// another version, damage to header or table. The sentence goes on from a name: "is …".
    static Result<Archive> open(Bytes bytes, std::string_view kind, uint32_t version);

    /// Returns the part's bytes if their checksum is right. Error: none of this name, or damage.
    Result<Bytes> part(std::string_view name) const;
    /// Returns the bytes unchecked, for a part that checks itself; none where there is no such
    /// part.
    Bytes unchecked(std::string_view name) const;

    /// Returns a part of any number of T, or of `count`. Error: as part(), or another size.
    template <class T>
    Result<std::span<const T>> items(std::string_view name, uint64_t count = ~uint64_t(0)) const {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kPartAlignment);
        const Result<Bytes> bytes = part(name);
        if (!bytes)
            return bytes.error();
        const uint64_t found = bytes->size() / sizeof(T);
        if (bytes->size() % sizeof(T) || (count != ~uint64_t(0) && found != count))
            return wrong_size(name);
        return std::span(reinterpret_cast<const T*>(bytes->data()), size_t(found));
    }

private:
    friend class StoredArchive;
    static Error wrong_size(std::string_view name);
    const ArchivePart* find(std::string_view name) const;

    Bytes bytes_;
    std::span<const ArchivePart> parts_;
};

/// An archive that is not in memory: each part is read when it is asked for.
class StoredArchive {
public:
    /// As Archive::open(), of so many bytes that `read` gives. Error: besides, they cannot be read.
    static Result<StoredArchive> open(ReadBytes read, uint64_t bytes, std::string_view kind,
                                      uint32_t version);
    /// Returns a view of parts of an archive that need not be whole.
    static StoredArchive of_parts(ReadBytes read, std::vector<ArchivePart> parts) {
        return {std::move(read), std::move(parts)};
    }

    /// Returns where a part lies; bytes are 0 where there is none of this name.
    ArchivePart place(std::string_view name) const;
    const ReadBytes& read() const { return read_; }
    /// Reads a part to check it, and keeps nothing of it. Error: it is damaged, or cannot be read.
    Result<Done> check_part(std::string_view name) const;

    /// Returns a part of any number of T, or of `count`. Error: as Archive::items(), or the bytes
    /// cannot be read.
    template <class T>
    Result<std::vector<T>> items(std::string_view name, uint64_t count = ~uint64_t(0)) const {
        static_assert(std::is_trivially_copyable_v<T>);
        const ArchivePart found = place(name);
        const uint64_t size = found.bytes / sizeof(T);
        if (found.bytes % sizeof(T) || (count != ~uint64_t(0) && size != count))
            return Archive::wrong_size(name);
        std::vector<T> all(size, std::bit_cast<T>(std::array<std::byte, sizeof(T)>{}));
        if (const Result<Done> done = read_checked(found, std::as_writable_bytes(std::span(all)));
            !done)
            return done.error();
        return all;
    }

private:
    StoredArchive(ReadBytes read, std::vector<ArchivePart> parts)
        : read_(std::move(read)), parts_(std::move(parts)) {}
    Result<Done> read_checked(const ArchivePart& part, std::span<std::byte> to) const;

    ReadBytes read_;
    std::vector<ArchivePart> parts_;
};

} // namespace ovc
