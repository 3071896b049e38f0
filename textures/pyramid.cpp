// SPDX-License-Identifier: Apache-2.0
// Each level takes the mean of the level below by a box filter, row by row.
#include "textures/pyramid.h"

#include <OpenImageIO/imageio.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace ovc {

static int scratch_file() {
    std::string path =
        (std::filesystem::temp_directory_path() / "overcast-texture-XXXXXX").string();
    const int file = mkstemp(path.data());
    if (file < 0)
        throw std::system_error(errno, std::generic_category(), "no scratch file " + path);
    unlink(path.c_str()); // it goes with its descriptor
    return file;
}

static int tiles_along(int size) {
    return (size + Pyramid::kTile - 1) / Pyramid::kTile;
}

int Pyramid::size_at(int finest, int level) {
    return std::max(1, finest >> level);
}

int Pyramid::levels(int width, int height) {
    int count = 1;
    while (std::max(width, height) >> count)
        ++count;
    return count;
}

Pyramid::Pyramid(int width, int height, int channels, OIIO::TypeDesc format)
    : channels_(size_t(channels)), format_(format), file_(scratch_file()) {
    uint64_t offset = 0;
    for (int i = 0; i < levels(width, height); ++i) {
        const Level level{size_at(width, i), size_at(height, i), offset, 0, {}, {}};
        offset +=
            uint64_t(tiles_along(level.width)) * uint64_t(tiles_along(level.height)) * tile_bytes();
        levels_.push_back(level);
    }
}

Pyramid::~Pyramid() {
    close(file_);
}

void Pyramid::add_row(size_t number, std::span<const float> values) {
    Level& level = levels_[number];
    assert(values.size() == size_t(level.width) * channels_ && level.rows < level.height);
    level.strip.insert(level.strip.end(), values.begin(), values.end());
    ++level.rows;
    const int waiting = int(level.strip.size() / values.size());
    if (waiting == kTile || level.rows == level.height) {
        write_strip(level, level.rows - waiting, waiting);
        level.strip.clear();
    }
    if (number + 1 < levels_.size())
        add_to_next(number, values);
}

/// Returns the mean of the pixels of a row that each pixel of a narrower row covers.
static std::vector<float> narrowed(std::span<const float> row, int from, int to, size_t channels) {
    std::vector<float> result(size_t(to) * channels);
    // Pixel i of `from` covers [i to, (i + 1) to) and pixel j of `to` covers [j from, (j + 1)
    // from).
    for (int j = 0; j < to; ++j)
        for (int i = int(int64_t(j) * from / to);
             i < from && int64_t(i) * to < int64_t(j + 1) * from; ++i) {
            const int64_t first = std::max(int64_t(i) * to, int64_t(j) * from);
            const int64_t last = std::min(int64_t(i + 1) * to, int64_t(j + 1) * from);
            const float share = float(last - first) / float(from);
            for (size_t c = 0; c < channels; ++c)
                result[size_t(j) * channels + c] += share * row[size_t(i) * channels + c];
        }
    return result;
}

/// Adds a row to the one or two rows of the next level that it is a part of.
void Pyramid::add_to_next(size_t number, std::span<const float> values) {
    Level& level = levels_[number];
    const Level& next = levels_[number + 1];
    const std::vector<float> row = narrowed(values, level.width, next.width, channels_);
    level.sum.resize(row.size());
    const int64_t first = int64_t(level.rows - 1) * next.height; // covered, as in narrowed()
    const int64_t last = first + next.height;
    const int64_t border = (first / level.height + 1) * level.height;
    const auto add = [&](int64_t part) {
        const float share = float(part) / float(level.height);
        for (size_t i = 0; i < row.size(); ++i)
            level.sum[i] += share * row[i];
    };
    add(std::min(last, border) - first);
    if (last < border)
        return;
    add_row(number + 1, level.sum);
    std::fill(level.sum.begin(), level.sum.end(), 0.0f);
    add(last - border);
}

void Pyramid::write_strip(const Level& level, int first_row, int rows) {
    std::vector<float> tile(size_t(kTile) * kTile * channels_);
    std::vector<char> bytes(tile_bytes());
    const int across = tiles_along(level.width);
    for (int t = 0; t < across; ++t) {
        std::fill(tile.begin(), tile.end(), 0.0f);
        const size_t width = size_t(std::min(kTile, level.width - t * kTile)) * channels_;
        for (int y = 0; y < rows; ++y) {
            const float* const from =
                level.strip.data() +
                (size_t(y) * size_t(level.width) + size_t(t) * kTile) * channels_;
            std::copy(from, from + width, tile.begin() + ptrdiff_t(size_t(y) * kTile * channels_));
        }
        OIIO::convert_pixel_values(OIIO::TypeFloat, tile.data(), format_, bytes.data(),
                                   int(tile.size()));
        const uint64_t number = uint64_t(first_row / kTile) * uint64_t(across) + uint64_t(t);
        if (pwrite(file_, bytes.data(), bytes.size(),
                   off_t(level.offset + number * tile_bytes())) != ssize_t(bytes.size()))
            throw std::system_error(errno, std::generic_category(),
                                    "its scratch file is not written");
    }
}

bool Pyramid::read_tile(size_t number, int x, int y, void* to) const {
    const Level& level = levels_[number];
    const uint64_t tile =
        uint64_t(y / kTile) * uint64_t(tiles_along(level.width)) + uint64_t(x / kTile);
    return pread(file_, to, tile_bytes(), off_t(level.offset + tile * tile_bytes())) ==
           ssize_t(tile_bytes());
}

} // namespace ovc
