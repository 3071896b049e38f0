// SPDX-License-Identifier: Apache-2.0
// Reads PNG into channels, and chooses the reader by a file's first bytes.
#include "host/diff/channels.h"

#include "core/system/parallel.h"
#include "core/text/suggestion.h"
#include "host/output/srgb.h"
#include "importers/png.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

namespace ovc {

namespace fs = std::filesystem;

const Layer* Channels::find(std::string_view name) const {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Layer& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

static Layer channel_of(const Picture& picture, size_t sample, const char* name) {
    Layer layer{name, Layer::Type::Float, std::vector<uint32_t>(picture.size())};
    for (size_t i = 0; i < picture.size(); ++i)
        layer.values[i] = std::bit_cast<uint32_t>(float(picture.pixels[i][sample]) / 65535);
    return layer;
}

static Result<Channels> png_channels(std::string_view file) {
    const Result<Picture> picture =
        read_png({reinterpret_cast<const uint8_t*>(file.data()), file.size()});
    if (!picture)
        return picture.error();
    Channels channels{picture->width, picture->height, Coding::Srgb, {}};
    const bool opaque = std::all_of(picture->pixels.begin(), picture->pixels.end(),
                                    [](const auto& pixel) { return pixel[3] == 65535; });
    static constexpr const char* kNames[] = {"R", "G", "B", "A"};
    for (size_t sample = 0; sample < (opaque ? 3u : 4u); ++sample)
        channels.all.push_back(channel_of(*picture, sample, kNames[sample]));
    return channels;
}

Result<Channels> read_channels(const fs::path& path) {
    const auto failed = [&](const std::string& what) {
        return Error{fmt::format("{}: {}", path.string(), what)};
    };
    std::error_code ec;
    if (fs::is_directory(path, ec))
        return failed("found a directory, expected a picture, .png or .exr");
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        return failed(fmt::format("cannot be read: {}{}", std::strerror(errno),
                                  errno == ENOENT ? did_you_mean_file(path) : ""));
    std::string file(4, 0);
    stream.read(file.data(), std::streamsize(file.size()));
    const bool is_png = file == "\x89PNG";
    if (!is_png && file != "\x76\x2f\x31\x01")
        return failed("found neither PNG nor OpenEXR");
    file.append(std::istreambuf_iterator<char>(stream), {}); // which may be a pipe
    Result<Channels> channels = is_png ? png_channels(file) : read_exr(file);
    return channels ? std::move(channels) : failed(channels.error().message);
}

void add_opacity(Channels& a, Channels& b) {
    assert(a.coding == Coding::Srgb && b.coding == Coding::Srgb);
    for (const auto& [to, from] : {std::pair(&a, &b), std::pair(&b, &a)})
        if (from->find("A") && !to->find("A"))
            to->all.push_back({"A", Layer::Type::Float,
                               std::vector<uint32_t>(to->size(), std::bit_cast<uint32_t>(1.0f))});
}

void encode_srgb(Channels& channels) {
    assert(channels.coding == Coding::Linear);
    for (Layer& layer : channels.all)
        if ((layer.name == "R" || layer.name == "G" || layer.name == "B") &&
            layer.type == Layer::Type::Float)
            parallel_for(layer.values.size(), 4096, [&](size_t first, size_t last) {
                for (size_t i = first; i < last; ++i)
                    layer.values[i] =
                        std::bit_cast<uint32_t>(srgb_code(std::bit_cast<float>(layer.values[i])));
            });
    channels.coding = Coding::Srgb;
}

} // namespace ovc
