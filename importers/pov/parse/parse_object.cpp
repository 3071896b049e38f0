// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_object.h"

#include "importers/file/text.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <unordered_map>
#include <unordered_set>

namespace ovc::pov {

namespace {

/// The size of an object and its shape without lists such as a polygon's points.
constexpr uint64_t kObjectBytes = 1000;

using ParseShape = Shape (*)(Reader&);
const std::unordered_map<std::string_view, ParseShape> kShapes = {
    {"sphere", parse_sphere},
    {"box", parse_box},
    {"cylinder", parse_cylinder},
    {"cone", parse_cone},
    {"torus", parse_torus},
    {"disc", parse_disc},
    {"triangle", parse_triangle},
    {"smooth_triangle", parse_smooth_triangle},
    {"polygon", parse_polygon},
    {"prism", parse_prism},
    {"lathe", parse_lathe},
    {"sor", parse_sor},
    {"ovus", parse_ovus},
    {"superellipsoid", parse_superellipsoid},
    {"bicubic_patch", parse_bicubic_patch},
    {"text", parse_text_shape},
    {"height_field", parse_height_field},
    {"julia_fractal", parse_julia_fractal},
    {"parametric", parse_parametric},
    {"sphere_sweep", parse_sphere_sweep}};

/// Shapes that have no inside.
const std::unordered_set<std::string_view> kSheets = {"disc",    "triangle",      "smooth_triangle",
                                                      "polygon", "bicubic_patch", "parametric"};

using ParseWhole = void (*)(Reader&, Object&);
void parse_plane(Reader& reader, Object& object);
void parse_group(Reader& reader, Object& object);
void parse_wrapped(Reader& reader, Object& object);
void parse_refused(Reader& reader, Object& object);

const std::unordered_map<std::string_view, ParseWhole> kWholes = {
    {"plane", parse_plane},
    {"mesh", parse_mesh},
    {"mesh2", parse_mesh2},
    {"light_source", parse_light_source},
    {"object", parse_wrapped},
    {"union", parse_group},
    {"merge", parse_group},
    {"difference", parse_group},
    {"intersection", parse_group},
    {"light_group", parse_group},
    {"blob", parse_blob},
    {"cubic", parse_polynomial},
    {"isosurface", parse_isosurface},
    {"poly", parse_polynomial},
    {"polynomial", parse_refused},
    {"quadric", parse_quadric},
    {"quartic", parse_polynomial}};

void parse_plane(Reader& reader, Object& object) {
    PlaneShape plane;
    plane.normal = parse_vector(reader);
    reader.take_comma();
    const double length = glm::length(plane.normal);
    if (!(length > 0))
        reader.fail(reader.place(), "found a plane whose normal is 0");
    plane.normal /= length;
    plane.distance = parse_float(reader);
    object.shape = plane;
    parse_modifiers(reader, object);
}

void parse_children(Reader& reader, Object& object) {
    for (;;) {
        const Token token = reader.peek();
        if (starts_object(token))
            object.children.push_back(parse_object(reader));
        else if (auto named_object = take_named_if<ObjectPtr>(reader))
            object.children.push_back(std::move(*named_object));
        else if (!reader.take(';'))
            return;
    }
}

void parse_group(Reader& reader, Object& object) {
    parse_children(reader, object);
    parse_modifiers(reader, object);
}

/// Reads object { sphere { … } … }. parse_object reads object { NAME … }.
void parse_wrapped(Reader& reader, Object& object) {
    if (!starts_object(reader.peek()))
        reader.fail_here("an object or the name of one");
    const ObjectPtr inside = parse_object(reader);
    const Place at = object.place;
    const Caller caller = object.caller;
    object = *inside;
    object.place = at;
    object.caller = caller;
    parse_modifiers(reader, object);
}

/// Moves copies of the objects, which other objects may share.
void place_all(std::vector<ObjectPtr>& objects, const dmat4& by) {
    for (ObjectPtr& object : objects) {
        auto moved = std::make_shared<Object>(*object);
        place(*moved, by);
        object = std::move(moved);
    }
}

/// Reads clipped_by { objects transformations } or clipped_by { bounded_by }, or the same for
/// bounded_by.
void parse_bounds(Reader& reader, Object& object, std::string_view what) {
    assert(what == "clipped_by" || what == "bounded_by");
    std::vector<ObjectPtr>& list = what == "clipped_by" ? object.clips : object.bounds;
    reader.expect('{', what);
    Object holder;
    if (reader.take("bounded_by"))
        list = object.bounds;
    else if (reader.take("clipped_by"))
        list = object.clips;
    else
        parse_children(reader, holder);
    while (const auto by = take_transform(reader))
        place_all(holder.children, *by);
    list.insert(list.end(), holder.children.begin(), holder.children.end());
    reader.expect('}', what);
}

void parse_refused(Reader& reader, Object& object) {
    object.refused = fmt::format("{} is not supported", object.kind);
    skip_block(reader);
}

void add_texture(Reader& reader, Object& object, const Texture& texture) {
    object.texture = object.texture ? layered(reader, texture, *object.texture) : texture;
}

/// Returns the object's own texture, which its pigment or finish changes.
Texture& own_texture(Reader& reader, Object& object) {
    if (!object.texture)
        object.texture = reader.defaults;
    return *object.texture;
}

bool parse_look(Reader& reader, Object& object) {
    if (reader.take("texture"))
        add_texture(reader, object, parse_texture(reader));
    else if (reader.take("pigment")) {
        Texture& texture = own_texture(reader, object);
        texture.pigment = parse_pigment(reader, texture.pigment);
    } else if (reader.take("finish")) {
        Texture& texture = own_texture(reader, object);
        texture.surface = parse_finish(reader, texture.surface);
    } else if (reader.take("normal")) {
        Texture& texture = own_texture(reader, object);
        texture.normal = parse_normal(reader, texture.normal);
    } else if (reader.take("material")) {
        const Material material = parse_material(reader);
        if (material.texture)
            add_texture(reader, object, *material.texture);
        if (material.inside)
            object.inside_texture = material.inside;
        if (material.interior)
            object.interior = material.interior;
    } else if (reader.take("interior"))
        object.interior = parse_interior(reader, object.interior.value_or(Interior{}));
    else
        return false;
    return true;
}

/// Reads the flag of a word that hides the object from rays of these kinds.
void parse_hiding(Reader& reader, Object& object, uint32_t kinds) {
    object.seen_by = parse_flag(reader) ? object.seen_by & ~kinds : object.seen_by | kinds;
}

bool parse_switch(Reader& reader, Object& object) {
    if (reader.take("global_lights"))
        object.global_lights = parse_flag(reader);
    else if (reader.take("no_shadow"))
        parse_hiding(reader, object, kShadowsAll);
    else if (reader.take("no_image"))
        parse_hiding(reader, object, kSeenByCamera);
    else if (reader.take("no_reflection"))
        parse_hiding(reader, object, kSeenInReflections);
    else if (reader.take("double_illuminate"))
        object.double_illuminate = parse_flag(reader);
    else if (reader.take("uv_mapping"))
        object.uv_mapping = parse_flag(reader);
    else if (reader.take("inverse")) {
        object.inverse = !object.inverse;
        object.turned = true;
    } else if (reader.take("open"))
        object.open = parse_flag(reader);
    else if (reader.take("hollow"))
        object.hollow = parse_flag(reader);
    else if (reader.take("sturm") || reader.take("hierarchy") || reader.take("split_union") ||
             reader.take("no_radiosity"))
        parse_flag(reader);
    else
        return false;
    return true;
}

} // namespace

bool starts_object(const Token& token) {
    return token.kind == TokenKind::Name && token.name->is_keyword &&
           (kShapes.contains(token.name->text) || kWholes.contains(token.name->text));
}

void place(Object& object, const dmat4& by) {
    object.placed = by * object.placed;
    // A texture that lies on texture coordinates moves with them, and not once more.
    if (object.texture && !object.uv_mapping && !object.texture->pigment.uv_mapping)
        place(*object.texture, by);
    if (object.inside_texture)
        place(*object.inside_texture, by);
    if (object.interior)
        place(*object.interior, by);
    place_all(object.clips, by);
    place_all(object.bounds, by);
}

ObjectPtr parse_object(Reader& reader) {
    const Deeper deeper(reader);
    const Token keyword = reader.next();
    assert(starts_object(keyword));
    if (++reader.objects > reader.limits.objects)
        reader.fail(keyword.place, fmt::format("stopped after {} objects: a loop or a macro does "
                                               "not end",
                                               reader.limits.objects));
    reader.grow(kObjectBytes);
    auto object = std::make_shared<Object>();
    object->kind = keyword.name->text; // the reader owns the text
    object->place = keyword.place;
    object->caller = reader.caller();
    reader.expect('{', object->kind);
    // A shape, a mesh, a light or an object { } may start as a copy of a declared object.
    const bool is_group = kWholes.contains(object->kind) && object->kind != "object" &&
                          object->kind != "light_source" && object->kind != "mesh" &&
                          object->kind != "mesh2";
    if (!is_group) {
        if (const auto other = take_named_if<ObjectPtr>(reader)) {
            *object = **other;
            object->place = keyword.place;
            object->caller = reader.caller();
            parse_modifiers(reader, *object);
            return object;
        }
    }
    if (const auto shape = kShapes.find(object->kind); shape != kShapes.end()) {
        object->shape = shape->second(reader);
        object->has_inside = !kSheets.contains(object->kind);
        parse_modifiers(reader, *object);
    } else
        kWholes.at(object->kind)(reader, *object);
    for (const auto* parts : {&object->children, &object->clips, &object->bounds})
        for (const ObjectPtr& part : *parts)
            object->depth = std::max(object->depth, part->depth + 1);
    if (object->depth > reader.limits.chain)
        reader.fail(object->place, fmt::format("found objects more than {} deep in each other",
                                               reader.limits.chain));
    return object;
}

void parse_modifiers(Reader& reader, Object& object) {
    while (!reader.take('}')) {
        if (parse_look(reader, object) || parse_switch(reader, object))
            continue;
        if (const auto m = take_transform(reader))
            place(object, *m);
        else if (reader.take("clipped_by"))
            parse_bounds(reader, object, "clipped_by");
        else if (reader.take("bounded_by"))
            parse_bounds(reader, object, "bounded_by");
        else if (reader.take("inside_vector")) {
            parse_vector(reader);
            object.has_inside = true;
        } else if (reader.take("interior_texture"))
            object.inside_texture = parse_texture(reader);
        else if (const auto texture = take_named_if<Texture>(reader))
            add_texture(reader, object, *texture); // old scenes name it without texture { }
        else if (starts_color(reader.peek()))
            parse_color(reader); // of old scenes, which povray ignores too
        else if (!take_left_out(reader, {"cutaway_textures"}, "an object", object.notes) &&
                 !take_skipped(reader, {"photons"}) && !reader.take(',') && !reader.take(';'))
            reader.fail_here(fmt::format("'}}' or a modifier of {}", object.kind));
    }
}

} // namespace ovc::pov
