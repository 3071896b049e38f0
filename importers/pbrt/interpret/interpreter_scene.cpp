// SPDX-License-Identifier: Apache-2.0
// The interpreter's directives of shapes, materials, lights and the camera.
#include "importers/pbrt/interpret/interpreter.h"

#include "importers/file/text.h"
#include "importers/pbrt/look/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

bool Interpreter::shape() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    const uint64_t left = options_.max_triangles - std::min(options_.max_triangles, triangles_);
    ShapeRequest request{type,
                         parameters,
                         place_,
                         tokens_,
                         diagnostics_,
                         left,
                         options_.tolerance.value_or(kTolerance)};
    std::optional<Mesh> mesh = make_shape(request);
    if (diagnostics_.failed())
        return false;
    const bool is_hidden =
        !textures_.is_pattern(parameters, "alpha") && textures_.number(parameters, "alpha", 1) == 0;
    if (!mesh || is_hidden)
        return true;
    return add_shape(std::move(*mesh));
}

bool Interpreter::add_shape(Mesh mesh) {
    const GraphicsState& now = state_.now;
    if (!now.emission && is_invisible(materials_.all()[now.material]))
        return true; // no ray sees it
    triangles_ += mesh.size();
    if (triangles_ > options_.max_triangles)
        return diagnostics_.fail(
            place_, fmt::format("found {} triangles so far, expected at most {}; --max-triangles "
                                "allows more",
                                triangles_, options_.max_triangles));
    Shape shape{std::move(mesh), now.transforms.start(), now.material, now.reversed};
    if (now.emission && building_.empty()) {
        shape.material =
            materials_.emitter(now.material, now.emission->radiance, now.emission->two_sided);
        lights_.add_area(shape, *now.emission);
    } else if (now.emission) {
        diagnostics_.approximate("emitting objects", place_, "emission of instances left out");
    }
    object().shapes.push_back(std::move(shape));
    return true;
}

bool Interpreter::material() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    state_.now.material = materials_.make(type, parameters, place_);
    return true;
}

bool Interpreter::make_named_material() {
    std::string name;
    Parameters parameters;
    if (!read_typed(name, parameters))
        return false;
    materials_.define(name, parameters, place_);
    return true;
}

bool Interpreter::named_material() {
    std::string name;
    Parameters parameters;
    if (!read_typed(name, parameters))
        return false;
    state_.now.material = materials_.named(name, place_);
    return true;
}

bool Interpreter::texture() {
    std::string name, value, type;
    Parameters parameters;
    if (!read_text(name) || !read_text(value) || !read_typed(type, parameters))
        return false;
    textures_.define(name, type, parameters, place_);
    return true;
}

bool Interpreter::light_source() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    lights_.add(type, parameters, state_.now.transforms.start(), place_);
    return true;
}

bool Interpreter::area_light_source() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    if (type == "none")
        state_.now.emission.reset();
    else if (type == "diffuse" || type == "area")
        state_.now.emission = lights_.emission(parameters);
    else
        diagnostics_.missing("area light " + type, place_,
                             fmt::format("area lights {} left out", ovc::quoted(type)));
    return true;
}

bool Interpreter::camera() {
    CameraRequest request;
    if (!read_typed(request.type, request.parameters))
        return false;
    request.world_to_camera = state_.now.transforms.start();
    request.place = place_;
    Transforms to_world = state_.now.transforms;
    for (dmat4& m : to_world.at)
        m = glm::inverse(m);
    systems_["camera"] = to_world;
    camera_ = std::move(request);
    return true;
}

bool Interpreter::film() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    film_ = read_film(parameters);
    return true;
}

bool Interpreter::medium() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    diagnostics_.approximate("medium", place_, "fog, smoke and other media left out");
    return true;
}

bool Interpreter::medium_interface() {
    return pass_over();
}

bool Interpreter::setting() {
    std::string type;
    Parameters parameters;
    return read_typed(type, parameters);
}

bool Interpreter::bare_setting() {
    return pass_over();
}

void Interpreter::fill(Scene& scene) {
    assert(at_end_);
    scene.materials = materials_.take();
    if (film_.has_size)
        scene.size = film_.size;
    if (camera_)
        scene.camera = make_camera(*camera_, film_, diagnostics_);
    lights_.finish(scene.camera ? scene.camera->up : dvec3(0, 1, 0), scene);
    expose(scene, film_.exposure);
}

} // namespace ovc::pbrt
