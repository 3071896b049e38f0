// SPDX-License-Identifier: Apache-2.0
// The dragon's body, mane, crest, tail and legs.
#include "testscenes/dragons/anatomy.h"

#include "testscenes/noise.h"

#include <algorithm>
#include <cmath>

namespace ovc::dragons {

double strand_skin(double along, double turns, const dvec3& at) {
    return 0.004 * circle(7 * turns).y * (1 - along) + 0.004 * fractal_noise(at * 20.0, 3, 204);
}

namespace {

double fraction(double x) {
    return x - std::floor(x);
}

/// Rows of overlapping scales, each row set off by half a scale: highest at their rounded ends.
double scales(double rows, double columns) {
    const double across =
        2 * fraction(columns + (std::fmod(std::floor(rows), 2.0) == 0 ? 0 : 0.5)) - 1;
    const double onwards = fraction(rows);
    return (1 - onwards) * (1 - across * across * (1 - 0.6 * onwards));
}

double body_skin(double along, double turns, const dvec3& at) {
    const double rough = 0.008 * fractal_noise(at * 16.0, 4, 201);
    const double belly = smooth_step(0.11, 0.08, std::abs(turns - 0.75));
    const double plates = 0.013 * (1 - fraction(along * 120));
    const double back = smooth_step(0.05, 0.0, std::abs(turns - 0.25));
    const double thin = smooth_step(0, 0.22, along) * smooth_step(1, 0.8, along);
    const double scaled = 0.015 * scales(along * 150, turns * 34);
    return (0.35 + 0.65 * thin) * (belly * plates + (1 - belly) * scaled + 0.03 * back) + rough;
}

double leg_skin(double along, double turns, const dvec3& at) {
    return 0.009 * scales(along * 30, turns * 18) + 0.012 * fractal_noise(at * 14.0, 4, 202);
}

Limb body() {
    return {{{{-1.10, 0.95, 0.02}, 0.010, 0.012},
             {{-1.22, 0.82, 0.08}, 0.022, 0.026},
             {{-1.24, 0.58, 0.16}, 0.036, 0.042},
             {{-1.14, 0.34, 0.24}, 0.055, 0.06},
             {{-0.95, 0.22, 0.20}, 0.075, 0.08},
             {{-0.78, 0.30, 0.03}, 0.095, 0.10},
             {{-0.64, 0.52, -0.13}, 0.12, 0.13},
             {{-0.46, 0.70, -0.17}, 0.145, 0.16},
             {{-0.26, 0.70, -0.07}, 0.155, 0.17},
             {{-0.08, 0.54, 0.08}, 0.155, 0.165},
             {{0.10, 0.40, 0.16}, 0.155, 0.165},
             {{0.30, 0.40, 0.12}, 0.165, 0.175},
             {{0.46, 0.54, 0.00}, 0.165, 0.175},
             {{0.54, 0.76, -0.09}, 0.14, 0.15},
             {{0.50, 0.98, -0.10}, 0.115, 0.12},
             {{0.48, 1.17, -0.04}, 0.10, 0.105},
             {{0.58, 1.32, 0.01}, 0.095, 0.10},
             {{0.74, 1.34, 0.02}, 0.085, 0.09}},
            {1, 0.2, 0},
            body_skin};
}

/// A flame of hair: flat, pointed, bent at its end.
Limb flame(const dvec3& root, const dvec3& along, const dvec3& bend, double width) {
    return {{{root, 0.25 * width, width},
             {root + 0.35 * along, 0.3 * width, 1.1 * width},
             {root + 0.7 * along + 0.4 * bend, 0.2 * width, 0.7 * width},
             {root + along + bend, 0.03 * width, 0.06 * width}},
            glm::normalize(bend + dvec3(0, 1e-3, 0)),
            strand_skin};
}

/// Flames round the neck, behind the head, all swept back and outwards.
void add_mane(std::vector<Limb>& out, const std::vector<Station>& line) {
    for (int ring = 0; ring < 5; ++ring) {
        const Station& s = line[size_t(double(line.size() - 1) * (0.965 - 0.022 * ring))];
        for (int k = 0; k < 9; ++k) {
            const dvec2 c = circle((k + 0.5 * (ring % 2)) / 9.0 * 0.9 + 0.75);
            const dvec3 outwards = c.x * s.side + c.y * s.back;
            const double length = 0.20 + 0.05 * noise(dvec2(ring * 1.7, k * 2.3), 205);
            out.push_back(flame(s.joint.at + 0.8 * s.joint.across * outwards,
                                length * glm::normalize(0.75 * outwards - s.ahead),
                                0.08 * (outwards + 0.5 * s.back), 0.024));
        }
    }
}

/// Plates along the back, from the tail to the neck.
void add_crest(std::vector<Limb>& out, const std::vector<Station>& line) {
    constexpr int kPlates = 46;
    for (int plate = 0; plate < kPlates; ++plate) {
        const double along = 0.05 + 0.84 * plate / kPlates;
        const Station& s = line[size_t(double(line.size() - 1) * along)];
        const double height = 0.05 + 0.55 * s.joint.up;
        out.push_back({{{s.joint.at + 0.85 * s.joint.up * s.back, 0.012, 0.42 * height},
                        {s.joint.at + (s.joint.up + 0.5 * height) * s.back - 0.1 * height * s.ahead,
                         0.010, 0.32 * height},
                        {s.joint.at + (s.joint.up + height) * s.back - 0.55 * height * s.ahead,
                         0.002, 0.004}},
                       s.ahead,
                       strand_skin});
    }
}

void add_tail(std::vector<Limb>& out, const Station& tip) {
    for (int k = 0; k < 9; ++k) {
        const dvec2 c = circle(k / 9.0);
        const dvec3 outwards = c.x * tip.side + c.y * tip.back;
        const double length = 0.26 + 0.08 * (k % 3);
        out.push_back(flame(tip.joint.at + 0.012 * outwards,
                            length * glm::normalize(0.35 * outwards - tip.ahead), 0.09 * outwards,
                            0.026));
    }
}

struct Leg {
    dvec3 hip, knee, heel, foot;
    double thickness;
};

void add_leg(std::vector<Limb>& out, const Leg& leg) {
    const dvec3 forwards = glm::normalize(dvec3(leg.foot.x - leg.heel.x, 0, 0.2 * leg.foot.z));
    const double w = leg.thickness;
    out.push_back({{{leg.hip, w, 1.2 * w},
                    {0.5 * (leg.hip + leg.knee), 0.95 * w, 1.25 * w},
                    {leg.knee, 0.7 * w, 0.8 * w},
                    {0.4 * leg.knee + 0.6 * leg.heel, 0.5 * w, 0.55 * w},
                    {leg.heel, 0.42 * w, 0.45 * w},
                    {leg.foot, 0.55 * w, 0.35 * w},
                    {leg.foot + 0.05 * forwards, 0.4 * w, 0.25 * w}},
                   {1, 0, 0},
                   leg_skin});
    const dvec3 aside = glm::cross(forwards, dvec3(0, 1, 0));
    for (int toe = -2; toe <= 1; ++toe) { // three ahead, the last one behind
        const dvec3 to = toe == -2 ? -forwards : glm::normalize(forwards + 0.6 * toe * aside);
        const dvec3 root = leg.foot + (toe == -2 ? -0.04 : 0.03) * forwards + 0.02 * to;
        out.push_back({{{root, 0.022, 0.022},
                        {root + 0.06 * to + dvec3(0, 0.035, 0), 0.024, 0.026},
                        {root + 0.12 * to + dvec3(0, 0.012, 0), 0.018, 0.02}},
                       {0, 1, 0},
                       leg_skin});
        const dvec3 tip = root + 0.112 * to + dvec3(0, 0.016, 0);
        out.push_back(
            {{{tip, 0.014, 0.014},
              {tip + 0.04 * to + dvec3(0, 0.012, 0), 0.011, 0.011},
              {{tip.x + 0.085 * to.x, std::max(0.006, tip.y - 0.05), tip.z + 0.085 * to.z},
               0.001,
               0.001}},
             {0, 1, 0}});
    }
    for (int k = 0; k < 3; ++k)
        out.push_back(flame(leg.knee + dvec3(-0.4 * w, 0.05 * k, 0),
                            {-0.14 - 0.02 * k, 0.05 + 0.03 * k, 0.0}, {-0.03, 0.07, 0.0}, 0.022));
}

} // namespace

std::vector<Limb> anatomy() {
    std::vector<Limb> all = {body()};
    const std::vector<Station> line = stations(all[0], 1025);
    add_head(all);
    add_mane(all, line);
    add_crest(all, line);
    add_tail(all, line[8]);
    add_leg(
        all,
        {{0.40, 0.46, 0.12}, {0.28, 0.30, 0.34}, {0.44, 0.12, 0.38}, {0.52, 0.03, 0.38}, 0.085});
    add_leg(all, {{0.48, 0.56, -0.12},
                  {0.62, 0.40, -0.34},
                  {0.80, 0.30, -0.36},
                  {0.90, 0.24, -0.36},
                  0.085});
    add_leg(all, {{-0.50, 0.62, -0.26},
                  {-0.38, 0.36, -0.42},
                  {-0.58, 0.16, -0.40},
                  {-0.50, 0.03, -0.42},
                  0.10});
    add_leg(
        all,
        {{-0.34, 0.60, 0.06}, {-0.22, 0.36, 0.28}, {-0.44, 0.16, 0.30}, {-0.36, 0.03, 0.30}, 0.10});
    return all;
}

} // namespace ovc::dragons
