// SPDX-License-Identifier: Apache-2.0
// The projections of POV-Ray's cameras.
// Based on: POV-Ray 3.7 reference, section 3.4.1.2, "Types of Projection"; the formulas are those
// that its pictures follow.
#include "host/camera/bent_window.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

using std::numbers::pi;

/// Returns the direction of a place in a circle around the axis; 0 outside of it. p: the place, at
/// distance 1 on the rim. off_axis: maps the distance from the middle to the angle from the axis.
template <class OffAxis>
dvec3 around_the_axis(const ImageWindow& w, const dvec2& p, OffAxis off_axis) {
    const double distance = glm::length(p);
    if (distance > 1)
        return dvec3(0);
    const double angle = off_axis(distance);
    const dvec2 way = distance > 0 ? p / distance : dvec2(0);
    return std::sin(angle) * (way.x * glm::normalize(w.right) + way.y * glm::normalize(w.up)) +
           std::cos(angle) * glm::normalize(w.direction);
}

/// Returns the place in the circle of a dome's lens. A picture wider than high is cut off below,
/// and one that is wider than the film also at the left and right. Measured on povray 3.7.0.10.
dvec2 on_omnimax(const ImageWindow& w, const dvec2& at) {
    constexpr double kFilm = 1.283458; // the width of the film at height 1
    const double aspect = glm::length(w.right) / glm::length(w.up);
    if (aspect <= 1)
        return {2 * at.x, 2 * at.y / aspect};
    return {2 * at.x * std::max(1.0, aspect / kFilm), (2 * at.y - 1) / std::min(aspect, kFilm) + 1};
}

/// Returns the angle from the axis by POV-Ray's polynomial for that lens.
double omnimax(double r) {
    return r * (1.411269 + r * r * (-0.09439 + r * r * 0.25674));
}

} // namespace

Ray bent_ray(const ImageWindow& w, const dvec3& eye, const dvec2& at) {
    using Bend = ImageWindow::Bend;
    const dvec3 right = glm::normalize(w.right), up = glm::normalize(w.up);
    const dvec3 forward = glm::normalize(w.direction);
    const double across = at.x * w.angle * pi / 180;
    const double upward = at.y * w.angle * pi / 180;
    const double ratio = glm::length(w.up) / glm::length(w.right);
    Ray ray;
    ray.org = eye;
    switch (w.bend) {
    case Bend::Fisheye:
        ray.dir =
            around_the_axis(w, {2 * at.x * glm::length(w.right), 2 * at.y * glm::length(w.up)},
                            [&](double r) { return r * w.angle * pi / 360; });
        break;
    case Bend::Omnimax:
        ray.dir = around_the_axis(w, on_omnimax(w, at), omnimax);
        if (glm::dot(ray.dir, up) < -glm::dot(ray.dir, forward)) // the dome ends 45 degrees down
            ray.dir = dvec3(0);
        break;
    case Bend::UltraWide:
        ray.dir = std::sin(across) * right + std::sin(upward * ratio) * up +
                  std::cos(across) * std::cos(upward * ratio) * forward;
        break;
    case Bend::Panoramic: {
        const double turn = at.x * pi, rise = std::clamp(at.y * pi, -1.57, 1.57);
        ray.dir = std::sin(turn) * w.right + std::tan(rise) * w.up + std::cos(turn) * forward;
        break;
    }
    case Bend::Spherical: {
        // POV-Ray turns around `up` and `right`, which turns a mirrored picture upside down.
        const double hand = glm::dot(glm::cross(right, up), forward) < 0 ? -1 : 1;
        const double rise = hand * at.y * w.vertical_angle * pi / 180;
        ray.dir = std::cos(rise) * (hand * std::sin(across) * right + std::cos(across) * forward) +
                  std::sin(rise) * up;
        break;
    }
    case Bend::Cylinder1:
        ray.dir = std::sin(across) * right + at.y * w.up + std::cos(across) * forward;
        break;
    case Bend::Cylinder2:
        ray.dir = at.x * w.right + std::sin(upward) * up + std::cos(upward) * forward;
        break;
    case Bend::Cylinder3:
        ray.org = eye + at.y * w.up;
        ray.dir = std::sin(across) * right + std::cos(across) * forward;
        break;
    case Bend::Cylinder4:
        ray.org = eye + at.x * w.right;
        ray.dir = std::sin(upward) * up + std::cos(upward) * forward;
        break;
    case Bend::Flat:
        break;
    }
    return ray;
}

} // namespace ovc
