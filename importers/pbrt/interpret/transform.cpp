// SPDX-License-Identifier: Apache-2.0
// Rotation and view as 4x4 matrices.
#include "importers/pbrt/interpret/transform.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc::pbrt {

/// Quarter turns are exact, so that floors stay level.
static dvec2 cosine_and_sine(double degrees) {
    assert(std::isfinite(degrees));
    const double turns = std::fmod(degrees, 360) / 90;
    if (turns == std::floor(turns)) {
        constexpr dvec2 kQuarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        return kQuarters[(int(turns) + 4) % 4];
    }
    const double radians = degrees * (std::numbers::pi / 180);
    return {std::cos(radians), std::sin(radians)};
}

dmat4 rotation(double degrees, const dvec3& axis) {
    const double length = glm::length(axis);
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(degrees))
        return dmat4(1);
    const dvec3 a = axis / length;
    const dvec2 turn = cosine_and_sine(degrees);
    const double c = turn.x, s = turn.y;
    dmat4 m(1);
    m[0] = {a.x * a.x + (1 - a.x * a.x) * c, a.x * a.y * (1 - c) + a.z * s,
            a.x * a.z * (1 - c) - a.y * s, 0};
    m[1] = {a.x * a.y * (1 - c) - a.z * s, a.y * a.y + (1 - a.y * a.y) * c,
            a.y * a.z * (1 - c) + a.x * s, 0};
    m[2] = {a.x * a.z * (1 - c) + a.y * s, a.y * a.z * (1 - c) - a.x * s,
            a.z * a.z + (1 - a.z * a.z) * c, 0};
    return m;
}

bool look_at(const dvec3& eye, const dvec3& target, const dvec3& up, dmat4& world_to_camera) {
    const dvec3 forward = glm::normalize(target - eye);
    const dvec3 right = glm::normalize(glm::cross(glm::normalize(up), forward));
    if (!ovc::is_finite(eye) || !ovc::is_finite(forward) || !ovc::is_finite(right))
        return false;
    dmat4 camera_to_world(1);
    camera_to_world[0] = glm::dvec4(right, 0);
    camera_to_world[1] = glm::dvec4(glm::cross(forward, right), 0);
    camera_to_world[2] = glm::dvec4(forward, 0);
    camera_to_world[3] = glm::dvec4(eye, 1);
    world_to_camera = glm::inverse(camera_to_world);
    return true;
}

dmat4 from_file(std::span<const double> numbers) {
    assert(numbers.size() == 16);
    dmat4 m;
    for (int i = 0; i < 16; ++i)
        m[i / 4][i % 4] = numbers[size_t(i)];
    return m;
}

dmat3 normal_matrix(const dmat4& m) {
    const dvec3 a(m[0]), b(m[1]), c(m[2]);
    const dmat3 cofactors(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
    return glm::dot(a, cofactors[0]) < 0 ? -cofactors : cofactors;
}

bool is_finite(const dmat4& m) {
    for (int column = 0; column < 4; ++column)
        if (!ovc::is_finite(m[column]) || !std::isfinite(m[column].w))
            return false;
    return true;
}

} // namespace ovc::pbrt
