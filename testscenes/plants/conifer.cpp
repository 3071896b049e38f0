// SPDX-License-Identifier: Apache-2.0
// Spruces: a straight trunk, whorls of drooping branches, sprays of needles as narrow leaves.
#include "testscenes/noise.h"
#include "testscenes/plants/prototype.h"

#include <algorithm>
#include <cmath>

namespace ovc::plants {

namespace {

void add_trunk(Corners& out, double height, double radius, uint32_t sides) {
    const dvec3 top(0, height, 0);
    for (uint32_t side = 0; side < sides; ++side) {
        const dvec2 a = radius * circle(double(side) / sides);
        const dvec2 b = radius * circle(double(side + 1) / sides);
        add_triangle(out, {a.x, -0.3, a.y}, top, {b.x, -0.3, b.y});
    }
}

void add_branch(Corners& out, dvec3 root, dvec3 outwards, double length, uint32_t sprays,
                Random& random) {
    const dvec3 side(-outwards.z, 0, outwards.x);
    const double droop = random.uniform(0.25, 0.5);
    const auto at = [&](double s) { // sinks, and turns up again at its end
        return root + outwards * (length * s) - dvec3(0, length * droop * s * (1.5 - s), 0);
    };
    for (uint32_t i = 0; i < sprays; ++i) {
        const double s = (i + 0.6) / sprays;
        const double spray =
            std::max(0.12 * length, 0.62 * length * (1.05 - s)) + 0.9 * length / sprays;
        const dvec3 base = at(s - 0.5 / sprays);
        for (double hand : {-1.0, 1.0}) {
            const double forwards = random.uniform(0.5, 0.9);
            const double sidewards = hand * random.uniform(0.5, 1.0);
            const double sinking = random.uniform(0.05, 0.45);
            const dvec3 along = outwards * forwards + side * sidewards - dvec3(0, sinking, 0);
            const dvec3 up = dvec3(0, 1, 0) + 0.5 * outwards + 0.4 * random.in_ball();
            add_leaf(out, base, spray * 0.7 * glm::normalize(along), up,
                     spray * (0.32 + 0.5 / sprays));
        }
    }
    add_leaf(out, at(0.55), at(1.08) - at(0.55), dvec3(0, 1, 0) + 0.4 * outwards, 0.2 * length);
}

} // namespace

Prototype make_spruce(Random random, double detail) {
    Prototype tree;
    const double height = random.uniform(11, 17);
    const double reach = height * random.uniform(0.19, 0.25);
    add_trunk(tree[Part::Wood], 0.93 * height, 0.017 * height, detail > 0.3 ? 7 : 3);
    const double shrink = std::sqrt(detail);
    const uint32_t whorls = scaled(44, shrink, 9);
    const uint32_t branches = scaled(11, std::sqrt(shrink), 4);
    const uint32_t sprays = scaled(13, shrink, 1);
    for (uint32_t w = 0; w < whorls; ++w) {
        const double s = (w + random.uniform(0.0, 0.8)) / whorls; // 0 at the lowest branch
        const double y = height * (0.1 + 0.89 * s);
        const double length = reach * (1 - s) * random.uniform(0.85, 1.1) + 0.05 * reach;
        const double turn = random.uniform();
        for (uint32_t b = 0; b < branches; ++b) {
            const dvec2 d = circle(turn + (b + random.uniform(-0.3, 0.3)) / branches);
            const dvec3 root(0, y + random.uniform(-0.15, 0.15), 0);
            const double reaches = length * random.uniform(0.75, 1.1);
            add_branch(tree[Part::Tinted], root, {d.x, 0, d.y}, reaches,
                       std::max(1u, uint32_t(sprays * (1 - 0.7 * s))), random);
        }
    }
    return tree;
}

} // namespace ovc::plants
