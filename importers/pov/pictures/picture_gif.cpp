// SPDX-License-Identifier: Apache-2.0
// Reads the first picture of a GIF file. Based on: "Graphics Interchange Format, Version 89a",
// CompuServe 1990, appendix F for the packing.
#include "importers/pov/pictures/picture.h"

#include <algorithm>
#include <cassert>

namespace ovc::pov {

namespace {

/// Gives bytes in order. Behind the end it gives 0 and remembers that the file has ended.
class Input {
public:
    explicit Input(Bytes file) : file_(file) {}
    uint32_t byte() { return at_ < file_.size() ? file_[at_++] : (ended_ = true, 0u); }
    uint32_t word() {
        const uint32_t low = byte();
        return low | byte() << 8;
    }
    void skip(size_t count) { at_ += std::min(count, file_.size() - at_); }
    bool ended() const { return ended_; }

private:
    Bytes file_;
    size_t at_ = 0;
    bool ended_ = false;
};

using Table = std::array<std::array<uint8_t, 3>, 256>;

void read_table(Input& in, uint32_t flags, Table& table) {
    for (uint32_t i = 0; (flags & 0x80) && i < (2u << (flags & 7)); ++i)
        for (uint8_t& part : table[i])
            part = uint8_t(in.byte());
}

/// Reads sub-blocks of up to 255 bytes each and joins them.
std::vector<uint8_t> read_blocks(Input& in) {
    std::vector<uint8_t> data;
    while (const uint32_t count = in.byte())
        for (uint32_t i = 0; i < count; ++i)
            data.push_back(uint8_t(in.byte()));
    return data;
}

/// Returns `count` indices, or fewer where the data is damaged. Each code stands for the indices of
/// an earlier code and one more. min_bits: 1 to 8.
std::vector<uint8_t> unpack(const std::vector<uint8_t>& data, uint32_t min_bits, size_t count) {
    assert(min_bits >= 1 && min_bits <= 8);
    constexpr uint32_t kCodes = 4096;
    std::vector<uint8_t> out, backwards;
    std::vector<uint16_t> before(kCodes, 0);
    std::vector<uint8_t> last(kCodes, 0);
    const uint32_t clear = 1u << min_bits, end = clear + 1;
    for (uint32_t i = 0; i < clear; ++i)
        last[i] = uint8_t(i);
    uint32_t next = end + 1, bits = min_bits + 1, previous = kCodes;
    uint64_t held = 0;
    uint32_t held_bits = 0;
    for (size_t at = 0; out.size() < count;) {
        for (; held_bits < bits && at < data.size(); held_bits += 8)
            held |= uint64_t(data[at++]) << held_bits;
        if (held_bits < bits)
            break;
        const uint32_t code = uint32_t(held & ((1u << bits) - 1));
        held >>= bits;
        held_bits -= bits;
        if (code == end || code > next || (code == next && previous == kCodes))
            break;
        if (code == clear) {
            next = end + 1;
            bits = min_bits + 1;
            previous = kCodes;
            continue;
        }
        // A code that this step completes ends with its own first index.
        backwards.clear();
        for (uint32_t c = code == next ? previous : code;; c = before[c]) {
            backwards.push_back(last[c]);
            if (c < clear)
                break;
        }
        const uint8_t first = backwards.back();
        out.insert(out.end(), backwards.rbegin(), backwards.rend());
        if (code == next)
            out.push_back(first);
        if (previous != kCodes && next < kCodes) {
            before[next] = uint16_t(previous);
            last[next++] = first;
            if (next == (1u << bits) && bits < 12)
                ++bits;
        }
        previous = code;
    }
    out.resize(std::min(out.size(), count));
    return out;
}

/// Returns the rows of a picture in the order of an interlaced file: every eighth first, then those
/// between, and so on.
std::vector<uint32_t> interlaced_rows(uint32_t height) {
    std::vector<uint32_t> rows;
    for (const auto& [first, step] : {std::pair(0u, 8u), {4u, 8u}, {2u, 4u}, {1u, 2u}})
        for (uint32_t y = first; y < height; y += step)
            rows.push_back(y);
    assert(rows.size() == height);
    return rows;
}

} // namespace

Result<Picture> read_gif(Bytes file) {
    Input in(file);
    in.skip(10); // "GIF89a" and the size of the screen
    Table table{};
    const uint32_t screen = in.byte();
    in.skip(2);
    read_table(in, screen, table);
    for (uint32_t kind = in.byte(); kind != ','; kind = in.byte()) {
        if (kind != '!')
            return Error{"found a GIF file without a picture"};
        in.skip(1);
        read_blocks(in);
    }
    in.skip(4); // the picture's place on the screen
    const uint32_t width = in.word(), height = in.word(), flags = in.byte();
    read_table(in, flags, table);
    const uint32_t min_bits = in.byte();
    Result<Picture> picture = make_picture(width, height);
    if (!picture)
        return picture;
    if (min_bits < 1 || min_bits > 8)
        return Error{"found a damaged GIF picture"};
    const std::vector<uint8_t> indices = unpack(read_blocks(in), min_bits, picture->size());
    if (indices.size() < picture->size())
        return Error{"found a GIF picture that ends too early"};
    std::vector<uint32_t> rows;
    if (flags & 0x40)
        rows = interlaced_rows(height);
    picture->indices.resize(picture->size());
    picture->pixels.resize(picture->size());
    for (size_t i = 0; i < indices.size(); ++i) {
        const size_t y = i / width;
        const size_t to = (rows.empty() ? y : rows[y]) * width + i % width;
        const auto& c = table[indices[i]];
        picture->indices[to] = indices[i];
        picture->pixels[to] = {uint16_t(257 * c[0]), uint16_t(257 * c[1]), uint16_t(257 * c[2]),
                               65535};
    }
    return picture;
}

} // namespace ovc::pov
