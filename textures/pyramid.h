// SPDX-License-Identifier: Apache-2.0
// Pyramid keeps the mipmaps of a picture as tiles in a scratch file, so that a cache of tiles can
// stay within its memory whatever the picture's own format is. OpenImageIO would hold the whole of
// a picture without tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <OpenImageIO/typedesc.h>

namespace ovc {

class Pyramid {
public:
    static constexpr int kTile = 64; // the width and height of a tile

    /// Error: throws std::system_error where there can be no scratch file. format: of the values in
    /// tiles.
    Pyramid(int width, int height, int channels, OIIO::TypeDesc format);
    ~Pyramid();
    Pyramid(const Pyramid&) = delete;

    /// Adds the next row of the picture: width x channels values. Throws as above.
    void add_row(std::span<const float> values) { add_row(0, values); }

    /// Reads a tile once all rows were added. x, y: of its first pixel. Pixels beyond the level are
    /// zeros. Returns false where the file cannot be read.
    bool read_tile(size_t level, int x, int y, void* to) const;

    /// Returns how many levels a picture of that size has; the last has 1 x 1 pixels.
    static int levels(int width, int height);
    /// Returns the width, or the height, of a level of a picture with that of `finest`.
    static int size_at(int finest, int level);

private:
    struct Level {
        int width, height;
        uint64_t offset;          // of its tiles in the file
        int rows = 0;             // that were added
        std::vector<float> strip; // the rows that are not yet in the file
        std::vector<float> sum;   // of rows, for the next row of the next level
    };

    void add_row(size_t level, std::span<const float> values);
    void add_to_next(size_t level, std::span<const float> values);
    void write_strip(const Level& level, int first_row, int rows);
    size_t tile_bytes() const { return size_t(kTile) * kTile * channels_ * format_.size(); }

    const size_t channels_;
    const OIIO::TypeDesc format_;
    int file_;
    std::vector<Level> levels_;
};

} // namespace ovc
