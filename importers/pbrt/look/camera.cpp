// SPDX-License-Identifier: Apache-2.0
// A camera becomes a window in its own space, which may be of either handedness, or stretched.
#include "importers/pbrt/look/camera.h"

#include "importers/file/text.h"
#include "importers/pbrt/interpret/left_over.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc::pbrt {

namespace {

uint32_t side_of(const Parameters& parameters, std::string_view name, uint32_t otherwise,
                 Diagnostics& diagnostics) {
    constexpr double kMax = 65535;
    const double value = parameters.number(name, otherwise);
    if (value >= 1 && value <= kMax)
        return uint32_t(value);
    diagnostics.fail(parameters.find(name)->place,
                     fmt::format("found {} {}, expected 1 to {}", name, value, kMax));
    return otherwise;
}

/// Takes the part of the picture that is rendered: pbrt's cropwindow in shares of it, or v4's
/// pixelbounds; x from and to, then y. Pixels are counted in floats, as pbrt does.
void take_part(const Parameters& parameters, Film& film, Diagnostics& diagnostics) {
    const vec2 size(film.size.width, film.size.height);
    for (const std::string_view name : {"cropwindow", "pixelbounds"}) {
        const Parameter* const part = parameters.find(name, {Kind::Float, Kind::Integer});
        if (!part)
            continue;
        part->wants = 4;
        if (part->numbers.size() != 4)
            return; // tell_left_over() fails
        const std::vector<double>& n = part->numbers;
        const vec2 scale = name == "cropwindow" ? size : vec2(1);
        const vec2 a = scale * vec2(n[0], n[2]), b = scale * vec2(n[1], n[3]);
        const vec2 first = glm::max(glm::ceil(glm::min(a, b)), vec2(0));
        const vec2 last = glm::min(glm::ceil(glm::max(a, b)), size);
        if (!(first.x < last.x && first.y < last.y)) {
            diagnostics.fail(part->place, fmt::format("found {} without a pixel in it", name));
            return;
        }
        film.part = PicturePart{film.size,
                                uint32_t(first.x),
                                uint32_t(first.y),
                                {uint32_t(last.x - first.x), uint32_t(last.y - first.y)}};
        film.has_size = true;
    }
}

} // namespace

Film read_film(const Parameters& parameters, bool is_v4, Diagnostics& diagnostics) {
    Film film;
    film.has_size = is_v4 || (parameters.find("xresolution") && parameters.find("yresolution"));
    film.size = {side_of(parameters, "xresolution", is_v4 ? 1280 : 640, diagnostics),
                 side_of(parameters, "yresolution", is_v4 ? 720 : 480, diagnostics)};
    take_part(parameters, film, diagnostics);
    // v3 scales what it writes; v4 exposes for some time at some sensitivity.
    const double scale = parameters.number("scale", 1);
    const double exposed =
        parameters.number("exposuretime", 1) * parameters.number("iso", 100) / 100;
    const double exposure = scale * exposed;
    film.exposure = vec3(exposure > 1e-30 && exposure < 1e30 ? float(exposure) : 1);
    if (const double kelvin = is_v4 ? parameters.number("whitebalance", 0) : 0; kelvin > 0)
        film.exposure *= white_balance(kelvin);
    return film;
}

namespace {

/// The part of the plane z = 1 that the image shows, before the angle of view, with x to the right.
struct Screen {
    double left, right, bottom, top;
};

Screen screen_of(const Parameters& p, const Film& film) {
    const double aspect =
        p.number("frameaspectratio", double(film.size.width) / double(film.size.height));
    Screen screen =
        aspect > 1 ? Screen{-aspect, aspect, -1, 1} : Screen{-1, 1, -1 / aspect, 1 / aspect};
    const Parameter* const window = p.find("screenwindow", {Kind::Float, Kind::Integer});
    if (!window)
        return screen;
    window->wants = 4;
    const std::vector<double>& n = window->numbers;
    return n.size() == 4 ? Screen{n[0], n[1], n[2], n[3]} : screen;
}

bool is_orthographic(const CameraRequest& request) {
    return request.type == "orthographic";
}

/// v4 calls it spherical, and earlier versions environment.
bool is_spherical(const CameraRequest& request) {
    return request.type == "spherical" || request.type == "environment";
}

double angle_of_view(const CameraRequest& request) {
    const Parameters& p = request.parameters;
    return p.find("halffov") ? 2 * p.number("halffov", 45) : p.number("fov", 90);
}

/// Returns nothing for a camera in which everything is sharp. A ray's direction is 1 long along the
/// view, so that t is the distance there.
std::optional<Lens> lens_of(const Parameters& p, const dmat4& to_world) {
    const double radius = p.number("lensradius", 0), focus = p.number("focaldistance", 1e6);
    if (!(radius > 0 && focus > 0 && std::isfinite(radius) && focus <= 1e100))
        return std::nullopt;
    return Lens{vector_through(to_world, {radius, 0, 0}), vector_through(to_world, {0, radius, 0}),
                focus};
}

/// Returns the camera that sees all around: the y axis is at the top, x at the left and right edge
/// and z a quarter from the left.
Camera spherical_camera(const CameraRequest& request, Diagnostics& diagnostics) {
    const char* const usual = request.type == "spherical" ? "equalarea" : "equirectangular";
    if (request.parameters.text("mapping", usual) != "equirectangular")
        diagnostics.approximate(
            "mapping", request.place,
            "a camera 'spherical' of equal areas becomes an equirectangular one");
    const dmat4 to_world = glm::inverse(request.world_to_camera);
    ImageWindow window;
    window.bend = ImageWindow::Bend::Spherical;
    window.direction = vector_through(to_world, {-1, 0, 0});
    window.right = vector_through(to_world, {0, 0, -1});
    window.up = vector_through(to_world, {0, 1, 0});
    window.angle = 360;
    window.vertical_angle = 180;
    Camera camera;
    camera.eye = point_through(to_world, dvec3(0));
    camera.target = camera.eye + window.direction;
    camera.up = window.up;
    camera.fov_degrees = 90;
    // The window turns around its axes, which turns a mirrored picture upside down.
    if (glm::dot(glm::cross(window.right, window.up), window.direction) < 0) {
        window.right = -window.right;
        window.up = -window.up;
    }
    camera.window = window;
    return camera;
}

/// Returns the camera of a flat picture.
Camera flat_camera(const CameraRequest& request, const Film& film) {
    const bool orthographic = is_orthographic(request);
    const double angle = angle_of_view(request);
    const Screen screen = screen_of(request.parameters, film);
    const double tangent = orthographic ? 1 : std::tan(angle * (std::numbers::pi / 360));
    const dmat4 to_world = glm::inverse(request.world_to_camera);
    const double x = tangent * (screen.left + screen.right) / 2;
    const double y = tangent * (screen.bottom + screen.top) / 2;
    Camera camera;
    camera.window = ImageWindow{
        vector_through(to_world, {orthographic ? 0 : x, orthographic ? 0 : y, 1}),
        vector_through(to_world, {tangent * (screen.right - screen.left), 0, 0}),
        vector_through(to_world, {0, tangent * (screen.top - screen.bottom), 0}), orthographic};
    if (!request.parameters.find("screenwindow") && !request.parameters.find("frameaspectratio"))
        camera.window->shape = film.size.width / double(film.size.height);
    camera.eye = point_through(to_world, orthographic ? dvec3(x, y, 0) : dvec3(0));
    camera.target = camera.eye + camera.window->direction;
    camera.up = camera.window->up;
    camera.fov_degrees = angle;
    camera.lens = lens_of(request.parameters, to_world);
    return camera;
}

bool is_usable(const Camera& camera) {
    const ImageWindow& w = *camera.window;
    return ovc::is_finite(camera.eye) && ovc::is_finite(w.direction) && ovc::is_finite(w.right) &&
           ovc::is_finite(w.up) && glm::length(glm::cross(w.right, w.up)) > 0 &&
           std::abs(glm::dot(glm::cross(w.right, w.up), w.direction)) > 0;
}

} // namespace

double time_of_exposure(const CameraRequest& request, Diagnostics& diagnostics) {
    const Parameters& p = request.parameters;
    const double time = p.number("shutterclose", 1) - p.number("shutteropen", 0);
    if (time > 1e-30 && time < 1e30)
        return time;
    diagnostics.missing("shutter", request.place,
                        "the shutter left out: its times leave it closed");
    return 1;
}

bool check_camera(const CameraRequest& request, Diagnostics& diagnostics) {
    const double angle = angle_of_view(request);
    if (is_orthographic(request) || is_spherical(request) || (angle > 0 && angle < 180))
        return true;
    return diagnostics.fail(
        request.place,
        fmt::format("found an angle of view of {}, expected more than 0 and less than 180", angle));
}

std::optional<Camera> make_camera(const CameraRequest& request, const Film& film,
                                  Diagnostics& diagnostics) {
    assert(film.size.width > 0 && film.size.height > 0);
    const bool is_known =
        is_orthographic(request) || is_spherical(request) || request.type == "perspective";
    if (!is_known)
        diagnostics.approximate(
            "camera", request.place,
            fmt::format("a camera {} becomes a perspective one", ovc::quoted(request.type)));
    const Camera camera =
        is_spherical(request) ? spherical_camera(request, diagnostics) : flat_camera(request, film);
    if (is_known)
        tell_left_over(request.parameters, "cameras", request.type, diagnostics);
    if (is_usable(camera))
        return camera;
    diagnostics.missing("view", request.place, "the camera left out: its transform makes no view");
    return std::nullopt;
}

} // namespace ovc::pbrt
