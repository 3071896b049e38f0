// SPDX-License-Identifier: Apache-2.0
// Source: Wavefront, "MTL material format", version 4.2 (1995), "Texture map statements".
#include "importers/mesh/obj/mtl_textures.h"

#include "core/text/lower_case.h"
#include "importers/file/picture_path.h"
#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ovc {

namespace {

/// An option, and how many words at most follow it.
struct Option {
    std::string_view name;
    int words;
    bool are_numbers;
};

constexpr Option kOptions[] = {
    {"-blendu", 1, false}, {"-blendv", 1, false},    {"-bm", 1, true},       {"-boost", 1, true},
    {"-cc", 1, false},     {"-clamp", 1, false},     {"-imfchan", 1, false}, {"-mm", 2, true},
    {"-o", 3, true},       {"-s", 3, true},          {"-t", 3, true},        {"-texres", 1, true},
    {"-type", 1, false},   {"-colorspace", 1, false}};

const Option* option_of(std::string_view word) {
    const auto at = std::find_if(std::begin(kOptions), std::end(kOptions),
                                 [&](const Option& option) { return option.name == word; });
    return at == std::end(kOptions) ? nullptr : at;
}

/// The numbers behind an option.
struct Numbers {
    std::array<double, 3> values{};
    int count = 0;

    double at(size_t i, double otherwise) const { return int(i) < count ? values[i] : otherwise; }
};

/// Takes numbers off the text, at most so many; a word that is none ends them.
Numbers take_numbers(std::string_view& text, int max) {
    Numbers numbers;
    while (numbers.count < max) {
        std::string_view behind = text;
        const auto value = parse_double(next_word(behind));
        if (!value || !std::isfinite(*value))
            break;
        numbers.values[size_t(numbers.count++)] = *value;
        text = behind;
    }
    return numbers;
}

/// Takes the words of an option off the text. -s and -o state u and v, and w where pictures are
/// solid; what they leave out is 1 or 0.
void take_option(const Option& option, std::string_view& text, MtlTexture& texture) {
    if (!option.are_numbers) {
        const std::string_view word = next_word(text);
        if (option.name == "-clamp")
            texture.clamp = word == "on";
        if (option.name == "-imfchan")
            texture.channel = word.empty() ? '\0' : word[0];
        return;
    }
    const Numbers n = take_numbers(text, option.words);
    if (option.name == "-s")
        texture.scale = {n.at(0, 1), n.at(1, 1)};
    else if (option.name == "-o")
        texture.offset = {n.at(0, 0), n.at(1, 0)};
    else if (option.name == "-t")
        texture.is_turbulent = n.at(0, 0) != 0 || n.at(1, 0) != 0;
    else if (option.name == "-mm") {
        texture.base = n.at(0, 0);
        texture.gain = n.at(1, 1);
    } else if (option.name == "-bm")
        texture.bump = n.at(0, 1);
}

ImageTexture::Channel channel_of(const MtlTexture& texture) {
    switch (texture.channel) {
    case 'r':
        return ImageTexture::Channel::Red;
    case 'g':
        return ImageTexture::Channel::Green;
    case 'b':
        return ImageTexture::Channel::Blue;
    case 'm':
        return ImageTexture::Channel::Opacity;
    default:
        return texture.keyword == "map_d" && texture.channel == 0 ? ImageTexture::Channel::Mask
                                                                  : ImageTexture::Channel::Color;
    }
}

/// Returns the picture, whose values become light by `gamma`.
Texture image_of(const MtlTexture& texture, uint32_t picture, double gamma) {
    ImageTexture image;
    image.picture = picture;
    image.to_picture = {dvec3(texture.scale.x, 0, texture.offset.x),
                        dvec3(0, texture.scale.y, texture.offset.y)};
    image.beyond_s = image.beyond_t = texture.clamp ? Beyond::Clamp : Beyond::Repeat;
    image.gamma = gamma;
    image.channel = channel_of(texture);
    image.scale = vec3(float(texture.gain));
    image.offset = vec3(float(texture.base));
    Texture result;
    result.kind = TextureKind::Image;
    result.on_uv = true;
    result.image = image;
    return result;
}

/// The picture's color is multiplied by Kd, as the format says, unless that is black: programs
/// write 0 0 0 where a picture is meant to stand alone.
void add_color(Texture image, Scene& scene, Material& material) {
    image.image->otherwise = {material.color};
    const vec3 factor = material.color == vec3(0) ? vec3(1) : material.color;
    image.image->scale *= factor;
    image.image->offset *= factor;
    material.texture = placed_in_world(add_texture(scene, std::move(image)));
}

/// The keywords in lower case: programs write them both ways.
bool is_bump(std::string_view keyword) {
    return keyword == "map_bump" || keyword == "bump";
}

} // namespace

MtlTexture parse_mtl_texture(std::string_view keyword, std::string_view rest, uint64_t line) {
    MtlTexture texture;
    texture.keyword = lower_case(std::string(keyword));
    texture.line = line;
    rest = trimmed(rest);
    std::string_view name = rest.substr(0, 0); // from its first word to its last
    while (!rest.empty()) {
        const std::string_view word = next_word(rest);
        if (const Option* const option = option_of(word)) {
            take_option(*option, rest, texture);
        } else if (name.empty()) {
            name = word;
        } else {
            name = {name.data(), size_t(word.data() + word.size() - name.data())};
        }
        skip_blanks(rest);
    }
    texture.file = name;
    return texture;
}

bool is_shown(const MtlTexture& texture) {
    const std::string& k = texture.keyword;
    return !texture.file.empty() && (k == "map_kd" || k == "map_ks" || k == "map_ke" ||
                                     k == "map_d" || k == "norm" || is_bump(k));
}

void add_mtl_texture(const MtlTexture& texture, const std::filesystem::path& library, Scene& scene,
                     MtlMaterial& to) {
    const uint32_t picture =
        add_picture(scene, picture_path(library.parent_path(), texture.file),
                    fmt::format("{}, line {}", library.string(), texture.line));
    const bool is_color = texture.keyword.starts_with("map_k");
    Texture image = image_of(texture, picture, is_color ? 0 : 1);
    if (texture.keyword == "map_kd")
        return add_color(std::move(image), scene, to.material);
    image.image->otherwise = {vec3(1)};
    if (texture.keyword == "map_d") {
        to.cutout = Cutout{.texture = add_texture(scene, std::move(image))};
        return;
    }
    if (is_color) {
        if (!to.material.maps)
            to.material.maps.emplace();
        MaterialMaps& maps = *to.material.maps;
        (texture.keyword == "map_ks" ? maps.reflection : maps.emission) =
            add_texture(scene, std::move(image));
        return;
    }
    const bool is_normal = texture.keyword == "norm";
    image.image->otherwise = {is_normal ? vec3(0.5f, 0.5f, 1) : vec3(0)};
    to.material.normal_map =
        NormalMap{is_normal ? NormalMap::Kind::Tangent : NormalMap::Kind::Texels,
                  add_texture(scene, std::move(image)), texture.bump};
}

} // namespace ovc
