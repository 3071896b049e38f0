// SPDX-License-Identifier: Apache-2.0
// Shares out the triangles of the dragon among its parts.
#include "testscenes/dragons/creature.h"

#include "testscenes/dragons/anatomy.h"
#include "testscenes/noise.h"

#include <algorithm>
#include <cassert>

namespace ovc::dragons {

namespace {

/// A ribbon out of the mouth: an odd number of triangles, and open.
void add_tongue(Surface& out, uint64_t triangles, bool with_normals) {
    const auto point = [&](uint64_t i) {
        const double along = double(i) / double(triangles + 1);
        const double half = 0.02 * (1 - along) * (i % 2 == 0 ? 1 : -1);
        return vec3(
            dvec3(0.9 + 0.36 * along, 1.2 + 0.05 * circle(0.8 * along).y, kHeadPlane + half));
    };
    for (uint64_t i = 0; i < triangles; ++i) {
        const vec3 a = point(i), b = point(i + 1 + i % 2), c = point(i + 2 - i % 2);
        out.corners.insert(out.corners.end(), {a, b, c});
        if (with_normals)
            out.normals.insert(out.normals.end(), 3, glm::normalize(glm::cross(b - a, c - a)));
    }
}

} // namespace

Surface make_creature(uint64_t triangles, bool with_normals) {
    assert(triangles >= kMinCreature);
    const std::vector<Limb> limbs = anatomy();
    std::vector<Extent> extents;
    double area = 0;
    for (const Limb& limb : limbs) {
        extents.push_back(extent(limb));
        area += extents.back().area;
    }
    Surface out;
    out.corners.reserve(3 * triangles);
    out.normals.reserve(with_normals ? 3 * triangles : 0);
    if (triangles % 2 == 1)
        add_tongue(out, 63, with_normals);
    for (size_t i = limbs.size(); i-- > 0;) { // the body last: it takes what the others leave
        const auto share = uint64_t(double(triangles) * extents[i].area / area / 2) * 2;
        const uint64_t count =
            i == 0 ? triangles - out.corners.size() / 3 : std::max<uint64_t>(share, 64);
        add_limb(out, limbs[i], tube_grid(count, extents[i].length_per_girth), with_normals);
    }
    return out;
}

} // namespace ovc::dragons
