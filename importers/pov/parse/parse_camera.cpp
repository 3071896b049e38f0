// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_camera.h"

#include "importers/file/text.h"
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

void set_angle(Reader& reader, CameraValue& camera, double degrees) {
    if (!(degrees > 0 && degrees <= 360))
        reader.fail(reader.place(), fmt::format("found a camera's angle of {}", degrees));
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

} // namespace

CameraValue parse_camera(Reader& reader) {
    const Deeper deeper(reader);
    CameraValue camera;
    std::optional<dvec3> target;
    std::optional<double> angle;
    dmat4 placed(1);
    reader.expect('{', "camera");
    if (const auto other = take_named_if<CameraValue>(reader))
        camera = *other;
    while (!reader.take('}')) {
        const Token token = reader.peek();
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
            angle = parse_float(reader);
            if (reader.take(',') && starts_number(reader, reader.peek()))
                camera.vertical_angle = parse_float(reader);
        } else if (take_bend(reader, camera))
            ;
        else if (reader.take("orthographic"))
            camera.orthographic = true;
        else if (reader.take("perspective"))
            camera.orthographic = false;
        else if (reader.take("normal"))
            camera.normal = parse_normal(reader, {});
        else if (const auto m = take_transform(reader))
            placed = *m * placed;
        else if (token.kind == TokenKind::Name) {
            reader.next();
            if (token.is("mesh_camera"))
                reader.omit("projection", token.place,
                            fmt::format("the camera {} is taken for a perspective one",
                                        ovc::quoted(token.name->text)));
            else if (token.is("aperture"))
                reader.omit(token.name->text, token.place,
                            fmt::format("the camera's {} is left out", token.name->text));
            skip_arguments(reader);
        } else if (!reader.take(','))
            reader.fail_here("'}' or a part of a camera");
    }
    if (target)
        look_at(reader, camera, *target);
    else if (!camera.distance)
        camera.distance = glm::length(dvec3(0, 0, 1) - camera.location);
    if (angle)
        set_angle(reader, camera, *angle);
    apply(camera, placed);
    return camera;
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
