// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/shapes/font.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace ovc::pov {

struct Font::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;

    ~Face() {
        FT_Done_Face(face); // FreeType allows null here and below
        FT_Done_FreeType(library);
    }
};

namespace {

/// Gathers the outlines of a letter, which FreeType gives by callbacks.
struct Drawing {
    Letter letter;
    double scale = 1;
    dvec2 at{0};

    dvec2 point(const FT_Vector* v) const { return scale * dvec2(double(v->x), double(v->y)); }

    void add(bool straight, const dvec2& b, const dvec2& c, const dvec2& to) {
        if (!letter.outlines.empty() && !(straight && at == to))
            letter.outlines.back().push_back({straight, {at, b, c, to}});
        at = to;
    }

    static int move(const FT_Vector* to, void* drawing) {
        auto& self = *static_cast<Drawing*>(drawing);
        self.letter.outlines.emplace_back();
        self.at = self.point(to);
        return 0;
    }
    static int line(const FT_Vector* to, void* drawing) {
        auto& self = *static_cast<Drawing*>(drawing);
        self.add(true, self.at, self.at, self.point(to));
        return 0;
    }
    /// Adds a curve of degree 2 as one of degree 3.
    static int conic(const FT_Vector* control, const FT_Vector* to, void* drawing) {
        auto& self = *static_cast<Drawing*>(drawing);
        const dvec2 c = self.point(control), end = self.point(to);
        self.add(false, (self.at + 2.0 * c) / 3.0, (end + 2.0 * c) / 3.0, end);
        return 0;
    }
    static int cubic(const FT_Vector* b, const FT_Vector* c, const FT_Vector* to, void* drawing) {
        auto& self = *static_cast<Drawing*>(drawing);
        self.add(false, self.point(b), self.point(c), self.point(to));
        return 0;
    }
};

/// Fonts of symbols have the letter with code c at kSymbols + c.
constexpr char32_t kSymbols = 0xf000;

} // namespace

Font::Font(std::unique_ptr<Face> face) : face_(std::move(face)) {}
Font::~Font() = default;

Result<std::unique_ptr<Font>> Font::open(const std::filesystem::path& path) {
    auto face = std::make_unique<Face>();
    if (FT_Init_FreeType(&face->library) != 0)
        return Error{fmt::format("{}: FreeType cannot be started", path.string())};
    if (FT_New_Face(face->library, path.c_str(), 0, &face->face) != 0 ||
        !FT_IS_SCALABLE(face->face) || face->face->units_per_EM == 0)
        return Error{fmt::format("{}: it is no font with outlines", path.string())};
    if (!face->face->charmap && face->face->num_charmaps > 0) // there is no Unicode charmap
        FT_Set_Charmap(face->face, face->face->charmaps[0]);
    return std::unique_ptr<Font>(new Font(std::move(face)));
}

const Letter& Font::letter(char32_t code) {
    const auto [at, is_new] = letters_.try_emplace(code);
    if (!is_new)
        return at->second;
    const FT_Face face = face_->face;
    Drawing drawing;
    drawing.scale = 1.0 / face->units_per_EM;
    drawing.letter.glyph = FT_Get_Char_Index(face, code);
    if (drawing.letter.glyph == 0 && code < 256)
        drawing.letter.glyph = FT_Get_Char_Index(face, kSymbols + code);
    if (FT_Load_Glyph(face, drawing.letter.glyph, FT_LOAD_NO_SCALE) == 0) {
        drawing.letter.bearing = drawing.scale * double(face->glyph->metrics.horiBearingX);
        drawing.letter.advance = drawing.scale * double(face->glyph->metrics.horiAdvance);
        if (face->glyph->format == FT_GLYPH_FORMAT_OUTLINE) {
            const FT_Outline_Funcs funcs = {
                Drawing::move, Drawing::line, Drawing::conic, Drawing::cubic, 0, 0};
            FT_Outline_Decompose(&face->glyph->outline, &funcs, &drawing);
        }
    }
    at->second = std::move(drawing.letter);
    return at->second;
}

double Font::kerning(const Letter& left, const Letter& right) const {
    FT_Vector by{0, 0};
    if (FT_Get_Kerning(face_->face, left.glyph, right.glyph, FT_KERNING_UNSCALED, &by) != 0)
        return 0;
    return double(by.x) / face_->face->units_per_EM;
}

std::u32string codes_of(std::string_view text) {
    std::u32string codes;
    for (size_t i = 0; i < text.size();) {
        const auto byte = [&](size_t at) { return char32_t(uint8_t(text[at])); };
        const char32_t first = byte(i);
        const size_t more = first >= 0xf0 && first < 0xf8 ? 3 : first >= 0xe0 ? 2 : 1;
        bool is_utf8 = first >= 0xc2 && first < 0xf8 && i + more < text.size();
        char32_t code = first & (0x3f >> more);
        for (size_t k = 1; is_utf8 && k <= more; ++k) {
            is_utf8 = (byte(i + k) & 0xc0) == 0x80;
            code = code << 6 | (byte(i + k) & 0x3f);
        }
        codes += is_utf8 ? code : first;
        i += is_utf8 ? more + 1 : 1;
    }
    return codes;
}

} // namespace ovc::pov
