// SPDX-License-Identifier: Apache-2.0
// Reads text: letters of a font, swept along z from 0 to their thickness.
#include "importers/file/text.h"
#include "importers/pov/shapes/font.h"
#include "importers/pov/shapes/installed_font.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/shapes/sweep.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pov {

namespace {

struct PlacedLetter {
    const Letter* letter; // of a font that the reader keeps
    dvec2 at;
};

/// Returns the font file that povray 3.7 takes for `internal` and a number.
std::string internal_font(int number) {
    static constexpr const char* kFonts[] = {"timrom.ttf", "cyrvetic.ttf", "crystal.ttf"};
    return number >= 1 && number <= 3 ? kFonts[number - 1] : "povlogo.ttf";
}

Font& parse_font(Reader& reader) {
    std::string name;
    const Place at = reader.peek().place;
    if (reader.take("internal"))
        name = internal_font(parse_int(reader, 0, 1000, "the number of a font"));
    else {
        if (!reader.take("ttf"))
            reader.fail_here("ttf or internal, and a font");
        name = parse_text(reader);
    }
    if (const auto font = reader.fonts.find(name); font != reader.fonts.end())
        return *font->second;
    std::filesystem::path path = reader.find_file(name, ".ttf");
    if (path.empty()) {
        path = installed_font(name);
        if (path.empty())
            reader.fail(at, fmt::format("found no file {}, expected a font, and there is none on "
                                        "this machine that could stand in for it",
                                        ovc::quoted(name)));
        reader.omit(
            "font " + name, at,
            fmt::format("found no font {}; {} stands in for it", ovc::quoted(name), path.string()));
    }
    Result<std::unique_ptr<Font>> opened = Font::open(path);
    if (!opened)
        reader.fail(at, opened.error().message);
    return *(reader.fonts[name] = std::move(*opened));
}

std::vector<PlacedLetter> set_letters(Font& font, const std::u32string& codes, const dvec2& step) {
    std::vector<PlacedLetter> letters;
    dvec2 at(0);
    for (const char32_t code : codes) {
        const Letter& letter = font.letter(code);
        // As in POV-Ray the left edge of the first letter is at 0.
        at.x += letters.empty() ? -letter.bearing : font.kerning(*letters.back().letter, letter);
        letters.push_back({&letter, at});
        at += step + dvec2(letter.advance, 0);
    }
    return letters;
}

int steps_of(const OutlinePiece& piece, int segments) {
    return piece.straight ? 1 : std::max(2, segments / 16);
}

std::vector<Contour> contours_of(const PlacedLetter& placed, int segments) {
    std::vector<Contour> contours;
    for (const auto& outline : placed.letter->outlines) {
        Contour contour;
        for (const OutlinePiece& piece : outline)
            for (int i = 0, steps = steps_of(piece, segments); i < steps; ++i) {
                const dvec2 p = placed.at + curve_point(Curve::Bezier, piece.points.data(),
                                                        double(i) / steps, nullptr);
                if (contour.empty() || contour.back() != p)
                    contour.push_back(p);
            }
        if (contour.size() >= 3)
            contours.push_back(std::move(contour));
    }
    return contours;
}

} // namespace

Shape parse_text_shape(Reader& reader) {
    Font& font = parse_font(reader);
    reader.take_comma();
    const std::u32string codes = codes_of(parse_text(reader));
    reader.take_comma();
    const double thickness = parse_float(reader);
    reader.take_comma();
    const dvec3 step = parse_vector(reader); // POV-Ray ignores its z
    reader.spend(codes.size());
    Shape shape;
    std::vector<PlacedLetter> letters = set_letters(font, codes, dvec2(step));
    for (const PlacedLetter& placed : letters)
        for (const auto& outline : placed.letter->outlines)
            for (const OutlinePiece& piece : outline)
                (piece.straight ? shape.fixed : shape.per_segment) += piece.straight ? 4 : 4 / 16.0;
    shape.cut = [letters = std::move(letters), thickness](int segments, bool, Facets& out) {
        const double near = std::min(0.0, thickness), far = std::max(0.0, thickness);
        for (const PlacedLetter& placed : letters)
            sweep(
                contours_of(placed, segments), /* lids= */ true,
                [&](const dvec2& p, bool end) { return dvec3(p, end ? near : far); }, out);
    };
    return shape;
}

} // namespace ovc::pov
