// SPDX-License-Identifier: Apache-2.0
// The icosphere.
#include "testscenes/sphere.h"

#include <array>
#include <cmath>

namespace ovc {

namespace {

struct Face {
    dvec3 a, b, c;
};

std::array<Face, 20> icosahedron() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    const double length = std::sqrt(1 + golden * golden);
    const double s = 1 / length, g = golden / length;
    const dvec3 v[12] = {{-s, g, 0},  {s, g, 0},  {-s, -g, 0}, {s, -g, 0}, {0, -s, g},  {0, s, g},
                         {0, -s, -g}, {0, s, -g}, {g, 0, -s},  {g, 0, s},  {-g, 0, -s}, {-g, 0, s}};
    constexpr uint8_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::array<Face, 20> result;
    for (int i = 0; i < 20; ++i)
        result[i] = {v[faces[i][0]], v[faces[i][1]], v[faces[i][2]]};
    return result;
}

/// a + b == b + a in floating point, so both faces of an edge find the same middle.
dvec3 middle(dvec3 a, dvec3 b) {
    return glm::normalize(a + b);
}

void subdivide(Corners& out, const Face& face, uint32_t level) {
    if (level == 0) {
        add_triangle(out, face.a, face.b, face.c);
        return;
    }
    const dvec3 ab = middle(face.a, face.b), bc = middle(face.b, face.c),
                ca = middle(face.c, face.a);
    subdivide(out, {face.a, ab, ca}, level - 1);
    subdivide(out, {ab, face.b, bc}, level - 1);
    subdivide(out, {ca, bc, face.c}, level - 1);
    subdivide(out, {ab, bc, ca}, level - 1);
}

} // namespace

Corners make_sphere(uint32_t level) {
    Corners corners;
    corners.reserve(size_t(60) << (2 * level));
    for (const Face& face : icosahedron())
        subdivide(corners, face, level);
    return corners;
}

} // namespace ovc
