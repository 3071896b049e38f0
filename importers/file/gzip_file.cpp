// SPDX-License-Identifier: Apache-2.0
// GzipFile unpacks by zlib; no other file sees it.
#include "importers/file/gzip_file.h"

#include "core/file/disk_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <new>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace ovc {

static constexpr size_t kPackedBytes = size_t(1) << 16; // larger was no faster
static constexpr unsigned char kMark[] = {0x1f, 0x8b};
static constexpr int kGzipAlone = 16; // added to the bits of zlib's window

/// The state of zlib, and the packed bytes that it gets.
class GzipFile::Unpacking {
public:
    explicit Unpacking(GzipFile& file) : file_(file), packed_(kPackedBytes) {
        if (inflateInit2(&zlib_, MAX_WBITS + kGzipAlone) != Z_OK)
            throw std::bad_alloc();
    }
    ~Unpacking() { inflateEnd(&zlib_); }
    Unpacking(const Unpacking&) = delete;

    size_t read(std::span<unsigned char> to, std::string& damage) {
        zlib_.next_out = to.data();
        zlib_.avail_out = unsigned(to.size());
        while (zlib_.avail_out > 0 && !ended_)
            if (const std::string found = unpack_some(); !found.empty()) {
                ended_ = true;
                damage = found;
            }
        return to.size() - zlib_.avail_out;
    }

private:
    /// Returns what is wrong with the file, nothing where all is well.
    std::string unpack_some() {
        std::string damage;
        if (zlib_.avail_in < (between_members_ ? sizeof(kMark) : 1) && !load(damage))
            return damage;
        if (between_members_) {
            ended_ = zlib_.avail_in < sizeof(kMark) ||
                     !std::equal(std::begin(kMark), std::end(kMark), zlib_.next_in);
            between_members_ = false;
            if (ended_)
                return {};
        }
        const int code = inflate(&zlib_, Z_NO_FLUSH);
        if (code == Z_MEM_ERROR)
            throw std::bad_alloc();
        if (code == Z_STREAM_END) {
            inflateReset(&zlib_);
            between_members_ = true;
        } else if (code != Z_OK && code != Z_BUF_ERROR) {
            return fmt::format("the compressed data is damaged: {}",
                               zlib_.msg ? zlib_.msg : "no code is known by it");
        }
        return {};
    }

    /// Reads more behind the packed bytes that are left. Returns false where `damage` has the
    /// reason why there are none, though there should be.
    bool load(std::string& damage) {
        std::copy_n(zlib_.next_in, zlib_.avail_in, packed_.data());
        zlib_.next_in = packed_.data();
        const size_t got = file_.read_plain(std::span(packed_).subspan(zlib_.avail_in), damage);
        zlib_.avail_in += unsigned(got);
        if (got == 0 && damage.empty() && !between_members_)
            damage = "the compressed data ends early";
        return damage.empty();
    }

    GzipFile& file_;
    std::vector<unsigned char> packed_;
    z_stream zlib_{};
    bool between_members_ = false;
    bool ended_ = false;
};

std::unique_ptr<GzipFile> GzipFile::open(const std::filesystem::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    return descriptor < 0 ? nullptr : std::unique_ptr<GzipFile>(new GzipFile(descriptor));
}

GzipFile::GzipFile(int descriptor) : descriptor_(descriptor) {}

GzipFile::~GzipFile() {
    close(descriptor_);
}

size_t GzipFile::read_plain(std::span<unsigned char> to, std::string& damage) {
    size_t got = 0;
    const int failed = read_file_as_far(descriptor_, offset_, std::as_writable_bytes(to), got);
    if (failed)
        damage = fmt::format("cannot be read: {}", std::strerror(failed));
    offset_ += got;
    return got;
}

size_t GzipFile::read(std::span<unsigned char> to, std::string& damage) {
    assert(!to.empty());
    if (!has_begun_) {
        unsigned char first[sizeof(kMark)]{};
        if (read_plain(first, damage) == sizeof(first) && std::ranges::equal(first, kMark))
            unpacking_ = std::make_unique<Unpacking>(*this);
        if (!damage.empty())
            return 0;
        offset_ = 0;
        has_begun_ = true;
    }
    return unpacking_ ? unpacking_->read(to, damage) : read_plain(to, damage);
}

} // namespace ovc
