// SPDX-License-Identifier: Apache-2.0
// Fonts: the outlines of letters, in units of the font's height. Only font.cpp includes FreeType.
#pragma once

#include "core/result.h"
#include "importers/pov/shapes/contour.h"

#include <filesystem>
#include <map>
#include <memory>

namespace ovc::pov {

/// A part of an outline: straight, or a Bezier curve of degree 3.
struct OutlinePiece {
    bool straight = true;
    std::array<dvec2, 4> points; // a straight piece runs from the first to the last
};

struct Letter {
    uint32_t glyph = 0;
    std::vector<std::vector<OutlinePiece>> outlines; // each closed
    double bearing = 0;                              // from the letter's origin to its left edge
    double advance = 0;                              // from its origin to the next letter's
};

/// A font file. One thread at a time may use it.
class Font {
public:
    /// Opens a font file. The Error is a sentence that names the file.
    static Result<std::unique_ptr<Font>> open(const std::filesystem::path& path);
    ~Font();

    /// Returns the letter with this Unicode code, or the font's mark for missing letters. The font
    /// owns it.
    const Letter& letter(char32_t code);
    /// Returns what to add to the left letter's advance when `right` follows it.
    double kerning(const Letter& left, const Letter& right) const;

private:
    struct Face;
    explicit Font(std::unique_ptr<Face> face);

    std::unique_ptr<Face> face_;
    std::map<char32_t, Letter> letters_;
};

/// Returns the codes of a text in UTF-8. Bytes that are not valid UTF-8 count as Latin-1.
std::u32string codes_of(std::string_view text);

} // namespace ovc::pov
