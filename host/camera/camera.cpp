// SPDX-License-Identifier: Apache-2.0
// Pinhole rays, the order of pixels and automatic framing.
#include "host/camera/camera.h"

#include "host/camera/bent_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Returns half the size of a pixel of a picture of this size, at a distance of 1.
static double half_pixel(const Camera& camera, uint32_t width, uint32_t height) {
    return std::tan(camera.fov_degrees * (std::numbers::pi / 360.0)) /
           (camera.fov_is_upright ? height : std::min(width, height));
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
    if (!(camera.nearest >= 0 && camera.nearest <= kFarthest))
        return Error{fmt::format("the camera sees nothing nearer than {}", camera.nearest)};
    // Points that differ by so little that their distance comes out as 0 are refused too.
    if (!(glm::length(camera.target - camera.eye) > 0))
        return Error{"the camera looks from a point at itself"};
    const auto unit = [](const dvec3& v) { return v / max_component(glm::abs(v)); };
    if (!(std::abs(glm::dot(glm::cross(unit(window.right), unit(window.up)),
                            unit(window.direction))) > 1e-12))
        return Error{"the camera's direction, right and up lie in one plane"};
    if (const Lens lens = camera.lens.value_or(Lens{});
        !(lens.focus > 0 && lens.focus <= kFarthest) || !is_finite(lens.right) ||
        !is_finite(lens.up))
        return Error{"the camera's lens has no size, or is sharp nowhere in front of it"};
    return Done{};
}

/// Returns how much of the window's width and height a picture of this shape shows.
static dvec2 share_of_window(const ImageWindow& window, double shape) {
    if (!(window.shape > 0))
        return dvec2(1);
    const auto sides = [](double s) { return dvec2(std::max(s, 1.0), std::max(1 / s, 1.0)); };
    return sides(shape) / sides(window.shape);
}

Pinhole::Pinhole(const Camera& camera, const PicturePart& part, const Scene* scene)
    : part_(part), scene_(scene), nearest_(camera.nearest), eye_(camera.eye) {
    assert(part.size.width > 0 && part.left + part.size.width <= part.picture.width);
    assert(part.size.height > 0 && part.top + part.size.height <= part.picture.height);
    assert(check_camera(camera));
    const auto [width, height] = part.picture;
    const ViewAxes axes = view_axes(camera);
    right_ = axes.right;
    up_ = axes.up;
    middle_ = axes.forward;
    const double unit = half_pixel(camera, width, height);
    to_right_ = unit * width * right_;
    to_top_ = unit * height * up_;
    bump_ = camera.bump;
    lens_ = camera.lens;
    if (camera.window) {
        middle_ = camera.window->direction;
        const dvec2 share = share_of_window(*camera.window, double(width) / double(height));
        to_right_ = 0.5 * share.x * camera.window->right;
        to_top_ = 0.5 * share.y * camera.window->up;
        orthographic_ = camera.window->orthographic;
        if (camera.window->bend != ImageWindow::Bend::Flat)
            bent_ = *camera.window;
    }
    if (camera.by_faces && scene && scene->faces)
        faces_.emplace(*scene->faces, part.picture);
    if (bent_)
        lens_.reset();
}

Ray Pinhole::ray(uint32_t x, uint32_t y, const dvec2& place, const dvec2& lens,
                 uint32_t sample) const {
    if (faces_)
        return faces_->ray(part_.left + x, part_.top + y, place, sample);
    const dvec2 at = (dvec2(part_.left + x, part_.top + y) + place) /
                     dvec2(part_.picture.width, part_.picture.height);
    return ray_at(at, lens);
}

Ray Pinhole::ray_at(const dvec2& at, const dvec2& lens) const {
    Ray ray = bent_ ? bent_ray(*bent_, eye_, {at.x - 0.5, 0.5 - at.y}) : straight_ray(at);
    if (lens_ && lens != dvec2(0)) {
        const dvec3 off = lens.x * lens_->right + lens.y * lens_->up;
        ray.org += off;
        ray.dir -= off / lens_->focus; // t is the depth still
    }
    if (bump_ && scene_ && ray.dir != dvec3(0))
        ray.dir = bumped(scene_->textures, scene_->bumps, *bump_, {at.x - 0.5, 0.5 - at.y, 0},
                         glm::normalize(ray.dir), ray.dir);
    if (nearest_ > 0 && ray.dir != dvec3(0))
        ray.t_min = nearest_ / glm::length(ray.dir);
    return ray;
}

Ray Pinhole::straight_ray(const dvec2& at) const {
    const dvec3 in_plane = (2 * at.x - 1) * to_right_ + (1 - 2 * at.y) * to_top_;
    Ray ray;
    ray.org = orthographic_ ? eye_ + in_plane : eye_;
    ray.dir = orthographic_ ? middle_ : middle_ + in_plane;
    return ray;
}

namespace {

/// The pixels of an image along Hilbert's curve, which comes into a square at one corner, goes
/// through its quarters, and leaves at a corner beside that one.
class HilbertCurve {
public:
    HilbertCurve(uint32_t width, uint32_t height) : width_(width), height_(height) {
        pixels_.reserve(size_t(width) * height);
    }

    /// Appends the pixels in the square at (x, y), whose side is a power of two. turned: x and y
    /// change places in it. flipped: both count from the other end.
    void go_through(uint32_t x, uint32_t y, uint32_t side, bool turned, bool flipped) {
        if (x >= width_ || y >= height_)
            return;
        if (side == 1) {
            pixels_.push_back(y * width_ + x);
            return;
        }
        static constexpr bool kQuarters[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
        const uint32_t half = side / 2;
        for (int i = 0; i < 4; ++i) {
            const bool right = kQuarters[i][turned] != flipped;
            const bool below = kQuarters[i][!turned] != flipped;
            go_through(right ? x + half : x, below ? y + half : y, half,
                       turned != (i == 0 || i == 3), flipped != (i == 3));
        }
    }

    std::vector<uint32_t> take() { return std::move(pixels_); }

private:
    const uint32_t width_, height_;
    std::vector<uint32_t> pixels_;
};

} // namespace

std::vector<uint32_t> pixel_order(uint32_t width, uint32_t height) {
    assert(width <= 65535 && height <= 65535);
    HilbertCurve curve(width, height);
    curve.go_through(0, 0, std::bit_ceil(std::max(width, height)), false, false);
    return curve.take();
}

dvec3 axis_vector(int axis) {
    assert(axis >= 0 && axis < 3);
    dvec3 vector(0);
    vector[axis] = 1;
    return vector;
}

/// Returns v turned by a quarter, so that the y axis becomes the axis `up`.
static dvec3 turned(const dvec3& v, int up) {
    return up == 0 ? dvec3(v.y, -v.x, v.z) : up == 1 ? v : dvec3(v.x, -v.z, v.y);
}

Camera framing_camera(const Box& bounds, uint32_t width, uint32_t height, int up) {
    Camera camera;
    camera.up = axis_vector(up);
    camera.eye = turned(camera.eye, up);
    if (bounds.empty())
        return camera;
    camera.target = bounds.center();
    const dvec3 towards_eye = turned(glm::normalize(dvec3(0.45, 0.35, 1)), up);
    camera.eye = camera.target + towards_eye;
    const ViewAxes axes = view_axes(camera);

    const double unit = half_pixel(camera, width, height);
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        const dvec3 corner = sign * bounds.extent();
        const double nearer = -glm::dot(corner, axes.forward);
        distance =
            std::max({distance, nearer + std::abs(glm::dot(corner, axes.right)) / (unit * width),
                      nearer + std::abs(glm::dot(corner, axes.up)) / (unit * height)});
    }
    // We leave 4 % of air around the model, and look at a scene that is one point from 1 away.
    distance = distance > 0 ? distance * 1.04 : 1;
    camera.eye = camera.target + distance * towards_eye;
    return camera;
}

Lens lens_of(const Camera& camera, double radius, std::optional<double> focus) {
    const ViewAxes axes = view_axes(camera);
    const double unit =
        camera.window ? glm::length(camera.window->direction) : 1; // a depth of t = 1
    const double distance = focus.value_or(glm::length(camera.target - camera.eye));
    return {radius * axes.right, radius * axes.up, distance / unit};
}

Light shoulder_light(const Camera& camera) {
    const ViewAxes axes = view_axes(camera);
    const double distance = glm::length(camera.target - camera.eye);
    return {camera.eye + distance * (1.1 * axes.up - 0.9 * axes.right), kDefaultLightColor};
}

std::vector<Light> placed_lights(const Scene& scene, const std::vector<Light>& lights,
                                 const Camera& camera) {
    std::vector<Light> placed = lights;
    for (Light& light : placed)
        if (light.on_camera)
            light.position += camera.eye;
    if (placed.empty() && scene.may_add_light)
        placed.push_back(shoulder_light(camera));
    return placed;
}

} // namespace ovc
