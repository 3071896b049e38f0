// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_camera.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc::pov {

namespace {

/// Turns the view towards a point. The lengths of the vectors and their handedness stay the same.
void look_at(Reader& reader, CameraValue& camera, const dvec3& target) {
    const double direction_length = glm::length(camera.direction);
    const double up_length = glm::length(camera.up);
    const double right_length = glm::length(camera.right);
    const double handedness = glm::dot(glm::cross(camera.direction, camera.up), camera.right);
    const dvec3 way = target - camera.location;
    if (!(glm::length(way) > 0))
        reader.fail(reader.place(), "the camera looks from a point at itself");
    camera.distance = glm::length(way);
    camera.direction = glm::normalize(way);
    dvec3 right = glm::cross(camera.sky, camera.direction);
    if (!(glm::length(right) > 1e-10)) // the camera looks along its sky vector
        right = camera.right;
    right = glm::normalize(right);
    camera.up = glm::cross(camera.direction, right) * up_length;
    camera.direction *= direction_length;
    camera.right = right * (handedness >= 0 ? -right_length : right_length);
}

void set_angle(Reader& reader, CameraValue& camera, double degrees, const Place& at) {
    const bool is_flat = camera.bend == ImageWindow::Bend::Flat && !camera.faces;
    if (is_flat && degrees == 0) // as if there were none
        return;
    if (!(degrees > 0 && (is_flat ? degrees < 180 : degrees <= 360)))
        reader.fail(at, fmt::format("found a camera's angle of {}, expected one above 0 and {}",
                                    degrees, is_flat ? "below 180" : "up to 360"));
    camera.angle = degrees;
    if (degrees < 180 && glm::length(camera.direction) > 0)
        camera.direction =
            glm::normalize(camera.direction) *
            (0.5 * glm::length(camera.right) / std::tan(degrees * std::numbers::pi / 360));
}

void apply(CameraValue& camera, const dmat4& m) {
    for (dvec3* v : {&camera.direction, &camera.up, &camera.right})
        *v = dvec3(m * dvec4(*v, 0));
    camera.location = dvec3(m * dvec4(camera.location, 1));
    if (camera.focal_point)
        camera.focal_point = dvec3(m * dvec4(*camera.focal_point, 1));
}

/// Takes a projection such as `fisheye` or `cylinder 2`. Returns false where none is next.
bool take_bend(Reader& reader, CameraValue& camera) {
    using Bend = ImageWindow::Bend;
    static constexpr std::pair<std::string_view, Bend> kWords[] = {
        {"fisheye", Bend::Fisheye},     {"ultra_wide_angle", Bend::UltraWide},
        {"omnimax", Bend::Omnimax},     {"panoramic", Bend::Panoramic},
        {"spherical", Bend::Spherical}, {"cylinder", Bend::Cylinder1}};
    for (const auto& [word, bend] : kWords)
        if (reader.take(word)) {
            camera.bend = bend;
            static_assert(int(Bend::Cylinder4) == int(Bend::Cylinder1) + 3);
            if (bend == Bend::Cylinder1)
                camera.bend =
                    Bend(int(bend) + parse_int(reader, 1, 4, "the kind of a cylinder") - 1);
            return true;
        }
    return false;
}

/// Takes a part of focal blur. Those that say when povray takes fewer rays are skipped.
bool take_lens_part(Reader& reader, CameraValue& camera) {
    if (reader.take("aperture"))
        camera.aperture = parse_float(reader);
    else if (reader.take("focal_point"))
        camera.focal_point = parse_vector(reader);
    else if (reader.take("blur_samples")) { // MAX or MIN, MAX
        camera.blur_samples = uint32_t(parse_int(reader, 0, 1 << 16, "blur_samples"));
        if (reader.take(','))
            camera.blur_samples = uint32_t(parse_int(reader, 0, 1 << 16, "blur_samples"));
    } else
        return false;
    return true;
}

} // namespace

CameraValue parse_camera(Reader& reader) {
    const Deeper deeper(reader);
    CameraValue camera;
    std::optional<dvec3> target;
    std::optional<double> angle;
    Place angle_at;
    dmat4 placed(1);
    reader.expect('{', "camera");
    if (const auto other = take_named_if<CameraValue>(reader))
        camera = *other;
    while (!reader.take('}')) {
        if (reader.take("location"))
            camera.location = parse_vector(reader);
        else if (reader.take("direction"))
            camera.direction = parse_vector(reader);
        else if (const bool is_up = reader.take("up"); is_up || reader.take("right")) {
            (is_up ? camera.up : camera.right) = parse_vector(reader);
            camera.window_given = true;
        } else if (reader.take("sky"))
            camera.sky = parse_vector(reader);
        else if (reader.take("look_at"))
            target = parse_vector(reader);
        else if (reader.take("angle")) {
            angle_at = reader.peek().place;
            angle = parse_float(reader);
            reader.take_comma();
            if (starts_number(reader, reader.peek()))
                camera.vertical_angle = parse_float(reader);
        } else if (take_bend(reader, camera))
            ;
        else if (reader.take("orthographic"))
            camera.orthographic = true;
        else if (reader.take("perspective"))
            camera.orthographic = false;
        else if (reader.take("normal"))
            camera.normal = parse_normal(reader, {});
        else if (take_lens_part(reader, camera))
            ;
        else if (reader.take("mesh_camera"))
            parse_mesh_camera(reader, camera);
        else if (const auto m = take_transform(reader))
            placed = *m * placed;
        else if (!take_skipped(reader, {"confidence", "variance"}) && !reader.take(','))
            reader.fail_here("'}' or a part of a camera");
    }
    if (target)
        look_at(reader, camera, *target);
    else if (!camera.distance)
        camera.distance = glm::length(dvec3(0, 0, 1) - camera.location);
    if (angle)
        set_angle(reader, camera, *angle, angle_at);
    apply(camera, placed);
    return camera;
}

/// Returns the lens of focal blur, as wide as half of the aperture, whose focus lies in the plane
/// of the focal point.
static Lens focal_blur_of(const CameraValue& c) {
    const double depth = glm::dot(c.direction, c.direction);
    const dvec3 point = c.focal_point.value_or(c.location + c.direction);
    const double focus = depth > 0 ? glm::dot(point - c.location, c.direction) / depth : 1;
    const auto across = [&](const dvec3& side) {
        const double length = glm::length(side);
        return length > 0 ? 0.25 * c.aperture / length * side : dvec3(0);
    };
    return {across(c.right), across(c.up), focus > 0 ? focus : 1};
}

Camera camera_of(const CameraValue& c) {
    Camera camera;
    camera.eye = c.location;
    camera.window = ImageWindow{c.direction, c.right, c.up, c.orthographic};
    camera.window->bend = c.bend;
    const bool all_around = c.bend == ImageWindow::Bend::Spherical;
    camera.window->angle = c.angle > 0 ? c.angle : all_around ? 360 : 90;
    camera.window->vertical_angle =
        c.vertical_angle > 0 ? c.vertical_angle : 0.5 * camera.window->angle;
    // With an angle, or without right and up, an orthographic camera's window is as large as a
    // perspective camera's view at look_at.
    if (c.orthographic && (c.angle > 0 || !c.window_given) && c.distance) {
        const double scale = *c.distance / glm::length(c.direction);
        camera.window->right *= scale;
        camera.window->up *= scale;
    }
    camera.by_faces = c.faces != nullptr;
    if (c.blur_samples > 0 && c.aperture > 0 && !c.faces)
        camera.lens = focal_blur_of(c);
    // povray's rays do not see a surface that they begin on.
    constexpr double kNearest = 1e-6;
    camera.nearest = kNearest;
    camera.up = glm::length(c.sky) > 0 ? c.sky : c.up;
    const double depth = glm::length(c.direction);
    camera.target = c.location + c.direction * (c.distance && depth > 0 ? *c.distance / depth : 1);
    const double side = std::min(glm::length(c.right), glm::length(c.up));
    camera.fov_degrees =
        depth > 0 ? std::clamp(std::atan(0.5 * side / depth) * 360 / std::numbers::pi, 1.0, 179.0)
                  : 40;
    return camera;
}

} // namespace ovc::pov
