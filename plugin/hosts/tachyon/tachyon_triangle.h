// SPDX-License-Identifier: Apache-2.0
// Tachyon's scene and ray as its public header has them, and its triangles, whose layout only its
// own triangle.h has.
#pragma once

#define TACHYON_INTERNAL 1
#include <tachyon.h>

namespace ovc::tachyon {

/// How each kind of triangle (TRI, STRI, VCSTRI) begins; normals and colors follow.
struct Triangle {
    RT_OBJECT_HEAD
    vector edge2;
    vector edge1;
    vector v0;
};

using Intersect = void (*)(const void* object, void* ray);

/// The function by which the Tachyon in this process intersects its triangles, one for all kinds.
/// Found by having it make a triangle, which is looked at and shot at. Throws std::runtime_error
/// with a sentence where there is no Tachyon or its structures are not those of the header.
Intersect triangle_intersect();

} // namespace ovc::tachyon
