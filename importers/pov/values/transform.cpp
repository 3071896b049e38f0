// SPDX-License-Identifier: Apache-2.0
// Matrices of the scene language.
#include "importers/pov/values/transform.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace ovc::pov {

/// Returns the sine and the cosine, which are exact for multiples of 90 degrees.
static dvec2 sine_and_cosine(double degrees) {
    const double turns = degrees / 90;
    if (turns == std::floor(turns) && std::abs(turns) < 1e9) {
        static constexpr double kSines[] = {0, 1, 0, -1};
        const int quarter = int(((int64_t(turns) % 4) + 4) % 4);
        return {kSines[quarter], kSines[(quarter + 1) % 4]};
    }
    const double radians = degrees * std::numbers::pi / 180;
    return {std::sin(radians), std::cos(radians)};
}

dmat4 rotation(const dvec3& degrees) {
    dmat4 whole(1);
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const dvec2 angle = sine_and_cosine(degrees[axis]);
        dmat4 m(1);
        m[b][b] = m[c][c] = angle.y;
        m[b][c] = angle.x;
        m[c][b] = -angle.x;
        whole = m * whole;
    }
    return whole;
}

dmat4 rotation_about(const dvec3& axis, double radians) {
    const double length = glm::length(axis);
    if (!(length > 0))
        return dmat4(1);
    const dvec3 n = axis / length;
    const double s = std::sin(radians), c = std::cos(radians);
    dmat4 m(1);
    for (int i = 0; i < 3; ++i) {
        dvec3 e(0);
        e[i] = 1;
        m[i] = dvec4(c * e + (1 - c) * glm::dot(n, e) * n + s * glm::cross(n, e), 0);
    }
    return m;
}

/// Reads the twelve numbers of matrix <…>. POV-Ray's rows are our columns.
static dmat4 parse_matrix(Reader& reader) {
    reader.expect('<', "matrix");
    dmat4 m(1);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) {
            m[column][row] = parse_float(reader);
            reader.take_comma();
        }
    reader.expect('>', "the twelve numbers of a matrix");
    return m;
}

static dmat4 inverted(Reader& reader, const dmat4& m) {
    const double determinant = glm::determinant(m);
    if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
        reader.fail(reader.place(), "found a transformation without an inverse");
    return glm::inverse(m);
}

static dvec3 parse_scale(Reader& reader) {
    const Place at = reader.peek().place;
    dvec3 by = parse_vector(reader);
    for (int i = 0; i < 3; ++i)
        if (by[i] == 0) {
            reader.warn("scale 0", at, "a scale by 0 is taken for one by 1, as POV-Ray does");
            by[i] = 1;
        }
    return by;
}

std::array<dvec4, 3> rows_of(const dmat4& matrix) {
    const dmat4 rows = glm::transpose(matrix);
    return {rows[0], rows[1], rows[2]};
}

std::optional<dmat4> take_transform(Reader& reader) {
    if (reader.take("translate"))
        return translation(parse_vector(reader));
    if (reader.take("rotate"))
        return rotation(parse_vector(reader));
    if (reader.take("scale"))
        return scaling(parse_scale(reader));
    if (reader.take("matrix"))
        return parse_matrix(reader);
    if (!reader.take("transform"))
        return std::nullopt;
    if (reader.peek().is('{'))
        return parse_transform_block(reader);
    if (const std::optional<dmat4> m = take_named<dmat4>(reader))
        return *m;
    reader.fail_here("'{' or the name of a transform");
}

dmat4 parse_transform_block(Reader& reader) {
    const Deeper deeper(reader);
    reader.expect('{', "transform");
    dmat4 whole(1);
    while (!reader.take('}')) {
        if (const std::optional<dmat4> m = take_transform(reader))
            whole = *m * whole;
        else if (reader.take("inverse"))
            whole = inverted(reader, whole);
        else if (const std::optional<dmat4> named = take_named<dmat4>(reader))
            whole = *named * whole;
        else
            reader.fail_here("a transformation such as translate or rotate");
    }
    return whole;
}

} // namespace ovc::pov
