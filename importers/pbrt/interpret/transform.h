// SPDX-License-Identifier: Apache-2.0
// Transforms as PBRT composes them: 4x4 in double, column vectors.
#pragma once

#include "core/vec.h"

#include <span>

namespace ovc::pbrt {

dmat4 translation(const dvec3& by);
dmat4 scaling(const dvec3& by);
/// By `degrees` round `axis`, any length above 0; the identity round none.
dmat4 rotation(double degrees, const dvec3& axis);
/// From the world to a camera at `eye` that looks along +z, with +y up and +x to the right: the
/// handedness of pbrt. False where the three do not make a view.
bool look_at(const dvec3& eye, const dvec3& target, const dvec3& up, dmat4& world_to_camera);
/// The 16 numbers of a Transform directive: column by column.
dmat4 from_file(std::span<const double> numbers);

inline dvec3 point_through(const dmat4& m, const dvec3& p) {
    const glm::dvec4 q = m * glm::dvec4(p, 1);
    return q.w == 1 ? dvec3(q) : dvec3(q) / q.w;
}
inline dvec3 vector_through(const dmat4& m, const dvec3& v) {
    return dvec3(m * glm::dvec4(v, 0));
}

/// What turns normals where `m` moves points: the inverse transposed, up to a positive factor;
/// taken from cofactors, so that it exists where m is singular.
dmat3 normal_matrix(const dmat4& m);

inline bool swaps_handedness(const dmat4& m) {
    return glm::determinant(dmat3(m)) < 0;
}

bool is_finite(const dmat4& m);

} // namespace ovc::pbrt
