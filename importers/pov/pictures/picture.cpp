// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/picture.h"

#include "importers/png.h"

#include <fmt/format.h>

#include <cassert>
#include <cstring>
#include <fstream>

namespace ovc::pov {

namespace {

constexpr uintmax_t kLargestFile = uintmax_t(1) << 30;

bool begins_with(Bytes file, std::string_view magic) {
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

Result<Picture> read_any(Bytes file, const std::filesystem::path& path) {
    if (begins_with(file, "\x89PNG"))
        return read_png(file);
    if (begins_with(file, "\xff\xd8"))
        return read_jpeg(file);
    if (begins_with(file, "GIF8"))
        return read_gif(file);
    if (file.size() > 2 && file[0] == 'P' && file[1] >= '2' && file[1] <= '6' && file[1] != '4')
        return read_pnm(file);
    const std::string extension = path.extension().string();
    if (extension == ".tga" || extension == ".TGA")
        return read_tga(file);
    return Error{"found no PNG, JPEG, GIF, PGM, PPM or TGA picture"};
}

} // namespace

Result<Picture> read_picture(const std::filesystem::path& path) {
    std::error_code ec;
    const uintmax_t size = std::filesystem::file_size(path, ec);
    std::ifstream stream(path, std::ios::binary);
    if (ec || !stream || size > kLargestFile)
        return Error{fmt::format("{}: it cannot be read", path.string())};
    std::vector<uint8_t> file(size);
    stream.read(reinterpret_cast<char*>(file.data()), std::streamsize(size));
    file.resize(size_t(stream.gcount()));
    Result<Picture> picture = read_any(file, path);
    if (!picture)
        return Error{fmt::format("{}: {}", path.string(), picture.error().message)};
    return picture;
}

double height_of(const Picture& picture, size_t pixel) {
    assert(pixel < picture.size());
    if (!picture.indices.empty())
        return picture.indices[pixel] / 256.0;
    const auto& p = picture.pixels[pixel];
    if (picture.gray)
        return p[0] / 65535.0;
    return (256 * (p[0] >> 8) + (p[1] >> 8)) / 65535.0;
}

} // namespace ovc::pov
