// SPDX-License-Identifier: Apache-2.0
// The interpreter's directives of shapes, materials, lights and the camera.
#include "importers/pbrt/interpret/interpreter.h"

#include "importers/file/text.h"
#include "importers/pbrt/interpret/color_space.h"
#include "importers/pbrt/interpret/left_over.h"
#include "importers/pbrt/interpret/motion.h"
#include "importers/pbrt/look/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

/// The max number of values that Attribute may hand to every directive of a kind.
static constexpr size_t kMaxDefaults = 1000;

static size_t values_of(const Parameter& parameter) {
    return 1 + parameter.numbers.size() + parameter.strings.size();
}

bool Interpreter::shape() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters, "shape"))
        return false;
    const std::optional<Sight> sight = sight_of(parameters);
    const uint64_t left = options_.max_triangles - std::min(options_.max_triangles, triangles_);
    ShapeRequest request{type,
                         parameters,
                         place_,
                         tokens_,
                         diagnostics_,
                         left,
                         options_.tolerance.value_or(kTolerance),
                         sight && sight->wants_uv};
    // Objects, holes and area lights need triangles at hand.
    if (streamed_ && building_.empty() && !state_.now.emission && !request.wants_uv)
        request.streaming = options_.streaming;
    std::optional<Mesh> mesh = make_shape(request);
    if (diagnostics_.failed())
        return false;
    if (!mesh || !sight)
        return true;
    tell_left_over(parameters, "shapes", type, diagnostics_);
    return add_shape(std::move(*mesh), *sight);
}

std::optional<Sight> Interpreter::sight_of(const Parameters& parameters) {
    if (is_invisible(materials_.all()[state_.now.material])) {
        if (!state_.now.emission)
            return std::nullopt;
        if (textures_.is_v4()) { // it says the same
            diagnostics_.approximate("emitting interface", place_,
                                     "shapes of the material 'interface' emit no light");
            return std::nullopt;
        }
    }
    const Alpha alpha = alphas_.of(parameters, "alpha");
    if (alpha.is_zero) // an emitter still shines
        return state_.now.emission && building_.empty()
                   ? std::optional(Sight{.seen_by = kSeenByNone})
                   : std::nullopt;
    const Alpha shadow = alphas_.of(parameters, "shadowalpha");
    Sight sight{alpha.cutout, shadow.cutout};
    const uint32_t material = state_.now.material;
    if (sight.cutout == kNone && !state_.now.emission)
        sight.cutout = alphas_.of_texture(materials_.holes(material));
    sight.wants_uv = sight.cutout != kNone || sight.shadow_cutout != kNone ||
                     (state_.now.emission ? state_.now.emission->picture.has_value()
                                          : materials_.wants_uv(material));
    if (shadow.is_zero)
        sight.seen_by &= ~uint32_t(kShadowsAll);
    if (state_.now.emission && building_.empty()) // the lights that stand for it lie in it
        sight.seen_by &= ~uint32_t(kShadowsStandIns);
    return sight;
}

dmat4 Interpreter::now_at(const Transforms& transforms) {
    moves_ = moves_ || transforms.move();
    if (transforms.move() && !options_.moment.in_sequence)
        diagnostics_.approximate("motion", place_,
                                 "motion left out: things stand where they are at the start; "
                                 "--frames shows them move");
    return between(transforms.at[0], transforms.at[1], options_.moment.clock);
}

bool Interpreter::add_shape(Mesh mesh, const Sight& sight) {
    const GraphicsState& now = state_.now;
    triangles_ += mesh.size();
    if (triangles_ > options_.max_triangles)
        return diagnostics_.fail(
            place_, fmt::format("found {} triangles so far, expected at most {}; --max-triangles "
                                "allows more",
                                triangles_, options_.max_triangles));
    Shape shape{std::move(mesh), now_at(now.transforms), now.material, now.reversed, sight};
    if (now.absorbed_inside && is_clear(materials_.all()[now.material]))
        shape.material = materials_.filled(now.material, *now.absorbed_inside);
    else if (now.absorbed_inside)
        tell_media();
    if (now.emission && building_.empty()) {
        const vec3 radiance = radiance_of(*now.emission, shape);
        shape.material = materials_.emitter(now.material, *now.emission, radiance, place_);
        lights_.add_area(shape, radiance, now.emission->two_sided);
    } else if (now.emission) {
        diagnostics_.approximate("emitting objects", place_, "emission of instances left out");
    }
    return store(std::move(shape));
}

bool Interpreter::store(Shape shape) {
    const bool is_of_world = building_.empty();
    if (streamed_) {
        const Result<Done> fine =
            is_of_world ? streamed_->add(shape, place_) : streamed_->keep(shape, place_);
        if (!fine)
            return diagnostics_.fail(fine.error());
    }
    if (streamed_ && is_of_world)
        world_.top.streamed = streamed_->triangles();
    else
        object().shapes.push_back(std::move(shape));
    return true;
}

bool Interpreter::material() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters, "material"))
        return false;
    state_.now.material = materials_.make(type, parameters, place_);
    tell_material(parameters, type);
    return true;
}

bool Interpreter::make_named_material() {
    std::string name;
    Parameters parameters;
    if (!read_typed(name, parameters, "material"))
        return false;
    materials_.define(name, parameters, place_);
    tell_material(parameters, parameters.text("type"));
    return true;
}

/// Says what a material has that is not shown.
void Interpreter::tell_material(const Parameters& parameters, std::string_view type) {
    textures_.tell_means(parameters);
    tell_left_over(parameters, "materials", type, diagnostics_);
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
    if (!read_text(name) || !read_text(value) || !read_typed(type, parameters, "texture"))
        return false;
    const bool is_float = value == "float";
    if (is_float)
        alphas_.define(name, type, parameters, place_);
    textures_.define(
        name, {type, std::move(parameters), place_, now_at(state_.now.transforms), is_float});
    return true;
}

bool Interpreter::light_source() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters, "light"))
        return false;
    if (lights_.add(type, parameters, now_at(state_.now.transforms), place_))
        tell_left_over(parameters, "lights", type, diagnostics_);
    return true;
}

bool Interpreter::area_light_source() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters, "light"))
        return false;
    if (type == "none")
        state_.now.emission.reset();
    else if (type == "diffuse" || type == "area") {
        state_.now.emission = lights_.emission(parameters, place_);
        tell_left_over(parameters, "area lights", type, diagnostics_);
    } else
        diagnostics_.missing("area light " + type, place_,
                             fmt::format("area lights {} left out", ovc::quoted(type)));
    return true;
}

bool Interpreter::camera() {
    CameraRequest request;
    if (!read_typed(request.type, request.parameters))
        return false;
    request.place = place_;
    Transforms to_world = state_.now.transforms;
    for (dmat4& m : to_world.at)
        m = glm::inverse(m);
    systems_["camera"] = to_world;
    // As in pbrt, the camera moves in the world, not the world before the camera.
    request.world_to_camera = to_world.move() && options_.moment.clock > 0
                                  ? glm::inverse(now_at(to_world))
                                  : now_at(state_.now.transforms);
    camera_ = std::move(request);
    return check_camera(*camera_, diagnostics_);
}

bool Interpreter::film() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters))
        return false;
    // No earlier version has these.
    const bool is_v4 = type == "rgb" || type == "gbuffer" || type == "spectral";
    film_ = read_film(parameters, is_v4, diagnostics_);
    if (is_v4)
        textures_.read_as_v4();
    tell_left_over(parameters, "films", type, diagnostics_);
    return true;
}

bool Interpreter::color_space() {
    std::string name;
    if (!read_text(name))
        return false;
    if (const auto to_srgb = color_space_of(name))
        state_.now.to_srgb = *to_srgb;
    else
        diagnostics_.missing("color space " + name, place_,
                             fmt::format("the color space {} left out", ovc::quoted(name)));
    return true;
}

bool Interpreter::medium() {
    std::string type;
    Parameters parameters;
    if (!read_typed(type, parameters, "medium"))
        return false;
    tell_media();
    return true;
}

void Interpreter::tell_media() {
    diagnostics_.approximate("medium", place_, "fog, smoke and other media left out");
}

/// Glass may be filled with a medium that scatters nothing; all others are left out.
bool Interpreter::make_named_medium() {
    std::string name;
    Parameters parameters;
    if (!read_typed(name, parameters, "medium"))
        return false;
    const auto color = [&](const char* of, const vec3& otherwise) {
        return textures_.color(parameters, of, otherwise) * float(parameters.number("scale", 1));
    };
    const vec3 absorbed = color("sigma_a", {0.0011f, 0.0024f, 0.014f});
    const bool scatters = color("sigma_s", {2.55f, 3.21f, 3.77f}) != vec3(0);
    if (parameters.text("type") == "homogeneous" && !scatters && max_component(absorbed) > 0 &&
        !parameters.find("Le") && !parameters.find("preset"))
        absorbing_[name] = glm::max(absorbed, vec3(0));
    else
        tell_media();
    return true;
}

/// Names the media inside and outside of the shapes that follow; one name is that of both.
bool Interpreter::medium_interface() {
    std::string inside;
    if (!read_text(inside))
        return false;
    std::string outside = inside;
    if (!tokens_.next())
        return false;
    if (tokens_.token().kind == TokenKind::Text)
        outside = tokens_.token().text;
    else
        tokens_.again();
    const auto found = absorbing_.find(inside);
    state_.now.absorbed_inside =
        found != absorbing_.end() ? std::optional(found->second) : std::nullopt;
    if (absorbing_.contains(outside))
        tell_media();
    return true;
}

bool Interpreter::setting() {
    std::string type;
    Parameters parameters;
    return read_typed(type, parameters);
}

bool Interpreter::bare_setting() {
    return pass_over();
}

/// Keeps parameters for later directives, not every one of which has a use for them.
bool Interpreter::attribute() {
    std::string of;
    Parameters parameters;
    if (!read_typed(of, parameters))
        return false;
    static constexpr std::string_view kKinds[] = {"shape", "light", "material", "medium",
                                                  "texture"};
    if (std::ranges::find(kKinds, of) == std::end(kKinds)) {
        diagnostics_.missing("Attribute " + of, place_,
                             fmt::format("defaults of {} left out", ovc::quoted(of)));
        return true;
    }
    const auto& now = state_.now.defaults;
    std::vector<Default> defaults = now ? *now : std::vector<Default>();
    size_t values = 0;
    for (const Default& one : defaults)
        values += values_of(one.parameter);
    for (Parameter& parameter : parameters.all()) {
        values += values_of(parameter);
        if (values > kMaxDefaults)
            return diagnostics_.fail(place_, fmt::format("found more than {} values of defaults "
                                                         "by Attribute",
                                                         kMaxDefaults));
        parameter.asked = true;
        const auto is_old = [&](const Default& old) {
            return old.of == of && old.parameter.name == parameter.name &&
                   old.parameter.kind == parameter.kind;
        };
        std::erase_if(defaults, is_old);
        defaults.push_back({of, std::move(parameter)});
    }
    state_.now.defaults = std::make_shared<const std::vector<Default>>(std::move(defaults));
    return true;
}

void Interpreter::fill(Scene& scene) {
    assert(at_end_);
    scene.moves = moves_;
    scene.materials = materials_.take();
    scene.cutouts = alphas_.take(/* partial= */ !world_ended_);
    textures_.take(scene);
    if (film_.has_size)
        scene.size = film_.size;
    scene.part = film_.part;
    if (camera_ && textures_.is_v4())
        film_.exposure *= float(time_of_exposure(*camera_, diagnostics_));
    if (camera_)
        scene.camera = make_camera(*camera_, film_, diagnostics_);
    lights_.finish(scene.camera ? scene.camera->up : dvec3(0, 1, 0), scene);
    expose(scene, film_.exposure);
}

} // namespace ovc::pbrt
