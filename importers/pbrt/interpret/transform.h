// SPDX-License-Identifier: Apache-2.0
// Transforms as PBRT composes them: 4x4 in double, column vectors.
#pragma once

#include "importers/matrix.h"

#include <span>

namespace ovc::pbrt {

/// Returns a rotation by `degrees` round `axis`, of any length above 0; the identity if the axis
/// has no length or a number is not finite.
dmat4 rotation(double degrees, const dvec3& axis);
/// Sets the transform from the world to a camera at `eye` that looks along +z, with +y up and +x to
/// the right: the handedness of pbrt. Returns false if the three vectors do not make a view.
bool look_at(const dvec3& eye, const dvec3& target, const dvec3& up, dmat4& world_to_camera);
/// Returns the matrix of a Transform directive from its 16 numbers, column by column.
dmat4 from_file(std::span<const double> numbers);

inline dvec3 point_through(const dmat4& m, const dvec3& p) {
    const glm::dvec4 q = m * glm::dvec4(p, 1);
    return q.w == 1 ? dvec3(q) : dvec3(q) / q.w;
}
inline dvec3 vector_through(const dmat4& m, const dvec3& v) {
    return dvec3(m * glm::dvec4(v, 0));
}

/// Returns the matrix that turns normals if `m` moves points: the inverse transposed, up to a
/// positive factor. It consists of cofactors, so that it exists even if m is singular.
dmat3 normal_matrix(const dmat4& m);

inline bool swaps_handedness(const dmat4& m) {
    return glm::determinant(dmat3(m)) < 0;
}

bool is_finite(const dmat4& m);

} // namespace ovc::pbrt
