// SPDX-License-Identifier: Apache-2.0
// Fonts: the outlines of letters, in units of the font's height. font.cpp is the only file that
// sees FreeType.
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
    std::array<dvec2, 4> points; // straight: from the first to the last
};

struct Letter {
    uint32_t glyph = 0;
    std::vector<std::vector<OutlinePiece>> outlines; // each closed
    double bearing = 0;                              // from where it begins to its left edge
    double advance = 0;                              // to where the next letter begins
};

class Font {
public:
    /// Error: a sentence that names the file.
    static Result<std::shared_ptr<Font>> open(const std::filesystem::path& path);
    ~Font();

    /// The font's mark for what it lacks where it has no such letter.
    std::shared_ptr<const Letter> letter(char32_t code);
    /// What the distance of two letters in a row differs by.
    double kerning(const Letter& left, const Letter& right) const;

private:
    struct Face;
    explicit Font(std::unique_ptr<Face> face);

    std::unique_ptr<Face> face_;
    std::map<char32_t, std::shared_ptr<const Letter>> letters_;
};

/// UTF-8, and bytes that are none as Latin-1.
std::u32string codes_of(std::string_view text);

} // namespace ovc::pov
