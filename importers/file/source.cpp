// SPDX-License-Identifier: Apache-2.0
// Source buffers what a file gives, and finds lines in it.
#include "importers/file/source.h"

#include "core/text/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace ovc {

namespace {

constexpr size_t kBlockBytes = size_t(1) << 16;    // larger was no faster
constexpr size_t kUnpackedBytes = size_t(1) << 18; // some 1 ms of work
/// The max bytes of a line: far more than any model has, and little enough to fit into memory.
constexpr size_t kLongestLine = size_t(1) << 28;
constexpr uint64_t kLikelyCompression = 12; // models as text reach 3 to 6

/// Names a file that is not regular, because reading it might block or never end. Null if nothing
/// speaks against opening it.
const char* other_than_a_file(std::filesystem::file_type type) {
    switch (type) {
    case std::filesystem::file_type::directory:
        return "a directory";
    case std::filesystem::file_type::fifo:
        return "a pipe";
    case std::filesystem::file_type::socket:
        return "a socket";
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
        return "a device";
    default:
        return nullptr;
    }
}

/// A line may keep a CR of its end, and some programs put marks behind the last line: NUL (ZBrush)
/// and Ctrl-Z (DOS).
bool ends_text(char c) {
    return c == '\r' || c == '\0' || c == '\x1a';
}

} // namespace

Result<Source> Source::open(const std::filesystem::path& path, FilesRead* files, Empty empty) {
    note(files, path);
    Source source;
    source.name_ = path.string();
    std::error_code ec;
    const auto status = std::filesystem::status(path, ec);
    if (status.type() == std::filesystem::file_type::not_found)
        return source.error("no such file" + did_you_mean_file(path));
    if (const char* other = other_than_a_file(status.type()))
        return source.error(fmt::format("found {}, which is no regular file", other));
    errno = 0;
    source.file_ = GzipFile::open(path);
    if (!source.file_)
        return source.error(fmt::format("cannot be opened: {}", std::strerror(errno)));
    source.buffer_.resize(kBlockBytes);
    if (!source.fill(1) && (empty == Empty::Refused || source.is_damaged()))
        return source.error("the file is empty, expected a model");
    source.is_compressed_ = source.file_->is_compressed();
    const auto size = std::filesystem::file_size(path, ec);
    if (!ec)
        source.likely_bytes_ = source.is_compressed_ ? size * kLikelyCompression : size;
    source.find_line_end();
    constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf"; // some editors put it before UTF-8
    if (source.fill(kUtf8Mark.size()) &&
        std::memcmp(source.buffer_.data(), kUtf8Mark.data(), kUtf8Mark.size()) == 0)
        source.begin_ = kUtf8Mark.size();
    return source;
}

void Source::find_line_end() {
    const auto* first = buffer_.data();
    const auto* last = first + end_;
    const auto* cr = std::find(first, last, '\r');
    // A CR that ends the buffer says nothing about what follows.
    if (last - cr > 1 && cr[1] != '\n' && std::find(first, cr, '\n') == cr)
        line_end_ = '\r';
}

bool Source::fill(size_t count) {
    assert(begin_ <= end_ && end_ <= buffer_.size());
    if (begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        dropped_ += begin_;
        end_ -= begin_;
        begin_ = 0;
    }
    while (end_ < count)
        if ((is_compressed_ ? read_ahead() : read()) == 0)
            return false;
    return true;
}

size_t Source::read() {
    // The buffer doubles as the bytes arrive, never to a size that somebody claims.
    if (end_ == buffer_.size())
        buffer_.resize(2 * buffer_.size());
    const size_t room = std::min(buffer_.size() - end_, kBlockBytes);
    const size_t got = file_->read(std::span(buffer_).subspan(end_, room), damage_);
    end_ += got;
    return got;
}

/// Takes a block that the other thread unpacked meanwhile.
size_t Source::read_ahead() {
    if (!unpacked_)
        unpacked_ = std::make_unique<ReadAhead>([file = file_.get()](auto& block) {
            block.bytes.resize(kUnpackedBytes);
            block.bytes.resize(file->read(block.bytes, block.damage));
        });
    const ReadAhead::Block& block = unpacked_->next();
    if (!block.damage.empty())
        damage_ = block.damage;
    buffer_.resize(std::max(buffer_.size(), end_ + block.bytes.size()));
    std::copy(block.bytes.begin(), block.bytes.end(), buffer_.begin() + ptrdiff_t(end_));
    end_ += block.bytes.size();
    return block.bytes.size();
}

std::optional<std::string_view> Source::line() {
    size_t searched = 0;
    const unsigned char* end = nullptr;
    for (;;) {
        const unsigned char* from = buffer_.data() + begin_;
        const size_t available = end_ - begin_;
        end = static_cast<const unsigned char*>(
            std::memchr(from + searched, line_end_, available - searched));
        if (end)
            break;
        if (available > kLongestLine) {
            damage_ = fmt::format("found a line of more than {} MiB, expected a shorter one",
                                  kLongestLine >> 20);
            return std::nullopt;
        }
        searched = available;
        if (!fill(available + 1)) {
            if (available == 0)
                return std::nullopt;
            break;
        }
    }
    const char* text = reinterpret_cast<const char*>(buffer_.data() + begin_);
    size_t length = end ? size_t(end - (buffer_.data() + begin_)) : end_ - begin_;
    begin_ += length + (end ? 1 : 0);
    assert(begin_ <= end_);
    ++line_number_;
    while (length > 0 && ends_text(text[length - 1]))
        --length;
    return std::string_view(text, length);
}

bool Source::skip(uint64_t count) {
    while (count > 0) {
        const auto step = size_t(std::min<uint64_t>(count, kBlockBytes));
        if (!bytes(step))
            return false;
        count -= step;
    }
    return true;
}

Error Source::error(std::string_view sentence) const {
    return {fmt::format("{}: {}", name_, damage_.empty() ? sentence : damage_)};
}

uint64_t Source::skip_rest() {
    const uint64_t from = offset();
    do
        begin_ = end_;
    while (fill(1));
    return offset() - from;
}

std::string Source::rest() {
    std::string all;
    do {
        all.append(reinterpret_cast<const char*>(buffer_.data()) + begin_, end_ - begin_);
        begin_ = end_;
    } while (fill(1));
    return all;
}

Error Source::error_at_line(uint64_t line, std::string_view sentence) const {
    if (!damage_.empty())
        return error_at_byte(dropped_ + end_, damage_);
    return {fmt::format("{}, line {}: {}", name_, line, sentence)};
}

Error Source::error_at_byte(uint64_t byte, std::string_view sentence) const {
    if (!damage_.empty())
        return {fmt::format("{}, byte {}: {}", name_, dropped_ + end_, damage_)};
    return {fmt::format("{}, byte {}: {}", name_, byte, sentence)};
}

} // namespace ovc
