// SPDX-License-Identifier: Apache-2.0
// Reads normal { }.
#include "importers/pov/parse/pattern.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pov {

/// Returns how the pattern of this name tilts normals.
static Bump::Kind bump_of(const Token& pattern) {
    if (pattern.is("bumps"))
        return Bump::Kind::Noise;
    if (pattern.is("dents"))
        return Bump::Kind::Dents;
    return pattern.is("wrinkles") ? Bump::Kind::Wrinkles : Bump::Kind::Height;
}

/// Returns the note that says that a part of a normal is left out.
static const Note* left_out_of_normal(Reader& reader, const Token& word) {
    return reader.note("normal " + word.name->text, word.place,
                       fmt::format("{} of a normal is left out", word.name->text));
}

/// Takes a part that Overcast leaves out.
static bool take_other_part(Reader& reader, const Token& token, Normal& normal) {
    if (!token.is("bump_map") && !token.is("normal_map") && !token.is("slope_map") &&
        !token.is("uv_mapping"))
        return false;
    reader.next();
    normal.pattern.notes.push_back(left_out_of_normal(reader, token));
    skip_arguments(reader);
    return true;
}

Normal parse_normal(Reader& reader, const Normal& base) {
    const Deeper deeper(reader);
    Normal normal = base;
    reader.expect('{', "normal");
    PatternParts pattern(reader, normal.pattern, MapOf::Normals);
    while (!reader.take('}')) {
        const Token token = reader.peek();
        if (const auto named_normal = take_named_if<Normal>(reader)) {
            normal = *named_normal;
            pattern.restart();
        } else if (const auto m = take_transform(reader))
            normal.pattern.placed = *m * normal.pattern.placed;
        else if (reader.take("bump_size"))
            normal.amount = parse_float(reader);
        else if (reader.take("accuracy"))
            normal.accuracy = std::max(1e-6, parse_float(reader));
        else if (take_other_part(reader, token, normal)) {
        } else if (pattern.take()) {
            if (pattern.is_pattern(token))
                normal.kind = bump_of(token);
        } else if (starts_number(reader, token))
            normal.amount = parse_float(reader);
        else if (token.kind == TokenKind::Name && token.name->is_keyword) {
            reader.next();
            skip_arguments(reader);
        } else if (!reader.take(','))
            reader.fail_here("a part of a normal");
    }
    pattern.finish();
    return normal;
}

} // namespace ovc::pov
