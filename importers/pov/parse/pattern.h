// SPDX-License-Identifier: Apache-2.0
// Reads the patterns of pigments, textures and normals, with their waves and warps.
#pragma once

#include "importers/pov/parse/pattern_map.h"

namespace ovc::pov {

/// Reads a pattern word by word into a pigment, in any order of its parts.
class PatternParts {
public:
    /// The pattern begins as that of `pigment`, to which finish() gives it back.
    PatternParts(Reader& reader, Pigment& pigment, MapOf of);

    /// Takes a pattern, a map, a list or a word that changes them. Returns false, and takes
    /// nothing, where another word comes next.
    bool take();
    /// Begins anew with the pattern that the pigment has now.
    void restart();
    /// Puts a color or a picture in the pattern's place.
    void forget();
    /// Returns whether the token names a pattern that is evaluated.
    static bool is_pattern(const Token& token);
    /// Gives the pattern to the pigment, which gets its average color as well.
    void finish();
    /// The entries of the map or list.
    const std::vector<MapStop>& stops() const { return stops_; }

private:
    bool take_pattern(const Token& token);
    bool take_list(const Token& token);
    bool take_number(const Token& token);
    bool take_wave(const Token& token);
    void take_warp();
    void parse_list();
    void parse_object_list();
    void parse_arguments(const Token& token);
    void take_function(const Token& token, const Function& function);
    void take_pigment_pattern();
    void take_image_pattern(const Token& token);
    void take_wrap(const Token& word);
    void parse_tiling(const Token& token);
    void parse_facets();
    void parse_slope();
    void add_altitude(const dvec3& altitude, double low, double high);
    void parse_fractal(const Token& token);
    void take_density_file(const Token& word);
    bool take_fractal_part();
    bool take_own_part();
    void take_black_hole(const Token& word);
    void add_step(TextureStep step);
    void choose(Pattern::Kind kind, Pattern::Wave wave);
    void refuse(const Token& token);
    void finish_picture();

    Reader& reader_;
    Pigment& pigment_;
    MapOf of_;
    bool chosen_ = false;  // there is a pattern
    bool refused_ = false; // the pattern is one that Overcast does not compute
    bool changed_ = false;
    std::optional<double> agate_turb_;
    Pattern pattern_;
    ProgramPtr program_;            // of Pattern::Kind::Function
    std::optional<ImageMap> image_; // of image_pattern
    std::vector<MapStop> stops_;
    bool stops_are_default_ = false; // those of the pattern's word
};

} // namespace ovc::pov
