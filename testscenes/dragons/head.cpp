// SPDX-License-Identifier: Apache-2.0
// The dragon's head.
#include "testscenes/dragons/anatomy.h"

#include "testscenes/noise.h"

#include <cmath>

namespace ovc::dragons {

namespace {

double head_skin(double along, double turns, const dvec3& at) {
    const double brow = 0.022 * smooth_step(0.07, 0, std::abs(along - 0.45)) *
                        smooth_step(0.12, 0.03, std::abs(std::abs(turns - 0.25) - 0.1));
    const double wrinkles = 0.005 * circle(22 * along).y * smooth_step(0.5, 0.8, along);
    return brow + wrinkles + 0.03 * fractal_noise(at * 11.0, 5, 203);
}

double horn_skin(double along, double turns, const dvec3&) {
    return 0.0035 * circle(24 * along + turns).y * (1 - along);
}

/// Both sides of a head or a tail: as given, and mirrored in the plane z = `plane`.
void add_pair(std::vector<Limb>& out, const Limb& limb, double plane) {
    out.push_back(limb);
    Limb other = limb;
    for (Joint& joint : other.joints)
        joint.at.z = 2 * plane - joint.at.z;
    other.back.z = -other.back.z;
    out.push_back(other);
}

void add_jaws(std::vector<Limb>& out) {
    out.push_back({{{{0.66, 1.33, kHeadPlane}, 0.085, 0.085},
                    {{0.76, 1.36, kHeadPlane}, 0.125, 0.115},
                    {{0.87, 1.36, kHeadPlane}, 0.125, 0.10},
                    {{0.98, 1.32, kHeadPlane}, 0.085, 0.062},
                    {{1.08, 1.29, kHeadPlane}, 0.066, 0.052},
                    {{1.17, 1.29, kHeadPlane}, 0.074, 0.058},
                    {{1.22, 1.27, kHeadPlane}, 0.05, 0.04}},
                   {0, 1, 0},
                   head_skin});
    out.push_back({{{{0.70, 1.26, kHeadPlane}, 0.09, 0.05},
                    {{0.80, 1.20, kHeadPlane}, 0.095, 0.042},
                    {{0.92, 1.13, kHeadPlane}, 0.07, 0.032},
                    {{1.03, 1.09, kHeadPlane}, 0.056, 0.028},
                    {{1.10, 1.09, kHeadPlane}, 0.03, 0.026}},
                   {0, 1, 0},
                   strand_skin});
    for (int tooth = 0; tooth < 6; ++tooth) {
        const double x = 0.95 + 0.048 * tooth, z = kHeadPlane + 0.068 - 0.006 * tooth;
        const double length = tooth == 5 ? 0.075 : 0.045;
        add_pair(out,
                 {{{{x, 1.275, z}, 0.011, 0.011},
                   {{x + 0.005, 1.275 - 0.6 * length, z}, 0.008, 0.008},
                   {{x - 0.004, 1.26 - length, z}, 0.001, 0.001}},
                  {1, 0, 0}},
                 kHeadPlane);
        add_pair(out,
                 {{{{x - 0.07, 1.13 - 0.008 * tooth, z - 0.012}, 0.009, 0.009},
                   {{x - 0.066, 1.155 - 0.006 * tooth, z - 0.012}, 0.006, 0.006},
                   {{x - 0.07, 1.18 - 0.006 * tooth, z - 0.012}, 0.001, 0.001}},
                  {1, 0, 0}},
                 kHeadPlane);
    }
}

} // namespace

void add_head(std::vector<Limb>& out) {
    add_jaws(out);
    const double z = kHeadPlane;
    // eyes, nostrils, horns with a tine each, ears, whiskers, beard
    add_pair(out,
             {{{{0.865, 1.415, z + 0.085}, 0.026, 0.024}, {{0.925, 1.40, z + 0.08}, 0.026, 0.024}},
              {0, 1, 0}},
             z);
    add_pair(out,
             {{{{1.13, 1.335, z + 0.04}, 0.016, 0.016}, {{1.20, 1.32, z + 0.045}, 0.02, 0.018}},
              {0, 1, 0}},
             z);
    add_pair(out,
             {{{{0.78, 1.42, z + 0.06}, 0.032, 0.032},
               {{0.70, 1.52, z + 0.10}, 0.028, 0.028},
               {{0.56, 1.60, z + 0.15}, 0.022, 0.022},
               {{0.42, 1.61, z + 0.20}, 0.015, 0.015},
               {{0.31, 1.68, z + 0.22}, 0.003, 0.003}},
              {0, 0, 1},
              horn_skin},
             z);
    add_pair(out,
             {{{{0.60, 1.58, z + 0.135}, 0.017, 0.017},
               {{0.56, 1.66, z + 0.16}, 0.013, 0.013},
               {{0.50, 1.72, z + 0.16}, 0.002, 0.002}},
              {0, 0, 1},
              horn_skin},
             z);
    add_pair(out,
             {{{{0.75, 1.37, z + 0.10}, 0.012, 0.03},
               {{0.68, 1.39, z + 0.17}, 0.014, 0.05},
               {{0.58, 1.43, z + 0.21}, 0.006, 0.012}},
              {0, 1, 0},
              strand_skin},
             z);
    add_pair(out,
             {{{{1.17, 1.27, z + 0.06}, 0.012, 0.012},
               {{1.26, 1.20, z + 0.14}, 0.011, 0.011},
               {{1.18, 1.08, z + 0.24}, 0.009, 0.009},
               {{1.02, 1.06, z + 0.28}, 0.008, 0.008},
               {{0.93, 0.95, z + 0.34}, 0.006, 0.006},
               {{0.98, 0.85, z + 0.36}, 0.002, 0.002}},
              {0, 1, 0}},
             z);
}

} // namespace ovc::dragons
