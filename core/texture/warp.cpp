// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.4.7.5.5, "Warp") says what each does; what it leaves open was
// found by asking povray for values.
#include "core/texture/warp.h"

#include "core/texture/image_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

dvec3 affine(const TextureStep& step, const dvec3& at) {
    const dvec4 p(at, 1);
    return {glm::dot(step.rows[0], p), glm::dot(step.rows[1], p), glm::dot(step.rows[2], p)};
}

dvec3 repeated(const TextureStep& step, dvec3 at) {
    for (int axis = 0; axis < 3; ++axis) {
        const double period = step.rows[0][axis];
        if (!(std::abs(period) > 0))
            continue;
        const double times = std::floor(at[axis] / period);
        at[axis] -= times * period;
        if (std::fmod(times, 2) != 0)
            for (int other = 0; other < 3; ++other)
                if (step.rows[2][other] < 0)
                    at[other] = (other == axis ? period : 0) - at[other];
        at += times * dvec3(step.rows[1]);
    }
    return at;
}

/// Within the radius a point moves away from the center, or towards it where the hole pushes.
dvec3 drawn_by_hole(const TextureStep& step, const dvec3& at) {
    const dvec3 center(step.rows[0]);
    const double radius = step.rows[0].w, strength = step.rows[1].x, falloff = step.rows[1].y;
    const dvec3 way = at - center;
    const double length = glm::length(way);
    if (!(length < radius))
        return at;
    const double power = std::min(std::pow((radius - length) / radius, falloff) * strength, 1.0);
    return at + (step.rows[1].z != 0 ? -power : power) * way;
}

/// Returns the point turned from the axis of z, along which these warps are defined, to another.
dvec3 turned_from_z(const dvec3& at, int axis) {
    return axis == 0 ? dvec3(at.z, at.y, -at.x) : axis == 1 ? dvec3(at.x, -at.z, at.y) : at;
}

/// Lays a plane around a cylinder, a sphere or a torus, all of which stand along y: x becomes a
/// turn around it, y the height or a turn of its own, and z the distance.
dvec3 wrapped(const TextureStep& step, const dvec3& at) {
    const double power = step.rows[0].y, major = step.rows[0].z;
    const double away = std::hypot(at.x, at.z), around = share_of_turn(at.x, at.z);
    dvec3 flat(around, at.y, away);
    if (step.kind == TextureStep::Kind::Spherical)
        flat = {around, 0.5 + std::atan2(at.y, away) / std::numbers::pi, glm::length(at)};
    else if (step.kind == TextureStep::Kind::Toroidal)
        flat = {around, 0.5 + std::atan2(at.y, away - major) / (2 * std::numbers::pi),
                std::hypot(away - major, at.y)};
    else if (step.kind == TextureStep::Kind::Planar)
        flat = {at.x, at.y, major};
    if (power != 0) {
        const double scale = std::pow(flat.z, power);
        flat.x *= scale;
        flat.y *= step.kind == TextureStep::Kind::Cylindrical ? 1 : scale;
    }
    return turned_from_z(flat, int(step.rows[0].x));
}

/// The sides stand in a row of four, the top above and the bottom below that of +z, as POV-Ray's
/// documentation shows (section 3.4.7.7.1, "Supported Objects").
dvec3 unfolded(const dvec3& at) {
    const int axis = major_axis(at);
    const bool high = at[axis] > 0;
    constexpr double kColumn = 0.125, kRow = 1 / 6.0; // half of each
    if (axis == 1)
        return {3 * kColumn + kColumn * at.x, high ? 5 * kRow - kRow * at.z : kRow + kRow * at.z,
                0};
    const double across = axis == 0 ? at.z : at.x;
    const double column = axis == 0 ? (high ? 5 : 1) : (high ? 3 : 7);
    const bool turned = axis == 0 ? high : !high;
    return {kColumn * (column + (turned ? -across : across)), 0.5 + kRow * at.y, 0};
}

} // namespace

dvec3 warped(const TextureStep& step, const dvec3& at) {
    switch (step.kind) {
    case TextureStep::Kind::Turbulence: {
        const dvec4 &first = step.rows[0], &second = step.rows[1];
        return at + dvec3(first) * turbulence(at, {first.w, second.x, uint64_t(second.y)});
    }
    case TextureStep::Kind::Repeat:
        return repeated(step, at);
    case TextureStep::Kind::BlackHole:
        return drawn_by_hole(step, at);
    case TextureStep::Kind::Cylindrical:
    case TextureStep::Kind::Spherical:
    case TextureStep::Kind::Toroidal:
    case TextureStep::Kind::Planar:
        return wrapped(step, at);
    case TextureStep::Kind::BoxNet:
        return unfolded(at);
    case TextureStep::Kind::Cubic: {
        const double half = max_component(glm::abs(at));
        return unfolded(at / half) + dvec3(0, 0, half);
    }
    default:
        return affine(step, at);
    }
}

} // namespace ovc
