// SPDX-License-Identifier: Apache-2.0
// The land of the plants scene: heights.
#include "testscenes/plants/landscape.h"

#include "testscenes/noise.h"

#include <algorithm>
#include <cmath>

namespace ovc::plants {

namespace {

/// The river's middle and half its width at a distance `ahead` of the viewer.
double river_middle(double ahead) {
    const double meander = 9 * circle(ahead / 230 + 0.05).y + 4 * circle(ahead / 97).y;
    const double bend_away = -150 * smooth_step(170, 420, ahead);
    return -15 + 15 * smooth_step(0, 80, ahead) + meander * smooth_step(0, 60, ahead) + bend_away;
}

double river_half_width(double ahead) {
    const double lake = smooth_step(30, 100, ahead) * smooth_step(215, 150, ahead);
    return 11 + 27 * lake;
}

double hills(dvec2 at) {
    const double ahead = -at.y;
    const double rolling = 9 * fractal_noise(at / 90.0, 4, 11) + 7;
    const double ridge = 1 - std::abs(fractal_noise(at / 420.0 + dvec2(3.1, 0.4), 5, 12)) * 2.2;
    const double mountains = 120 * smooth_step(260, 1000, ahead) * std::max(0.15, ridge);
    const double right_shoulder = 26 * smooth_step(30, 190, at.x - 0.12 * ahead);
    const double left_shoulder = 16 * smooth_step(-60, -240, at.x);
    return rolling + mountains + right_shoulder + left_shoulder;
}

} // namespace

double shore_distance(dvec2 at) {
    const double ahead = -at.y;
    const double wobble = 2.2 * fractal_noise(at / 14.0, 3, 21) + 5 * noise(at / 45.0, 22);
    return std::abs(at.x - river_middle(ahead)) - river_half_width(ahead) + wobble;
}

double ground_height(dvec2 at) {
    const double shore = shore_distance(at);
    const double bumps = 0.28 * fractal_noise(at / 3.5, 4, 31);
    if (shore < 0)
        return std::max(-2.5, 0.22 * shore) + 0.3 * bumps;
    const double bank = 0.75 * smooth_step(0, 5, shore) + 0.022 * shore;
    return bank + bumps * smooth_step(0, 3, shore) + hills(at) * smooth_step(10, 130, shore);
}

double ground_slope(dvec2 at) {
    const double step = 0.5;
    const double here = ground_height(at);
    const double dx = ground_height(at + dvec2(step, 0)) - here;
    const double dz = ground_height(at + dvec2(0, step)) - here;
    return std::sqrt(dx * dx + dz * dz) / step;
}

} // namespace ovc::plants
