// SPDX-License-Identifier: Apache-2.0
// Curves with axes, and the tubes round them.
#include "testscenes/dragons/limb.h"

#include "testscenes/noise.h"
#include "testscenes/spline.h"

#include <algorithm>
#include <cmath>

namespace ovc::dragons {

namespace {

Joint joint_at(const Limb& limb, double along) {
    return spline_at<Joint>(limb.joints, along);
}

/// The limb closes like the end of an egg: 0 at both ends, 1 from a little way on.
double rounding(double along) {
    constexpr double kEnd = 0.06;
    const double missing = 1 - std::min({along, 1 - along, kEnd}) / kEnd;
    return std::sqrt(std::max(0.0, 1 - missing * missing));
}

} // namespace

std::vector<Station> stations(const Limb& limb, uint32_t count) {
    std::vector<Station> result(count);
    dvec3 back = limb.back;
    for (uint32_t i = 0; i < count; ++i) {
        const double along = double(i) / (count - 1);
        const dvec3 ahead = glm::normalize(joint_at(limb, std::min(1.0, along + 1e-3)).at -
                                           joint_at(limb, std::max(0.0, along - 1e-3)).at);
        back = glm::normalize(back - glm::dot(back, ahead) * ahead);
        result[i] = {joint_at(limb, along), ahead, glm::cross(back, ahead), back};
    }
    return result;
}

Extent extent(const Limb& limb) {
    constexpr int kSteps = 64;
    double length = 0, area = 0;
    Joint before = joint_at(limb, 0);
    for (int i = 1; i <= kSteps; ++i) {
        const Joint here = joint_at(limb, double(i) / kSteps);
        const double step = glm::length(here.at - before.at);
        length += step;
        area += step * 3.14 * (here.across + here.up);
        before = here;
    }
    return {area, length * length / area};
}

void add_limb(Surface& out, const Limb& limb, const TubeGrid& grid, bool with_normals) {
    const std::vector<Station> line = stations(limb, grid.along + 2);
    add_tube(out, grid, with_normals, [&](uint32_t ring, double turns) {
        const Station& s = line[ring];
        const double along = double(ring) / (grid.along + 1);
        const double round = rounding(along);
        const dvec2 c = circle(turns);
        const dvec3 bare =
            s.joint.at + round * (s.joint.across * c.x * s.side + s.joint.up * c.y * s.back);
        if (!limb.skin)
            return bare;
        const dvec3 outwards = c.x * s.side + c.y * s.back;
        return bare + round * limb.skin(along, turns, bare) * outwards;
    });
}

} // namespace ovc::dragons
