// SPDX-License-Identifier: Apache-2.0
// Reads warp { }, which moves the points where a pattern is evaluated.
#include "importers/pov/parse/pattern.h"

#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ovc::pov {

void PatternParts::take_warp() {
    reader_.expect('{', "warp");
    TextureStep step;
    const Token token = reader_.peek();
    if (reader_.take("turbulence")) {
        step.kind = TextureStep::Kind::Turbulence;
        Octaves octaves;
        step.rows[0] = dvec4(parse_vector(reader_), 0);
        while (!reader_.take('}')) {
            if (reader_.take("octaves"))
                octaves.count =
                    uint64_t(std::clamp(parse_float(reader_), 1.0, double(kMaxOctaves)));
            else if (reader_.take("lambda"))
                octaves.lambda = parse_float(reader_);
            else if (reader_.take("omega"))
                octaves.omega = parse_float(reader_);
            else
                reader_.fail_here("'}' or a part of a warp's turbulence");
        }
        step.rows[0].w = octaves.lambda;
        step.rows[1] = dvec4(octaves.omega, double(octaves.count), 0, 0);
        add_step(step);
    } else if (reader_.take("repeat")) {
        step.kind = TextureStep::Kind::Repeat;
        step.rows[0] = dvec4(parse_vector(reader_), 0);
        step.rows[1] = step.rows[2] = dvec4(0);
        while (!reader_.take('}')) {
            if (reader_.take("offset"))
                step.rows[1] = dvec4(parse_vector(reader_), 0);
            else if (reader_.take("flip"))
                step.rows[2] = -dvec4(parse_vector(reader_), 0);
            else
                reader_.fail_here("'}' or a part of a warp's repeat");
        }
        add_step(step);
    } else if (reader_.take("black_hole")) {
        take_black_hole(token);
    } else if (reader_.take("cubic")) {
        reader_.expect('}', "the warp cubic");
        step.kind = TextureStep::Kind::Cubic;
        add_step(step);
    } else if (token.is("cylindrical") || token.is("spherical") || token.is("toroidal") ||
               token.is("planar")) {
        reader_.next();
        take_wrap(token);
    } else {
        skip_block(reader_);
        if (token.kind == TokenKind::Name)
            pigment_.notes.push_back(reader_.note(
                "warp", token.place, fmt::format("the warp {} is left out", token.name->text)));
    }
}

/// Reads `[orientation AXIS] [dist_exp E] [major_radius R]`, or `[AXIS, HEIGHT]` of planar, from
/// behind the word.
void PatternParts::take_wrap(const Token& word) {
    using StepKind = TextureStep::Kind;
    TextureStep step;
    step.kind = word.is("cylindrical") ? StepKind::Cylindrical
                : word.is("spherical") ? StepKind::Spherical
                : word.is("toroidal")  ? StepKind::Toroidal
                                       : StepKind::Planar;
    dvec3 axis(0, 0, 1);
    step.rows = {dvec4(0), dvec4(0), dvec4(0)};
    step.rows[0].z = word.is("toroidal") ? 1 : 0;
    while (!reader_.take('}')) {
        if (reader_.take("orientation"))
            axis = parse_vector(reader_);
        else if (reader_.take("dist_exp"))
            step.rows[0].y = parse_float(reader_);
        else if (reader_.take("major_radius"))
            step.rows[0].z = parse_float(reader_);
        else if (word.is("planar") && starts_number(reader_, reader_.peek())) {
            axis = parse_vector(reader_);
            reader_.take_comma();
            step.rows[0].z = parse_float(reader_);
        } else
            reader_.fail_here(fmt::format("'}}' or a part of a {} warp", word.name->text));
    }
    const int major = major_axis(axis);
    step.rows[0].x = major;
    if (axis[major] > 0 && std::abs(axis[(major + 1) % 3]) + std::abs(axis[(major + 2) % 3]) == 0)
        add_step(step);
    else
        pigment_.notes.push_back(
            reader_.note("warp", word.place,
                         fmt::format("the warp {} is left out where its axis is not x, y or z",
                                     word.name->text)));
}

/// Reads `<center>, radius …` of a warp from behind its word.
void PatternParts::take_black_hole(const Token& word) {
    TextureStep step;
    step.kind = TextureStep::Kind::BlackHole;
    const dvec3 center = parse_vector(reader_);
    reader_.take_comma();
    step.rows[0] = dvec4(center, parse_float(reader_));
    step.rows[1] = dvec4(1, 2, 0, 0);
    step.rows[2] = dvec4(0);
    while (!reader_.take('}')) {
        if (reader_.take("strength"))
            step.rows[1].x = parse_float(reader_);
        else if (reader_.take("falloff"))
            step.rows[1].y = parse_float(reader_);
        else if (reader_.take("inverse"))
            step.rows[1].z = parse_flag(reader_) ? 1 : 0;
        else if (reader_.take("type"))
            parse_float(reader_);
        else if (const Token token = reader_.peek();
                 reader_.take("repeat") || reader_.take("turbulence")) {
            parse_vector(reader_);
            pigment_.notes.push_back(reader_.note(
                "black_hole", word.place, token.name->text + " of a black_hole is left out"));
        } else
            reader_.fail_here("'}' or a part of a black_hole");
    }
    add_step(step);
}

} // namespace ovc::pov
