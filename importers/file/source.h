// SPDX-License-Identifier: Apache-2.0
// Source reads a plain or gzip-compressed file once, front to back, by lines or by bytes.
#pragma once

#include "core/result.h"
#include "importers/file/files_read.h"
#include "importers/file/gzip_file.h"
#include "importers/file/read_ahead.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// A Source takes the memory of one block, and a MiB that another thread unpacks ahead if the file
/// is compressed. It takes more only while a single line or read is longer, never more than twice
/// what the file holds. The file's first bytes, not its name, tell whether it is compressed.
class Source {
public:
    enum class Empty { Refused, Fine };

    /// Fails on no such file, no regular file (links are followed), no permission, and an empty
    /// file unless that is fine. A mark of the byte order of UTF-8 is passed over. `files` receives
    /// the file; it may be null.
    static Result<Source> open(const std::filesystem::path& path, FilesRead* files = nullptr,
                               Empty empty = Empty::Refused);

    /// Returns the next line without its end (LF, CR LF, or CR alone if the first line ends so) and
    /// without the NULs and Ctrl-Zs that some programs end a text with. Returns nothing at the end
    /// of the file, and at a line so long that the file counts as damaged. Valid until the next
    /// call.
    std::optional<std::string_view> line();

    /// Returns the next `count` bytes in one piece, valid until the next call; null if fewer are
    /// left.
    const unsigned char* bytes(size_t count) {
        if (end_ - begin_ < count && !fill(count))
            return nullptr;
        const unsigned char* at = buffer_.data() + begin_;
        begin_ += count;
        return at;
    }

    /// Returns false if fewer bytes are left.
    bool skip(uint64_t count);
    /// Returns how many bytes were left.
    uint64_t skip_rest();
    /// Returns the bytes that are left.
    std::string rest();

    /// Returns the number of (uncompressed) bytes given out so far.
    uint64_t offset() const { return dropped_ + begin_; }
    /// Returns the number of the line that line() returned last, from 1.
    uint64_t line_number() const { return line_number_; }
    /// Guesses the uncompressed size, for reserving memory only: the size of a plain file, or the
    /// max that text of a compressed file's size unpacks to.
    uint64_t likely_bytes() const { return likely_bytes_; }

    bool is_compressed() const { return is_compressed_; }
    /// Returns whether the file could not be read to its end; the errors below say why.
    bool is_damaged() const { return !damage_.empty(); }

    /// Returns "FILE, line 7: sentence"; or, if is_damaged(), a sentence on the damage.
    Error error_at_line(std::string_view sentence) const {
        return error_at_line(line_number_, sentence);
    }
    Error error_at_line(uint64_t line, std::string_view sentence) const;
    /// Returns "FILE, byte 70: sentence", likewise.
    Error error_at_byte(uint64_t byte, std::string_view sentence) const;
    Error error(std::string_view sentence) const;

private:
    Source() = default;

    size_t read();
    size_t read_ahead();
    /// Makes at least `count` bytes available; returns false at the end of the file.
    bool fill(size_t count);
    void find_line_end();

    std::string name_;
    std::unique_ptr<GzipFile> file_;
    std::unique_ptr<ReadAhead> unpacked_; // uses file_; null if the file is plain
    std::vector<unsigned char> buffer_;
    size_t begin_ = 0; // of the bytes that are not given out yet
    size_t end_ = 0;
    uint64_t dropped_ = 0; // bytes that left the buffer
    uint64_t line_number_ = 0;
    uint64_t likely_bytes_ = 0;
    bool is_compressed_ = false;
    char line_end_ = '\n';
    std::string damage_; // why reading ended early
};

} // namespace ovc
