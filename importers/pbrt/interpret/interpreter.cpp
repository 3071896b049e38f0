// SPDX-License-Identifier: Apache-2.0
// The interpreter's table of directives, its arguments, and the directives of scopes, objects and
// files.
#include "importers/pbrt/interpret/interpreter.h"

#include "importers/file/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

/// The max depth of AttributeBegin and its like; scenes have a few dozen levels.
static constexpr size_t kDeepestScope = 10000;

const Interpreter::Directive Interpreter::kDirectives[] = {
    {"Accelerator", &Interpreter::setting},
    {"ActiveTransform", &Interpreter::active_transform},
    {"AreaLightSource", &Interpreter::area_light_source},
    {"Attribute", &Interpreter::attribute},
    {"AttributeBegin", &Interpreter::attribute_begin},
    {"AttributeEnd", &Interpreter::attribute_end},
    {"Camera", &Interpreter::camera},
    {"ColorSpace", &Interpreter::color_space},
    {"ConcatTransform", &Interpreter::concatenate},
    {"CoordSysTransform", &Interpreter::coord_sys_transform},
    {"CoordinateSystem", &Interpreter::coordinate_system},
    {"Film", &Interpreter::film},
    {"Identity", &Interpreter::identity},
    {"Import", &Interpreter::import},
    {"Include", &Interpreter::include},
    {"Integrator", &Interpreter::setting},
    {"LightSource", &Interpreter::light_source},
    {"LookAt", &Interpreter::look_at},
    {"MakeNamedMaterial", &Interpreter::make_named_material},
    {"MakeNamedMedium", &Interpreter::make_named_medium},
    {"Material", &Interpreter::material},
    {"MediumInterface", &Interpreter::medium_interface},
    {"NamedMaterial", &Interpreter::named_material},
    {"ObjectBegin", &Interpreter::object_begin},
    {"ObjectEnd", &Interpreter::object_end},
    {"ObjectInstance", &Interpreter::object_instance},
    {"Option", &Interpreter::bare_setting},
    {"PixelFilter", &Interpreter::setting},
    {"Renderer", &Interpreter::setting},
    {"ReverseOrientation", &Interpreter::reverse_orientation},
    {"Rotate", &Interpreter::rotate},
    {"Sampler", &Interpreter::setting},
    {"Scale", &Interpreter::scale},
    {"SearchPath", &Interpreter::setting},
    {"Shape", &Interpreter::shape},
    {"SurfaceIntegrator", &Interpreter::setting},
    {"Texture", &Interpreter::texture},
    {"Transform", &Interpreter::set_transform},
    {"TransformBegin", &Interpreter::transform_begin},
    {"TransformEnd", &Interpreter::transform_end},
    {"TransformTimes", &Interpreter::bare_setting},
    {"Translate", &Interpreter::translate},
    {"Volume", &Interpreter::medium},
    {"VolumeIntegrator", &Interpreter::setting},
    {"WorldBegin", &Interpreter::world_begin},
    {"WorldEnd", &Interpreter::world_end},
};

bool Interpreter::run() {
    assert(!at_end_); // not run before
    systems_["world"] = {};
    while (!at_end_)
        if (!directive() || diagnostics_.failed())
            return false;
    if (options_.world > 1 && worlds_ < options_.world)
        return diagnostics_.fail(tokens_.place(),
                                 fmt::format("found {}, expected {}, for --world asks for it",
                                             counted(worlds_, "world"), options_.world));
    if (state_.depth() > 0)
        diagnostics_.missing(
            "unclosed", tokens_.place(),
            fmt::format("the file ends inside {} AttributeBegin or its like", state_.depth()));
    if (!building_.empty())
        diagnostics_.missing("unclosed object", tokens_.place(),
                             fmt::format("the object {} left out: the file ends inside it",
                                         ovc::quoted(building_.back().name)));
    return bind_late_instances() && !diagnostics_.failed();
}

bool Interpreter::directive() {
    if (!tokens_.next())
        return false;
    const Token& token = tokens_.token();
    place_ = token.place;
    if (token.kind == TokenKind::End) {
        at_end_ = true;
        return true;
    }
    if (token.kind == TokenKind::ImportEnd)
        return end(Scope::Import, "Import");
    if (token.kind != TokenKind::Word)
        return diagnostics_.fail(
            place_, fmt::format("found {}, expected a directive such as Shape", described(token)));
    if (passing_over_)
        return pass_over(std::string(token.text));
    const auto at = std::find_if(std::begin(kDirectives), std::end(kDirectives),
                                 [&](const Directive& d) { return d.name == token.text; });
    if (at == std::end(kDirectives))
        return unknown(std::string(token.text));
    known_one_ = true;
    return (this->*at->action)();
}

/// Follows includes, because an included file may hold the next world.
bool Interpreter::pass_over(std::string_view name) {
    if (name == "WorldBegin")
        return world_begin();
    if (name == "WorldEnd")
        return world_end();
    if (name == "Include")
        return include();
    if (worlds_ >= options_.world &&
        (name == "Shape" || name == "LightSource" || name == "ObjectInstance"))
        diagnostics_.missing("after world", place_, "what follows WorldEnd left out");
    return pass_over();
}

bool Interpreter::unknown(const std::string& name) {
    assert(!name.empty());
    const bool looks_like_one =
        name[0] >= 'A' && name[0] <= 'Z' && std::all_of(name.begin(), name.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        });
    if (!known_one_ || !looks_like_one)
        return diagnostics_.fail(
            place_, fmt::format("found {}, expected a directive such as Shape", ovc::quoted(name)));
    diagnostics_.missing("directive " + name, place_,
                         fmt::format("directives {} left out", ovc::quoted(name)));
    return pass_over();
}

bool Interpreter::pass_over() {
    for (;;) {
        if (!tokens_.next())
            return false;
        const Token& token = tokens_.token();
        const bool is_truth = token.text == "true" || token.text == "false";
        if (token.kind == TokenKind::End || token.kind == TokenKind::ImportEnd ||
            (token.kind == TokenKind::Word && !is_truth)) {
            tokens_.again();
            return true;
        }
    }
}

/// Reads `count` numbers, in brackets or not.
bool Interpreter::read_numbers(size_t count, double* to) {
    bool in_brackets = false;
    for (size_t i = 0; i < count;) {
        if (!tokens_.next())
            return false;
        const Token& token = tokens_.token();
        if (token.kind == TokenKind::Open && i == 0 && !in_brackets)
            in_brackets = true;
        else if (token.kind == TokenKind::Number)
            to[i++] = token.number;
        else
            return diagnostics_.fail(token.place, fmt::format("found {}, expected number {} of {}",
                                                              described(token), i + 1, count));
    }
    if (!in_brackets)
        return true;
    if (!tokens_.next())
        return false;
    return tokens_.token().kind == TokenKind::Close ||
           diagnostics_.fail(tokens_.token().place,
                             fmt::format("found {}, expected ']' after {} numbers",
                                         described(tokens_.token()), count));
}

bool Interpreter::read_text(std::string& to) {
    if (!tokens_.next())
        return false;
    if (tokens_.token().kind != TokenKind::Text)
        return diagnostics_.fail(
            tokens_.token().place,
            fmt::format("found {}, expected a name in quotes", described(tokens_.token())));
    to = tokens_.token().text;
    return true;
}

bool Interpreter::read_typed(std::string& type, Parameters& parameters, std::string_view of) {
    if (!read_text(type) || !parameters.read(tokens_, diagnostics_))
        return false;
    parameters.take_colors_through(state_.now.to_srgb);
    if (!state_.now.defaults || of.empty())
        return true;
    std::vector<Parameter> defaults;
    for (const Default& one : *state_.now.defaults)
        if (one.of == of)
            defaults.push_back(one.parameter);
    parameters.put_first(std::move(defaults));
    return true;
}

bool Interpreter::begin(Scope scope) {
    if (state_.depth() >= kDeepestScope)
        return diagnostics_.fail(
            place_, fmt::format("found more than {} levels in each other", kDeepestScope));
    state_.now.names = {textures_.begin_scope(), alphas_.begin_scope(), materials_.begin_scope()};
    state_.push(scope);
    return true;
}

bool Interpreter::end(Scope scope, std::string_view name) {
    if (!state_.pop(scope))
        diagnostics_.missing("unmatched " + std::string(name), place_,
                             fmt::format("{} without a beginning left out", name));
    else if (scope != Scope::Transform)
        end_names(state_.now.names);
    return true;
}

void Interpreter::end_names(const GraphicsState::Names& begin) {
    alphas_.end_scope(begin.alphas);
    textures_.end_scope(begin.textures);
    materials_.end_scope(begin.materials);
}

bool Interpreter::attribute_begin() {
    return begin(Scope::Attribute);
}

bool Interpreter::attribute_end() {
    return end(Scope::Attribute, "AttributeEnd");
}

bool Interpreter::transform_begin() {
    return begin(Scope::Transform);
}

bool Interpreter::transform_end() {
    return end(Scope::Transform, "TransformEnd");
}

bool Interpreter::reverse_orientation() {
    state_.now.reversed = !state_.now.reversed;
    return true;
}

bool Interpreter::object_begin() {
    std::string name;
    if (!read_text(name) || !begin(Scope::Object))
        return false;
    building_.push_back({std::move(name), {}, {}});
    return true;
}

bool Interpreter::object_end() {
    if (building_.empty())
        return end(Scope::Object, "ObjectEnd");
    end(Scope::Object, "ObjectEnd");
    // An older object of that name stays for the instances that it has.
    object_ids_[building_.back().name] = uint32_t(world_.objects.size());
    world_.objects.push_back(std::move(building_.back()));
    building_.pop_back();
    return true;
}

bool Interpreter::object_instance() {
    std::string name;
    if (!read_text(name))
        return false;
    const dmat4 place = now_at(state_.now.transforms);
    const auto at = object_ids_.find(name);
    if (at != object_ids_.end())
        object().instances.push_back({at->second, place});
    else if (building_.empty())
        late_.push_back({std::move(name), place, place_});
    else
        diagnostics_.missing("object " + name, place_,
                             fmt::format("there is no object {} yet", ovc::quoted(name)));
    return true;
}

/// v4 looks for objects only after it has read the file.
bool Interpreter::bind_late_instances() {
    for (const LateInstance& late : late_) {
        const auto at = object_ids_.find(late.name);
        if (at != object_ids_.end())
            world_.top.instances.push_back({at->second, late.place});
        else
            diagnostics_.missing("object " + late.name, late.where,
                                 fmt::format("there is no object {}", ovc::quoted(late.name)));
    }
    return true;
}

bool Interpreter::include() {
    return tokens_.include_next(/* marks_its_end= */ false);
}

/// Changes that an import makes to the state end with it.
bool Interpreter::import() {
    const size_t depth = tokens_.depth();
    if (!tokens_.include_next(/* marks_its_end= */ true))
        return false;
    return tokens_.depth() == depth || begin(Scope::Import);
}

bool Interpreter::world_begin() {
    ++worlds_;
    if (worlds_ > options_.world) {
        diagnostics_.missing("second world", place_,
                             fmt::format("all but world {} of the file left out; --world N reads "
                                         "another",
                                         options_.world));
        at_end_ = true;
        return true;
    }
    passing_over_ = worlds_ < options_.world;
    state_.now.transforms = {};
    systems_["world"] = {};
    return true;
}

/// The graphics state ends with the world; camera and film stay, as in pbrt-v2.
bool Interpreter::world_end() {
    world_ended_ = true;
    if (state_.depth() > 0)
        diagnostics_.missing(
            "unclosed", place_,
            fmt::format("the world ends inside {} AttributeBegin or its like", state_.depth()));
    state_.clear();
    state_.now = {};
    passing_over_ = worlds_ >= options_.world;
    return true;
}

} // namespace ovc::pbrt
