// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/image_map.h"

#include "importers/file/text.h"
#include "importers/png.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/pictures/holes.h"
#include "importers/pov/pictures/map_picture.h"
#include "importers/pov/pictures/picture.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::pov {

namespace {

/// A block's word gamma: light is a code ^ gamma, or sRGB's (kSrgbGamma).
using GivenGamma = std::optional<double>;

/// Returns the power that turns codes into colors of the scene, or 0 for sRGB's curve. The colors
/// of a scene with an assumed_gamma are light ^ (1 / gamma); the curve is taken for a power of 2.2
/// then. Before version 3.7 codes are colors, unless a gamma is given.
double gamma_of(const Reader& reader, const GivenGamma& given) {
    constexpr double kCurve = 2.2;
    const bool is_srgb = !given || *given == kSrgbGamma;
    if (!reader.has_linear_colors())
        return given.value_or(1);
    if (reader.gamma == kSrgbGamma)
        return is_srgb ? 1 : *given / kCurve;
    if (is_srgb)
        return reader.gamma == 1 ? 0 : kCurve / reader.gamma;
    return *given / reader.gamma;
}

/// Returns the light of the 256 codes of a sample.
std::array<double, 256> light_of_codes(const Reader& reader, const GivenGamma& given) {
    const bool is_srgb = given ? *given == kSrgbGamma : reader.has_linear_colors();
    const double power = gamma_of(reader, given);
    const double to = reader.has_linear_colors() ? reader.gamma : 1;
    std::array<double, 256> light;
    for (size_t i = 0; i < light.size(); ++i)
        light[i] = is_srgb ? from_srgb(double(i) / 255, to) : std::pow(double(i) / 255, power);
    return light;
}

/// Returns a picture's average color.
Color average(const Picture& picture, const std::array<double, 256>& linear) {
    assert(picture.size() > 0 && picture.pixels.size() == picture.size());
    dvec3 sum(0);
    double opacity = 0;
    for (const auto& p : picture.pixels) {
        sum += dvec3(linear[p[0] >> 8], linear[p[1] >> 8], linear[p[2] >> 8]);
        opacity += p[3] / 65535.0;
    }
    const double count = double(picture.size());
    return {vec3(sum / count), 0, float(1 - opacity / count)};
}

/// Reads `all A`, or the number of a color and A, behind filter or transmit.
void parse_through(Reader& reader, MapTransparency& to, float MapTransparency::Share::*kind) {
    if (reader.take("all")) {
        to.all.*kind += float(parse_float(reader));
        return;
    }
    const int index = parse_int(reader, 0, 65535, "the number of a color");
    reader.take_comma();
    to.of_index[index].*kind = float(parse_float(reader));
}

/// The words behind the name of an image_map's picture.
struct MapWords {
    MapTransparency transparency;
    bool smooth = false;
    int type = 0; // 0: the picture lies on x and y
    std::optional<double> bump_size;
    GivenGamma gamma;
    bool use_index = false; // the value is the number of a color in the table, not its brightness
    bool use_alpha = false; // the value is how transparent the picture is

    /// Returns the projection of the type; nothing for one that POV-Ray does not have.
    std::optional<ImageTexture::Projection> projection() const {
        switch (type) {
        case 0:
            return ImageTexture::Projection::Planar;
        case 1:
            return ImageTexture::Projection::Spherical;
        case 2:
            return ImageTexture::Projection::Cylindrical;
        case 5:
            return ImageTexture::Projection::Torus;
        default:
            return std::nullopt;
        }
    }
};

/// Returns whether texels are blended.
bool parse_interpolation(Reader& reader, const Place& place) {
    const double kind = parse_float(reader);
    if (kind == 3 || kind == 4)
        reader.omit("interpolate", place,
                    fmt::format("interpolate {} of a picture is read as interpolate 2", kind));
    return kind > 0;
}

/// Reads the words up to the end of the block, or up to the textures of a material_map.
MapWords parse_map_words(Reader& reader, std::string_view block) {
    MapWords words;
    const bool of_materials = block == "material_map";
    const auto is_texture = [&] {
        const Token token = reader.peek();
        return of_materials && (token.is("texture") || named<Texture>(reader, token));
    };
    while (!is_texture() && (of_materials ? !reader.peek().is('}') : !reader.take('}'))) {
        const Token word = reader.peek();
        if (reader.take("filter"))
            parse_through(reader, words.transparency, &MapTransparency::Share::filter);
        else if (reader.take("transmit"))
            parse_through(reader, words.transparency, &MapTransparency::Share::transmit);
        else if (reader.take("once"))
            words.transparency.once = true;
        else if (reader.take("interpolate"))
            words.smooth = parse_interpolation(reader, word.place);
        else if (reader.take("map_type"))
            words.type = int(parse_float(reader));
        else if (reader.take("bump_size"))
            words.bump_size = parse_float(reader);
        else if (reader.take("gamma"))
            words.gamma = parse_gamma(reader);
        else if (reader.take("use_index"))
            words.use_index = true;
        else if (reader.take("use_color") || reader.take("use_colour"))
            words.use_index = words.use_alpha = false;
        else if (block == "image_pattern" && reader.take("use_alpha"))
            words.use_alpha = true;
        else if (reader.take("premultiplied")) {
            if (parse_flag(reader))
                reader.omit("premultiplied", word.place, "premultiplied of a picture is left out");
        } else if (!reader.take(','))
            reader.fail_here("'}' or a word of a picture");
    }
    return words;
}

ImageMap image_map_of(const Place& start, const std::filesystem::path& path,
                      const ImageTexture& image) {
    return {std::make_shared<const MapPicture>(
                std::filesystem::absolute(path).lexically_normal().string(),
                fmt::format("{}:{}:{}", start.file->name, start.line, start.column), image.gamma),
            image};
}

/// Returns the picture as a texture of the scene, which lets light through where it says so.
PatternPtr shown_by_textures(const Reader& reader, const Place& start,
                             const std::filesystem::path& path, const MapWords& words,
                             const Pigment& pigment) {
    ImageTexture image;
    image.projection = *words.projection();
    image.gamma = gamma_of(reader, words.gamma);
    image.filter = words.smooth ? TexelFilter::Smooth : TexelFilter::Nearest;
    image.beyond_s = image.beyond_t = words.transparency.once ? Beyond::Nothing : Beyond::Repeat;
    image.is_transparent = pigment.color.transmit > 0 || words.transparency.once;
    image.filter_all = words.transparency.all.filter;
    image.transmit_all = words.transparency.all.transmit;
    image.otherwise = pigment.color;
    PatternMap map;
    map.image_map = image_map_of(start, path, image);
    return std::make_shared<const PatternMap>(std::move(map));
}

/// The picture that a block names behind its {.
struct NamedPicture {
    Place start;
    std::string name;
    std::filesystem::path path;
    Result<Picture> picture = Error{"a picture that is computed is not read"};
};

NamedPicture take_picture(Reader& reader, const std::string& block) {
    reader.expect('{', block);
    NamedPicture named{reader.peek().place};
    if (reader.peek().kind == TokenKind::Name && !starts_text(reader, reader.peek()) &&
        reader.peek().name->is_keyword)
        reader.next();                         // png and the like, which the file itself tells
    if (!starts_text(reader, reader.peek())) { // a function or pigment
        skip_arguments(reader);
        return named;
    }
    named.name = parse_text(reader);
    named.path = reader.find_file(named.name, ".png");
    named.picture = named.path.empty()
                        ? Error{fmt::format("there is no file {}", ovc::quoted(named.name))}
                        : read_picture(named.path);
    if (named.picture)
        reader.spend(named.picture->size() / 16);
    return named;
}

/// Returns a texture of the picture's codes, or of how transparent it is. As povray takes it for
/// that, a picture without opacity is as transparent as red, and with a table of colors opaque.
ImageMap image_of_codes(const NamedPicture& named, const MapWords& words) {
    ImageTexture image;
    image.projection = *words.projection();
    image.gamma = words.gamma.value_or(1);
    image.filter = words.smooth ? TexelFilter::Smooth : TexelFilter::Nearest;
    image.beyond_s = image.beyond_t = words.transparency.once ? Beyond::Nothing : Beyond::Repeat;
    if (words.use_alpha) {
        const bool has_opacity =
            std::any_of(named.picture->pixels.begin(), named.picture->pixels.end(),
                        [](const auto& pixel) { return pixel[3] < 65535; });
        image.channel = has_opacity || !named.picture->indices.empty()
                            ? ImageTexture::Channel::Opacity
                            : ImageTexture::Channel::Red;
        if (image.channel == ImageTexture::Channel::Opacity) {
            image.scale = vec3(-1);
            image.offset = vec3(1);
        }
    }
    return image_map_of(named.start, named.path, image);
}

/// Returns the note that a block is not drawn, and why.
const Note* not_drawn(Reader& reader, const Token& word, const Place& at, const std::string& why) {
    return reader.note(word.name->text, at,
                       fmt::format("{}: the {} is left out", why, word.name->text));
}

/// Returns which of `count` a number chooses in povray: the last one where it equals the count.
size_t chosen_of(size_t number, size_t count) {
    return number == count ? count - 1 : number % count;
}

/// Returns a texture of which of `count` the numbers of the picture's colors in its table choose,
/// or its reds without one, as codes of 8 bits.
Result<ImageMap> image_of_indices(const NamedPicture& named, const MapWords& words, size_t count) {
    const Picture& picture = *named.picture;
    std::vector<uint16_t> samples;
    samples.reserve(3 * picture.size());
    for (size_t i = 0; i < picture.size(); ++i) {
        const size_t index =
            picture.indices.empty() ? picture.pixels[i][0] >> 8 : picture.indices[i];
        samples.insert(samples.end(), 3, uint16_t(257 * chosen_of(index, count)));
    }
    const Result<std::string> png =
        write_png({picture.width, picture.height, 8, samples}, "Overcast");
    if (!png)
        return png.error();
    const ImageMap codes = image_of_codes(named, words);
    ImageTexture image = codes.image;
    image.filter = TexelFilter::Nearest;
    image.gamma = 1;
    return ImageMap{std::make_shared<const MapPicture>(
                        codes.picture->path + fmt::format(", choosing from {}", count),
                        codes.picture->asked_for_at, image.gamma,
                        std::vector<uint8_t>(png->begin(), png->end())),
                    image};
}

/// Returns the picture of a material_map of `count` textures as MaterialValues does.
ValueMap values_of_materials(Reader& reader, const Token& word, const NamedPicture& named,
                             const MapWords& words, size_t count) {
    assert(count > 0);
    if (!named.picture || !words.projection())
        return {.why_not = not_drawn(reader, word, named.start,
                                     named.picture ? "its map_type is not known"
                                                   : named.picture.error().message)};
    Result<ImageMap> image = image_of_indices(named, words, count);
    if (!image)
        return {.why_not = not_drawn(reader, word, named.start, image.error().message)};
    return {std::move(*image)};
}

} // namespace

double parse_gamma(Reader& reader) {
    if (reader.take("srgb"))
        return kSrgbGamma;
    const Place at = reader.peek().place;
    const double gamma = parse_float(reader);
    if (!(gamma > 0))
        reader.fail(at, fmt::format("found a gamma of {}, expected one above 0", gamma));
    return gamma;
}

ValueMap parse_value_map(Reader& reader, const Token& word) {
    const NamedPicture named = take_picture(reader, word.name->text);
    const MapWords words = parse_map_words(reader, word.name->text);
    ValueMap map{.bump_size = words.bump_size};
    const bool flat_only = word.is("bump_map");
    if (!named.picture)
        map.why_not = not_drawn(reader, word, named.start, named.picture.error().message);
    else if (!words.projection() || (flat_only && words.type != 0))
        map.why_not = not_drawn(reader, word, named.start,
                                fmt::format("map_type {} is not known", words.type));
    else {
        map.image = image_of_codes(named, words);
        // povray takes no index for the value of an image_pattern, though it reads the word.
        if (flat_only && words.use_index && !named.picture->indices.empty())
            if (Result<ImageMap> image = image_of_indices(named, words, 256); image)
                map.image = std::move(*image);
        if (flat_only)
            map.image->image.filter = TexelFilter::Nearest; // as povray, which ignores the word
    }
    return map;
}

MaterialValues parse_material_picture(Reader& reader, const Token& word) {
    const auto named = std::make_shared<const NamedPicture>(take_picture(reader, word.name->text));
    const MapWords words = parse_map_words(reader, "material_map");
    return [named, words, word](Reader& again, size_t count) {
        return values_of_materials(again, word, *named, words, count);
    };
}

void parse_image_map(Reader& reader, const Token& word, Pigment& pigment) {
    const auto note = [&](const std::string& kind, const Place& at, const std::string& sentence) {
        pigment.notes = {reader.note(kind, at, sentence)};
    };
    pigment.color = {vec3(0.5f)};
    pigment.pattern.reset();
    pigment.holes.reset();
    pigment.placed = dmat4(1);
    const NamedPicture named = take_picture(reader, "image_map");
    const Place& start = named.start;
    const MapWords words = parse_map_words(reader, "image_map");
    if (!named.picture) {
        note("image_map " + named.name, start,
             fmt::format("{}: the image_map is drawn by a middle grey",
                         named.picture.error().message));
        return;
    }
    const Result<Picture>& picture = named.picture;
    const std::array<double, 256> light = light_of_codes(reader, words.gamma);
    pigment.color = average(*picture, light);
    pigment.color.filter += words.transparency.all.filter;
    pigment.color.transmit += words.transparency.all.transmit;
    const auto holes = holes_of(*picture, words.transparency, words.smooth, light);
    pigment.notes.clear();
    if (words.type == 0)
        pigment.holes = holes;
    // A color of the picture's table that lets light through has no place in a texture, except as
    // holes.
    const bool has_table = !words.transparency.of_index.empty() && !pigment.holes;
    const bool is_shown = words.projection() && !has_table;
    if (is_shown)
        pigment.pattern = shown_by_textures(reader, start, named.path, words, pigment);
    else
        note("image_map", word.place, "image_map is drawn by its average color");
    if (words.type == 0)
        return;
    if (holes && !is_shown)
        pigment.notes.push_back(
            reader.note("map_type", word.place,
                        fmt::format("an image_map of map_type {} has no holes", words.type)));
}

} // namespace ovc::pov
