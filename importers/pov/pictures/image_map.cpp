// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/image_map.h"

#include "importers/file/text.h"
#include "importers/pov/pictures/picture.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <cassert>

namespace ovc::pov {

namespace {

/// Returns a picture's average color. Before version 3.7 its numbers are not taken for sRGB.
Color average(const Reader& reader, const Picture& picture) {
    assert(picture.size() > 0 && picture.pixels.size() == picture.size());
    std::array<double, 256> linear;
    for (size_t i = 0; i < linear.size(); ++i)
        linear[i] =
            reader.has_linear_colors() ? from_srgb(double(i) / 255, reader.gamma) : double(i) / 255;
    dvec3 sum(0);
    double opacity = 0;
    for (const auto& p : picture.pixels) {
        sum += dvec3(linear[p[0] >> 8], linear[p[1] >> 8], linear[p[2] >> 8]);
        opacity += p[3] / 65535.0;
    }
    const double count = double(picture.size());
    return {vec3(sum / count), 0, float(1 - opacity / count)};
}

/// Reads `all A` behind filter or transmit and adds A to `share`. Without all, it reads and ignores
/// the number of a color and its amount.
void parse_through(Reader& reader, float& share) {
    const bool all = reader.take("all");
    if (!all) {
        parse_float(reader);
        reader.take_comma();
    }
    const double amount = parse_float(reader);
    share += all ? float(amount) : 0;
}

} // namespace

void parse_image_map(Reader& reader, const Token& word, Pigment& pigment) {
    const auto note = [&](const std::string& kind, const Place& at, const std::string& sentence) {
        pigment.notes = {make_note(kind, at, sentence)};
    };
    pigment.color = {vec3(0.5f)};
    pigment.other.reset();
    reader.expect('{', "image_map");
    const Place start = reader.peek().place;
    if (reader.peek().kind == TokenKind::Name && !starts_text(reader, reader.peek()) &&
        reader.peek().name->is_keyword)
        reader.next(); // png and the like, which the file itself tells
    if (!starts_text(reader, reader.peek())) {
        skip_block(reader); // a function or pigment
        note("image_map", start, "an image_map that is computed is drawn by a middle grey");
        return;
    }
    const std::string name = parse_text(reader);
    Color color;
    const std::filesystem::path path = reader.find_file(name, ".png");
    const Result<Picture> picture =
        path.empty() ? Error{fmt::format("there is no file {}", ovc::quoted(name))}
                     : read_picture(path);
    if (picture) {
        color = average(reader, *picture);
        reader.spend(picture->size() / 16);
        note("image_map", word.place, "image_map is drawn by its average color");
    } else
        note("image_map " + name, start,
             fmt::format("{}: the image_map is drawn by a middle grey", picture.error().message));
    while (!reader.take('}')) {
        if (reader.take("filter"))
            parse_through(reader, color.filter);
        else if (reader.take("transmit"))
            parse_through(reader, color.transmit);
        else if (reader.next().kind == TokenKind::End)
            reader.fail(start, "found no '}' to image_map");
    }
    if (picture)
        pigment.color = color;
}

} // namespace ovc::pov
