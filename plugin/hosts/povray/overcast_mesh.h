// SPDX-License-Identifier: AGPL-3.0-or-later
// OvercastMesh: the triangles of one POV-Ray mesh, handed to libovercast.so, and what its rays hit.
// POV-Ray includes this (povray.patch); it knows nothing of POV-Ray.
#pragma once

#include <cstddef>

/// A mesh as POV-Ray keeps it.
struct OvercastTriangles {
    const float (*vertices)[3];
    long vertex_count;
    const long* corners;  // of the first triangle: three indices of vertices in a row
    size_t corner_stride; // bytes from one triangle's to the next's
    long triangle_count;
};

/// A point of a ray on a triangle.
struct OvercastHit {
    double depth;  // in lengths of the ray's direction
    long triangle; // its number
};

class OvercastMesh;

/// The mesh in Overcast, built and ready for rays; NULL where it is to stay POV-Ray's: it is small,
/// or Overcast cannot have it, which is said once on stderr. Nothing is kept of what it is given.
/// Throws std::runtime_error where an environment variable (README.md) has no meaning.
OvercastMesh* overcast_take(const OvercastTriangles& triangles);

/// The first hit at `nearest` <= depth <= `farthest`, behind `after` where that is not NULL, which
/// may be `hit`; false: there is none. Of triangles in one point, the smaller number is before the
/// larger. Any number of threads at once. Throws std::runtime_error with Overcast's sentence where
/// it fails.
bool overcast_hit(const OvercastMesh& mesh, const double origin[3], const double direction[3],
                  double nearest, double farthest, const OvercastHit* after, OvercastHit& hit);

/// No ray may be under way. NULL is nothing to do.
void overcast_release(OvercastMesh* mesh);
