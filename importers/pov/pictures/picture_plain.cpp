// SPDX-License-Identifier: Apache-2.0
// Reads PGM and PPM (netpbm) and TGA (Truevision 1991), whose pixels are plain numbers in a row.
#include "importers/pov/pictures/picture.h"

#include <algorithm>
#include <cassert>

namespace ovc::pov {

namespace {

class PnmReader {
public:
    explicit PnmReader(Bytes file) : file_(file), kind_(char(file[1])) {}

    Result<Picture> read() {
        const bool is_text = kind_ == '2' || kind_ == '3', is_gray = kind_ == '2' || kind_ == '5';
        const uint64_t width = number(), height = number(), max_value = number();
        Result<Picture> picture = make_picture(width, height);
        if (!picture)
            return picture;
        if (max_value == 0 || max_value > 65535)
            return Error{"found a PGM or PPM picture whose samples do not go to 1 to 65535"};
        if (!is_text)
            ++at_; // one space ends the header
        const size_t channels = is_gray ? 1 : 3, bytes = max_value > 255 ? 2 : 1;
        const size_t min_bytes = picture->size() * channels * (is_text ? 1 : bytes);
        if (at_ > file_.size() || file_.size() - at_ < min_bytes)
            return Error{"found a PGM or PPM picture that ends too early"};
        picture->gray = is_gray;
        picture->pixels.resize(picture->size());
        for (auto& pixel : picture->pixels) {
            for (size_t c = 0; c < channels; ++c) {
                const uint64_t sample = is_text ? number() : raw(bytes);
                pixel[c] = uint16_t(std::min(sample, max_value) * 65535 / max_value);
            }
            if (is_gray)
                pixel[1] = pixel[2] = pixel[0];
            pixel[3] = 65535;
        }
        return picture;
    }

private:
    uint64_t raw(size_t bytes) {
        assert(at_ + bytes <= file_.size());
        uint64_t value = 0;
        for (size_t i = 0; i < bytes; ++i)
            value = value << 8 | file_[at_++];
        return value;
    }

    /// Reads a decimal number. Returns 0 where there is none, and at most 10^9.
    uint64_t number() {
        for (; at_ < file_.size() && !(file_[at_] >= '0' && file_[at_] <= '9'); ++at_)
            if (file_[at_] == '#')
                while (at_ < file_.size() && file_[at_] != '\n')
                    ++at_;
        uint64_t value = 0;
        for (; at_ < file_.size() && file_[at_] >= '0' && file_[at_] <= '9'; ++at_)
            value = std::min<uint64_t>(value * 10 + (file_[at_] - '0'), 1'000'000'000);
        return value;
    }

    Bytes file_;
    size_t at_ = 2;
    char kind_;
};

/// Returns the unpacked bytes of all pixels, or fewer where the file ends too early.
std::vector<uint8_t> tga_pixels(Bytes data, size_t count, size_t bytes, bool packed) {
    const size_t wanted = count * bytes;
    if (!packed)
        return {data.begin(), data.begin() + ptrdiff_t(std::min(wanted, data.size()))};
    std::vector<uint8_t> out;
    for (size_t at = 0; at < data.size() && out.size() < wanted;) {
        const size_t length = (data[at] & 0x7f) + 1u;
        const bool repeated = data[at++] & 0x80;
        const size_t taken = repeated ? bytes : bytes * length;
        if (data.size() - at < taken)
            break;
        for (size_t i = 0; i < (repeated ? length : 1); ++i)
            out.insert(out.end(), data.begin() + ptrdiff_t(at),
                       data.begin() + ptrdiff_t(at + taken));
        at += taken;
    }
    return out;
}

} // namespace

Result<Picture> read_pnm(Bytes file) {
    assert(file.size() >= 2);
    return PnmReader(file).read();
}

Result<Picture> read_tga(Bytes file) {
    if (file.size() < 18)
        return Error{"found a TGA picture that ends too early"};
    const auto word = [&](size_t at) { return uint32_t(file[at] | file[at + 1] << 8); };
    const uint32_t kind = file[2] & 7u;
    const size_t bytes = file[16] / 8u, table_bytes = file[7] / 8u, first = word(3);
    const bool known = (kind == 1 && bytes == 1 && table_bytes >= 3 && table_bytes <= 4) ||
                       (kind == 2 && (bytes == 3 || bytes == 4)) || (kind == 3 && bytes == 1);
    if (!known)
        return Error{"found a TGA picture that is not of 8, 24 or 32 bits a pixel"};
    Result<Picture> picture = make_picture(word(12), word(14));
    if (!picture)
        return picture;
    const size_t table_at = 18u + file[0];
    const size_t table_size = file[1] ? word(5) * ((file[7] + 7u) / 8u) : 0;
    if (file.size() < table_at + table_size)
        return Error{"found a TGA picture that ends too early"};
    const Bytes table = file.subspan(table_at, table_size);
    const std::vector<uint8_t> data =
        tga_pixels(file.subspan(table_at + table_size), picture->size(), bytes, file[2] & 8);
    if (data.size() < picture->size() * bytes)
        return Error{"found a TGA picture that ends too early"};

    const bool from_top = file[17] & 0x20, from_right = file[17] & 0x10;
    picture->gray = kind == 3;
    picture->pixels.resize(picture->size());
    picture->indices.resize(kind == 1 ? picture->size() : 0);
    for (size_t i = 0; i < picture->size(); ++i) {
        const size_t x = i % picture->width, y = i / picture->width;
        const size_t to = (from_top ? y : picture->height - 1 - y) * picture->width +
                          (from_right ? picture->width - 1 - x : x);
        const uint8_t* p = data.data() + i * bytes;
        uint8_t black[4] = {0, 0, 0, 255};
        if (kind == 1) {
            picture->indices[to] = p[0];
            const size_t entry = (p[0] - first) * table_bytes;
            p = p[0] >= first && entry + table_bytes <= table.size() ? table.data() + entry : black;
        }
        const bool gray = kind == 3;
        picture->pixels[to] = {uint16_t(257 * p[gray ? 0 : 2]), uint16_t(257 * p[gray ? 0 : 1]),
                               uint16_t(257 * p[0]),
                               uint16_t(kind == 2 && bytes == 4 ? 257 * p[3] : 65535)};
    }
    return picture;
}

} // namespace ovc::pov
