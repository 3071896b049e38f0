// SPDX-License-Identifier: Apache-2.0
// Rocks: a sphere, flattened and pushed about by noise.
#include "testscenes/noise.h"
#include "testscenes/plants/prototype.h"
#include "testscenes/sphere.h"

#include <cmath>

namespace ovc::plants {

Prototype make_rock(Random random, double detail) {
    Prototype rock;
    const uint64_t seed = random.bits();
    const dvec3 shape{random.uniform(0.8, 1.3), random.uniform(0.45, 0.75),
                      random.uniform(0.8, 1.2)};
    Corners& corners = rock[Part::Tinted];
    corners = make_sphere(detail > 0.5 ? 4 : detail > 0.15 ? 3 : 2);
    for (vec3& corner : corners) {
        const dvec3 p(corner);
        const double facets = 1 - std::abs(fractal_noise(p * 1.3, 3, seed));
        const double bulge = 0.55 + 0.45 * facets + 0.1 * fractal_noise(p * 5.0, 2, seed + 7);
        corner = vec3(p * bulge * shape);
    }
    return rock;
}

} // namespace ovc::plants
