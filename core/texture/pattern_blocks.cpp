// SPDX-License-Identifier: Apache-2.0
// POV-Ray's block patterns, which choose one of a list of colors (section 3.4.7.2 of its
// documentation, "Discontinuous Patterns"), and pbrt's dots.
#include "core/texture/noise/perlin.h"
#include "core/texture/pattern_value.h"

#include <cmath>
#include <numbers>

namespace ovc {

namespace {

/// A checker changes this far off whole numbers, so that a plane through them keeps to one side
/// though its corners are floats. POV-Ray, whose planes are exact, takes 1e-10.
constexpr double kCellOffset = 1e-6;

/// Returns the remainder of the division by the integer, from 0 on.
double modulo(double x, double by) {
    return x - by * std::floor(x / by);
}

/// Returns 1 for a brick and 0 for mortar. parameters: the size of a brick with its mortar, and the
/// mortar's thickness.
double brick(const Pattern& pattern, const dvec3& at) {
    dvec3 in_bricks;
    for (int i = 0; i < 3; ++i)
        in_bricks[i] = (at[i] + kCellOffset) / pattern.parameters[size_t(i)];
    const bool odd = modulo(std::floor(in_bricks.y), 2) != 0;
    in_bricks[odd ? 0 : 2] += 0.5;
    for (int i = 0; i < 3; ++i)
        if (modulo(in_bricks[i], 1) >= 1 - pattern.parameters[3] / pattern.parameters[size_t(i)])
            return 0;
    return 1;
}

/// Returns the sum of the numbers of the unit cell.
double sum_of_cell(const dvec3& at) {
    const dvec3 cell = glm::floor(at + kCellOffset);
    return cell.x + cell.y + cell.z;
}

/// Hexagons of side 1 in the plane of x and z stand in columns 1.5 apart.
double hexagon(const dvec3& at) {
    const double height = std::numbers::sqrt3;
    double nearest = 1e300, color = 0;
    const double middle = std::floor(at.x / 1.5);
    for (int i = 0; i < 2; ++i) {
        const double column = middle + i;
        const double row = std::floor(at.z / height - 0.5 * column + 0.5);
        const double dx = at.x - 1.5 * column, dz = at.z - height * (row + 0.5 * column);
        if (const double away = dx * dx + dz * dz; away < nearest) {
            nearest = away;
            color = modulo(row - column, 3);
        }
    }
    return color;
}

/// Returns the number of the face of a cube around the origin that the point is seen through.
double cubic(const dvec3& at) {
    const int axis = major_axis(at);
    return axis + (at[axis] < 0 ? 3 : 0);
}

/// Squares of side 1 in the plane of x and z, four in a larger one.
double square_tile(const dvec3& at) {
    const bool odd_x = modulo(std::floor(at.x + kCellOffset), 2) != 0;
    const bool odd_z = modulo(std::floor(at.z + kCellOffset), 2) != 0;
    return odd_x ? (odd_z ? 2 : 3) : odd_z ? 1 : 0;
}

/// Triangles of side 1 in the plane of x and z. Rows of them alternate; within a row those that
/// stand on their side and those that stand on a corner do.
double triangle_tile(const dvec3& at) {
    const double height = 0.5 * std::numbers::sqrt3;
    const double row = std::floor(at.z / height), up = at.z / height - row;
    const bool odd = modulo(row, 2) != 0;
    const double x =
        odd ? at.x + 0.5 : at.x; // triangles that stand on their side begin at integers
    const double cell = std::floor(x), along = x - cell;
    const bool stands_on_side = up < 2 * std::min(along, 1 - along);
    const double corner = along < 0.5 ? cell : cell + 1;
    static constexpr double kOnSide[2][3] = {{0, 4, 2}, {4, 2, 0}};
    static constexpr double kOnCorner[2][3] = {{1, 3, 5}, {3, 5, 1}};
    const auto third = [](double number) { return size_t(modulo(number, 3)); };
    return stands_on_side ? kOnSide[odd][third(cell)] : kOnCorner[odd][third(corner)];
}

/// Half of the unit squares around whole coordinates have a dot, somewhere in them.
/// Based on: Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", section 10.6.
double dot_tile(const dvec3& at) {
    constexpr double kRadius = 0.35, kMaxShift = 0.5 - kRadius;
    const double s = std::floor(at.x + 0.5), t = std::floor(at.y + 0.5);
    const auto noise = [&](double ds, double dt) { return improved_noise({s + ds, t + dt, 0.5}); };
    if (noise(0.5, 0.5) <= 0)
        return 0;
    const dvec2 middle(s + kMaxShift * noise(1.5, 2.8), t + kMaxShift * noise(4.5, 9.8));
    return glm::distance(dvec2(at), middle) < kRadius ? 1 : 0;
}

} // namespace

double discrete_value(const Pattern& pattern, const dvec3& at) {
    switch (pattern.kind) {
    case Pattern::Kind::Brick:
        return brick(pattern, at);
    case Pattern::Kind::Checker:
        return modulo(sum_of_cell(at), 2);
    case Pattern::Kind::Cubic:
        return cubic(at);
    case Pattern::Kind::Dots:
        return dot_tile(at);
    case Pattern::Kind::Hexagon:
        return hexagon(at);
    case Pattern::Kind::Object:
        return pattern.region.contains(at) ? 1 : 0;
    case Pattern::Kind::Square:
        return square_tile(at);
    case Pattern::Kind::Triangular:
        return triangle_tile(at);
    default:
        return 0;
    }
}

} // namespace ovc
