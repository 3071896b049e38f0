// SPDX-License-Identifier: Apache-2.0
// Pinhole rays, the order of pixels and automatic framing.
#include "host/camera.h"

#include "host/bent_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

/// The basis of a view: forward and up are perpendicular, all three of unit length.
struct ViewAxes {
    dvec3 forward, right, up;
};

static ViewAxes view_axes(const Camera& camera) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    dvec3 right = glm::cross(forward, camera.up);
    if (!(glm::dot(right, right) > 1e-18 * glm::dot(camera.up, camera.up))) {
        dvec3 other(0);
        other[(major_axis(forward) + 1) % 3] = 1;
        right = glm::cross(forward, other);
    }
    right = glm::normalize(right);
    return {forward, right, glm::cross(right, forward)};
}

static double half_angle_tangent(double fov_degrees) {
    return std::tan(fov_degrees * (std::numbers::pi / 360.0));
}

Result<Done> check_camera(const Camera& camera) {
    const ImageWindow window = camera.window.value_or(ImageWindow{});
    for (const dvec3& v :
         {camera.eye, camera.target, camera.up, window.direction, window.right, window.up})
        if (!is_finite(v) || max_component(glm::abs(v)) > kFarthest)
            return Error{
                fmt::format("the camera's numbers are not all finite and within {}", kFarthest)};
    if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180))
        return Error{fmt::format("the camera's field of view is {}, not between 0 and 180 degrees",
                                 camera.fov_degrees)};
    // Also when they differ by so little that their distance comes out as 0.
    if (!(glm::length(camera.target - camera.eye) > 0))
        return Error{"the camera looks from a point at itself"};
    const auto unit = [](const dvec3& v) { return v / max_component(glm::abs(v)); };
    if (!(std::abs(glm::dot(glm::cross(unit(window.right), unit(window.up)),
                            unit(window.direction))) > 1e-12))
        return Error{"the camera's direction, right and up lie in one plane"};
    return Done{};
}

Pinhole::Pinhole(const Camera& camera, const PicturePart& part) : part_(part), eye_(camera.eye) {
    assert(part.size.width > 0 && part.left + part.size.width <= part.picture.width);
    assert(part.size.height > 0 && part.top + part.size.height <= part.picture.height);
    assert(check_camera(camera));
    const auto [width, height] = part.picture;
    const ViewAxes axes = view_axes(camera);
    right_ = axes.right;
    up_ = axes.up;
    middle_ = axes.forward;
    const double unit = half_angle_tangent(camera.fov_degrees) / std::min(width, height);
    to_right_ = unit * width * right_;
    to_top_ = unit * height * up_;
    if (camera.window) {
        middle_ = camera.window->direction;
        to_right_ = 0.5 * camera.window->right;
        to_top_ = 0.5 * camera.window->up;
        orthographic_ = camera.window->orthographic;
        if (camera.window->bend != ImageWindow::Bend::Flat)
            bent_ = *camera.window;
    }
}

Ray Pinhole::ray(uint32_t x, uint32_t y, const dvec2& place) const {
    const dvec2 at = (dvec2(part_.left + x, part_.top + y) + place) /
                     dvec2(part_.picture.width, part_.picture.height);
    if (bent_)
        return bent_ray(*bent_, eye_, {at.x - 0.5, 0.5 - at.y});
    const dvec3 in_plane = (2 * at.x - 1) * to_right_ + (1 - 2 * at.y) * to_top_;
    Ray ray;
    ray.org = orthographic_ ? eye_ + in_plane : eye_;
    ray.dir = orthographic_ ? middle_ : middle_ + in_plane;
    return ray;
}

namespace {

struct Cell {
    uint32_t x, y;
};

/// How Hilbert's curve goes through a square: it comes in at one corner, goes through the quarters
/// and leaves at a corner beside that one.
struct Way {
    bool turned = false;  // x and y change places
    bool flipped = false; // both count from the other end

    /// Of the i-th quarter, where it is.
    Cell quarter(size_t i) const {
        const bool x = i == 2 || i == 3, y = i == 1 || i == 2;
        return {uint32_t((turned ? y : x) != flipped), uint32_t((turned ? x : y) != flipped)};
    }
    /// And how the curve goes through that one.
    Way through_quarter(size_t i) const {
        return {turned != (i == 0 || i == 3), flipped != (i == 3)};
    }
    Cell in_tile(const Cell& cell, uint32_t side) const {
        const uint32_t mask = flipped ? side - 1 : 0;
        return {(turned ? cell.y : cell.x) ^ mask, (turned ? cell.x : cell.y) ^ mask};
    }
};

/// Calls put(cell, way) along the curve for the cells of a grid in the square at (x, y), whose side
/// is a power of two.
template <class Put>
void along_curve(const Cell& grid, uint32_t x, uint32_t y, uint32_t side, const Way& way,
                 const Put& put) {
    if (x >= grid.x || y >= grid.y)
        return;
    if (side == 1)
        return put(Cell{x, y}, way);
    const uint32_t half = side / 2;
    for (size_t i = 0; i < 4; ++i) {
        const Cell at = way.quarter(i);
        along_curve(grid, x + at.x * half, y + at.y * half, half, way.through_quarter(i), put);
    }
}

template <class Put>
void along_curve(const Cell& grid, const Put& put) {
    along_curve(grid, 0, 0, std::bit_ceil(std::max(grid.x, grid.y)), {}, put);
}

} // namespace

std::vector<uint32_t> pixel_order(uint32_t width, uint32_t height) {
    assert(width <= 65535 && height <= 65535);
    constexpr uint32_t kTile = 8; // tiles are all alike: the curve need not be followed in each
    std::vector<Cell> tile;
    along_curve({kTile, kTile}, [&](const Cell& cell, const Way&) { tile.push_back(cell); });
    std::vector<uint32_t> pixels;
    pixels.reserve(size_t(width) * height);
    const Cell tiles{(width + kTile - 1) / kTile, (height + kTile - 1) / kTile};
    along_curve(tiles, [&](const Cell& at, const Way& way) {
        for (const Cell& in_base : tile) {
            const Cell cell = way.in_tile(in_base, kTile);
            const uint32_t x = at.x * kTile + cell.x, y = at.y * kTile + cell.y;
            if (x < width && y < height)
                pixels.push_back(y * width + x);
        }
    });
    return pixels;
}

Camera framing_camera(const Box& bounds, uint32_t width, uint32_t height) {
    Camera camera;
    if (bounds.empty())
        return camera;
    camera.target = bounds.center();
    const dvec3 towards_eye = glm::normalize(dvec3(0.45, 0.35, 1));
    camera.eye = camera.target + towards_eye;
    const ViewAxes axes = view_axes(camera);

    const double unit = half_angle_tangent(camera.fov_degrees) / std::min(width, height);
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        const dvec3 corner = sign * bounds.extent();
        const double nearer = -glm::dot(corner, axes.forward);
        distance =
            std::max({distance, nearer + std::abs(glm::dot(corner, axes.right)) / (unit * width),
                      nearer + std::abs(glm::dot(corner, axes.up)) / (unit * height)});
    }
    // 4 % of air around the model; a scene that is one point is looked at from some way off.
    distance = distance > 0 ? distance * 1.04 : 1;
    camera.eye = camera.target + distance * towards_eye;
    return camera;
}

Light shoulder_light(const Camera& camera) {
    const ViewAxes axes = view_axes(camera);
    const double distance = glm::length(camera.target - camera.eye);
    return {camera.eye + distance * (1.1 * axes.up - 0.9 * axes.right), kDefaultLightColor};
}

std::vector<Light> placed_lights(const std::vector<Light>& lights, const Camera& camera) {
    std::vector<Light> placed = lights;
    for (Light& light : placed)
        if (light.on_camera)
            light.position += camera.eye;
    if (placed.empty())
        placed.push_back(shoulder_light(camera));
    return placed;
}

} // namespace ovc
