// SPDX-License-Identifier: Apache-2.0
// Matrices that PBRT's and POV-Ray's transforms share: 4x4 in double, column vectors.
#pragma once

#include "core/vec.h"

namespace ovc {

inline dmat4 translation(const dvec3& by) {
    dmat4 m(1);
    m[3] = dvec4(by, 1);
    return m;
}

inline dmat4 scaling(const dvec3& by) {
    dmat4 m(1);
    for (int axis = 0; axis < 3; ++axis)
        m[axis][axis] = by[axis];
    return m;
}

} // namespace ovc
