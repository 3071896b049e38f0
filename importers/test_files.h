// SPDX-License-Identifier: Apache-2.0
// The importers' tests share these helpers for files and scenes.
#pragma once

#include "importers/importer.h"
#include "tests/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <zlib.h>

namespace ovc {

/// Returns the contents of every file in a folder.
inline std::vector<std::string> contents_of(const std::filesystem::path& folder) {
    std::vector<std::string> contents;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        contents.emplace_back(std::istreambuf_iterator<char>(file),
                              std::istreambuf_iterator<char>());
    }
    return contents;
}

/// A folder whose files are loaded.
class TestFolder : public test::TempFolder {
public:
    /// Returns an error's message without the folder, so that it is the same in every run.
    std::string plain(std::string message) const {
        const std::string prefix = (*this / "").string();
        for (size_t at; (at = message.find(prefix)) != message.npos;)
            message.erase(at, prefix.size());
        return message;
    }

    /// Returns load()'s message, or how many triangles it gave if it should have failed.
    std::string failure(const std::string& name) const {
        const auto scene = load(*this / name);
        if (scene)
            return std::to_string(scene->soup.triangle_count()) + " triangles";
        return plain(scene.error().message);
    }
};

inline std::string gzip(const std::string& text) {
    std::string packed(compressBound(uLong(text.size())) + 32, '\0');
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/// Returns the scene's triangles in order; the test fails if there is no scene.
inline std::vector<Triangle> triangles_of(const Result<Scene>& scene) {
    std::vector<Triangle> triangles;
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return triangles;
    }
    for (const Chunk& chunk : scene->soup.chunks)
        for (uint32_t prim = 0; prim < chunk.size(); ++prim)
            triangles.push_back(chunk.triangle(prim));
    return triangles;
}

/// Returns options whose log gathers the messages.
inline ImportOptions gather(std::vector<std::string>& messages) {
    ImportOptions options;
    options.log = [&messages](LogLevel, const std::string& message) {
        messages.push_back(message);
    };
    return options;
}

/// Returns the bytes of a PNG picture of 8 bits a sample whose rows `samples` holds. colors and
/// opacities: of an indexed picture, 3 and 1 a color; else empty, and samples are RGBA.
inline std::string png_of(uint8_t width, uint8_t height, const std::vector<uint8_t>& samples,
                          const std::string& colors = {}, const std::string& opacities = {}) {
    std::string file = "\x89PNG\r\n\x1a\n";
    const auto number = [](uLong n) {
        return std::string{char(n >> 24), char(n >> 16), char(n >> 8), char(n)};
    };
    const auto chunk = [&](const std::string& kind, const std::string& data) {
        const std::string checked = kind + data;
        file +=
            number(uLong(data.size())) + checked +
            number(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size())));
    };
    const char type = colors.empty() ? 6 : 3;
    chunk("IHDR", number(width) + number(height) + std::string{8, type, 0, 0, 0});
    if (!colors.empty())
        chunk("PLTE", colors);
    if (!opacities.empty())
        chunk("tRNS", opacities);
    std::string rows;
    const size_t stride = samples.size() / height;
    for (size_t y = 0; y < height; ++y)
        rows += '\0' + std::string(samples.begin() + ptrdiff_t(y * stride),
                                   samples.begin() + ptrdiff_t((y + 1) * stride));
    uLongf size = compressBound(uLong(rows.size()));
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(rows.data()), uLong(rows.size()));
    chunk("IDAT", packed.substr(0, size));
    chunk("IEND", "");
    return file;
}

/// load() must come back, with a scene or with an error, on every beginning of the file and with
/// any one bit changed.
inline void survive_damage(const TestFolder& folder, const std::string& name) {
    const std::string whole = folder.read(name);
    const std::string damaged_name = "damaged-" + name;
    for (size_t length = 0; length < whole.size(); ++length) {
        const auto scene = load(folder.write(damaged_name, whole.substr(0, length)));
        if (!scene) {
            ASSERT_NE(scene.error().message.find(damaged_name), std::string::npos);
        }
    }
    for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::string damaged = whole;
        damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
        const auto scene = load(folder.write(damaged_name, damaged));
        if (scene) {
            ASSERT_LT(scene->soup.triangle_count(), whole.size()) << "bit " << bit;
        }
    }
}

} // namespace ovc
