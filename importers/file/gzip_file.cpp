// SPDX-License-Identifier: Apache-2.0
// GzipFile unpacks by ISA-L; no other file sees it.
#include "importers/file/gzip_file.h"

#include "core/file/disk_file.h"

#include <fmt/format.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <unistd.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace ovc {

static constexpr size_t kPackedBytes = size_t(1) << 16; // larger was no faster
static constexpr unsigned char kMark[] = {0x1f, 0x8b};
#ifdef __x86_64__
[[gnu::target("avx")]] static void clear_upper_halves() {
    _mm256_zeroupper();
}
#endif

/// Calls isal_inflate(), which leaves upper halves of vector registers in use: all code of the
/// thread that knows nothing of them would be slower from then on, by half in building.
static int inflate(inflate_state& state) {
    const int code = isal_inflate(&state);
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx"))
        clear_upper_halves();
#endif
    return code;
}

/// Returns what is wrong with packed data of which isal_inflate() says so.
static const char* damage_of(int code) {
    switch (code) {
    case ISAL_INVALID_WRAPPER:
        return "its header is none of gzip";
    case ISAL_UNSUPPORTED_METHOD:
        return "unknown compression method";
    case ISAL_INCORRECT_CHECKSUM:
        return "incorrect checksum";
    default:
        return "no code is known by it";
    }
}

/// The state of ISA-L, which unpacks four times as fast as zlib, and the packed bytes that it gets.
class GzipFile::Unpacking {
public:
    explicit Unpacking(GzipFile& file) : file_(file), packed_(kPackedBytes) {
        isal_inflate_init(&state_);
        state_.crc_flag = ISAL_GZIP;
    }
    Unpacking(const Unpacking&) = delete;

    size_t read(std::span<unsigned char> to, std::string& damage) {
        state_.next_out = to.data();
        state_.avail_out = uint32_t(to.size());
        while (state_.avail_out > 0 && !ended_)
            if (const std::string found = unpack_some(); !found.empty()) {
                ended_ = true;
                damage = found;
            }
        return to.size() - state_.avail_out;
    }

private:
    /// Returns what is wrong with the file, nothing where all is well.
    std::string unpack_some() {
        std::string damage;
        if (between_members_) {
            if (state_.avail_in < sizeof(kMark) && !load(damage))
                return damage;
            ended_ = state_.avail_in < sizeof(kMark) ||
                     !std::equal(std::begin(kMark), std::end(kMark), state_.next_in);
            between_members_ = false;
            return {};
        }
        const uint32_t room = state_.avail_out;
        if (const int code = inflate(state_); code < 0 || code == ISAL_NEED_DICT)
            return fmt::format("the compressed data is damaged: {}", damage_of(code));
        if (state_.block_state == ISAL_BLOCK_FINISH) {
            isal_inflate_reset(&state_);
            between_members_ = true;
        } else if (state_.avail_out == room && state_.avail_in == 0) { // it kept nothing to give
            load(damage);
        }
        return damage;
    }

    /// Reads more behind the packed bytes that are left. Returns false where `damage` has the
    /// reason why there are none, though there should be.
    bool load(std::string& damage) {
        std::copy_n(state_.next_in, state_.avail_in, packed_.data());
        state_.next_in = packed_.data();
        const size_t got = file_.read_plain(std::span(packed_).subspan(state_.avail_in), damage);
        state_.avail_in += uint32_t(got);
        if (got == 0 && damage.empty() && !between_members_)
            damage = "the compressed data ends early";
        return damage.empty();
    }

    GzipFile& file_;
    std::vector<unsigned char> packed_;
    inflate_state state_; // set by isal_inflate_init()
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
