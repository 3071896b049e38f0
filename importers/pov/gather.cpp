// SPDX-License-Identifier: Apache-2.0
// Goes down from objects to their parts, and hands on what parts inherit.
#include "importers/pov/gather.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/shapes/bounds.h"
#include "importers/pov/trace.h"
#include "importers/pov/values/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ovc::pov {

namespace {

/// A placed object takes as much memory as a few triangles. Most objects are cut into more than
/// this, so max_triangles / kTrianglesAnObject bounds the number of objects.
constexpr uint64_t kTrianglesAnObject = 20;

/// Returns whether the object's triangles stand for a surface that has their normals. Those of a
/// mesh are what povray draws itself.
bool is_curved(const Object& object) {
    static constexpr std::string_view kMeshes[] = {"mesh", "mesh2", "smooth_triangle",
                                                   "height_field", "bicubic_patch"};
    return std::find(std::begin(kMeshes), std::end(kMeshes), object.kind) == std::end(kMeshes);
}

/// Returns the square from -0.5 to 0.5 pressed into the circle that touches its sides.
dvec2 into_circle(const dvec2& at) {
    const double length = glm::length(at);
    return length > 0 ? std::max(std::abs(at.x), std::abs(at.y)) / length * at : at;
}

/// Returns the steps from the world to the texture coordinates of a shape; none where they are not
/// known.
std::vector<TextureStep> to_uv_of(const Object& object, const dmat4& placed) {
    const Shape* const shape = std::get_if<Shape>(&object.shape);
    if (shape && shape->corners_have_uv)
        return {};
    TextureStep flat; // a pattern is evaluated at (u, v, 0)
    flat.rows[2] = dvec4(0);
    if (!shape || shape->to_uv.empty()) // povray takes x and y of the world
        return {flat};
    std::vector<TextureStep> steps = {{TextureStep::Kind::Affine, rows_of(glm::inverse(placed))}};
    steps.insert(steps.end(), shape->to_uv.begin(), shape->to_uv.end());
    steps.push_back(flat);
    return steps;
}

/// Returns the object's surface in the world.
Region projector_of(const Object& object, const dmat4& placed) {
    constexpr uint64_t kMaxTriangles = 1000000; // they are held in memory for each point of a light
    Object there = object;
    there.placed = placed * object.placed;
    return TraceTarget(cut_object(there, kMaxTriangles)).region();
}

/// The max lights of an area light. Each takes a shadow ray at every hit.
constexpr int kMaxAlongSide = 12;
constexpr int kMaxAreaPoints = kMaxAlongSide * kMaxAlongSide;

/// Returns how many lights a grid is drawn by. Few stand for many.
std::array<int, 2> counts_drawn(const std::array<int, 2>& counts) {
    if (int64_t(counts[0]) * counts[1] <= kMaxAreaPoints)
        return counts;
    const int fewer = std::min({counts[0], counts[1], kMaxAlongSide});
    const int more = kMaxAreaPoints / fewer;
    return counts[0] < counts[1] ? std::array{fewer, more} : std::array{more, fewer};
}

/// Returns the place of a light in a row of them that is 1 long, from -0.5 to 0.5.
double place_in_row(int i, int count) {
    return count > 1 ? i / (count - 1.0) - 0.5 : 0;
}

/// Returns how much longer a row of `drawn` lights is than one of `count`, so that the distances
/// from the middle have the same variance. With jitter a light is anywhere within its cell.
double spread_of(int drawn, int count, bool jitter) {
    const auto variance = [](int n) { return (n + 1.0) / (n - 1); }; // x 12
    if (drawn < 2)
        return 1;
    const double cell = jitter ? 1.0 / ((count - 1.0) * (count - 1)) : 0;
    return std::sqrt((variance(count) + cell) / variance(drawn));
}

void add_light(const LightSource& source, const dmat4& placed, uint32_t group, Scene& scene) {
    Light light = source.light;
    light.group = group;
    light.position = dvec3(placed * dvec4(source.light.position, 1));
    const auto aim_from = [&](const dvec3& place) {
        const dvec3 aim = dvec3(placed * dvec4(source.point_at, 1)) - place;
        if (light.cone && glm::length(aim) > 0)
            light.direction = glm::normalize(aim);
    };
    const dvec3 way(placed * dvec4(light.direction, 0));
    if (glm::length(way) > 0)
        light.direction = glm::normalize(way);
    aim_from(light.position);
    if (source.projector)
        light.projector = projector_of(*source.projector, placed);
    const std::array<int, 2> counts = counts_drawn(source.counts);
    light.area_points = uint32_t(counts[0] * counts[1]);
    light.color /= float(light.area_points);
    light.faces_places = source.orient && !source.illuminates;
    const dvec2 spread(spread_of(counts[0], source.counts[0], source.jitter),
                       spread_of(counts[1], source.counts[1], source.jitter));
    const dvec3 middle = light.position;
    const double radius = glm::length(dvec3(placed * dvec4(source.sides[0], 0)));
    for (int i = 0; i < counts[0]; ++i)
        for (int j = 0; j < counts[1]; ++j) {
            dvec2 at(spread.x * place_in_row(i, counts[0]), spread.y * place_in_row(j, counts[1]));
            at = source.circular ? into_circle(at) : at;
            const dvec3 offset(placed * dvec4(at.x * source.sides[0] + at.y * source.sides[1], 0));
            if (source.illuminates) {
                light.position = middle + offset;
                aim_from(light.position);
            } else
                light.shadow_offset = light.faces_places ? dvec3(radius * at, 0) : offset;
            scene.lights.push_back(light);
        }
}

/// Whether the object's interior would lie on the wrong side of its triangles. In povray each
/// surface that a ray meets leads into an interior or out of it, whichever way triangles run; the
/// texture of inner sides goes by that.
bool fills_wrong_side(const Object& object, const Inherited& from) {
    return object.faces_inside && from.interior.interior && !from.inside;
}

} // namespace

void Gatherer::gather(const Object& object, Inherited from) {
    if (is_solid(object)) {
        add_solid(object, from);
        return;
    }
    inherit(object, from);
    if (const auto* light = std::get_if<LightSource>(&object.shape))
        add_light(*light, from.placed, from.lit_by.group, scene_);
    else if (!std::holds_alternative<std::monostate>(object.shape) && is_wanted(from.seen_by))
        placed.push_back({&object, from.placed, from.inverse, cover_of(object, from), from.seen_by,
                          from.lit_by, fills_wrong_side(object, from)});
    for (const ObjectPtr& child : object.children)
        gather(*child, from);
}

void Gatherer::inherit(const Object& object, Inherited& from) {
    if (!object.refused.empty())
        throw ParseError(object.place, object.refused, object.caller);
    tell_all(object.notes, look_);
    from.texture_placed = object.texture ? from.placed : from.texture_placed;
    from.texture = object.texture ? &*object.texture : from.texture;
    from.inside = object.inside_texture ? &*object.inside_texture : from.inside;
    if (object.interior)
        from.interior = {&*object.interior, from.placed};
    from.hollow = from.hollow || object.hollow;
    from.interior.hollow = from.hollow;
    from.interior.is_sheet = from.interior.is_sheet || !object.has_inside;
    from.double_illuminate = from.double_illuminate || object.double_illuminate;
    from.interior.double_illuminate = from.double_illuminate;
    from.placed = from.placed * object.placed;
    from.in_solid = from.in_solid * object.placed;
    from.seen_by &= object.seen_by;
    if (object.kind == "light_group") { // the outermost one's global_lights counts
        const bool is_outermost = from.lit_by.group == kNone;
        from.lit_by = {light_groups_++,
                       is_outermost ? !object.global_lights : from.lit_by.group_alone};
    }
    from.uv_mapping = from.uv_mapping || object.uv_mapping;
    from.inverse = from.inverse != object.inverse;
    from.turned = from.turned || object.turned;
    // A short scene with groups of groups can place more objects than memory holds.
    if (++visited_ > look_.max_triangles / kTrianglesAnObject)
        throw ParseError(object.place,
                         fmt::format("found more than {} objects in the scene, expected at "
                                     "most that",
                                     look_.max_triangles / kTrianglesAnObject));
}

Cover Gatherer::cover_of(const Object& object, const Inherited& from, bool in_solid) {
    const Texture& texture = *from.texture;
    const Pigment& pigment = texture.pigment;
    const bool on_uv = pigment.uv_mapping || from.uv_mapping;
    const Shape* const shape = std::get_if<Shape>(&object.shape);
    const bool on_corners =
        object.kind == "mesh" || object.kind == "mesh2" || (shape && shape->corners_have_uv);
    const bool has_uv = !in_solid && on_corners;
    // A mix has its first texture here.
    const bool has_holes = pigment.holes && !texture.mix.pattern && (!on_uv || has_uv);
    const Texture filled = has_holes ? without_holes(texture, on_uv) : Texture();
    const Texture& look = has_holes ? filled : texture;
    const Color& color = look.pigment.color;
    materials_.set_has_uv(has_uv && !has_holes);
    const bool in_formulas = on_uv && !on_corners;
    materials_.set_to_uv(in_formulas ? to_uv_of(object, from.placed) : std::vector<TextureStep>());
    const uint32_t material =
        on_uv && !pigment.uv_mapping
            ? materials_.number(on_texture_coordinates(look), color, from.texture_placed,
                                from.interior, from.inside)
            : materials_.number(look, color, from.texture_placed, from.interior, from.inside);
    Cover cover{material};
    cover.curved = is_curved(object);
    cover.uv = materials_.is_on_uv(material);
    if (on_uv && (look.pigment.pattern || look.mix.pattern) && !materials_.maps_uv() && look_.tell)
        look_.tell({"uv_mapping of a shape", object.place,
                    "uv_mapping of lathes, patches, parametrics and meshes is left out in "
                    "solids"});
    if (from.uv_mapping && texture.normal.pattern.pattern && look_.tell)
        look_.tell({"normal uv_mapping", object.place, "uv_mapping of a normal is left out"});
    if (has_holes)
        cover.holes = holes.number(
            pigment, on_uv ? pigment.placed : from.texture_placed * pigment.placed, on_uv);
    if (has_holes)
        tell_of_holes(object, scene_.materials[cover.material], on_uv && !pigment.holes->one_color);
    return cover;
}

Texture Gatherer::without_holes(const Texture& texture, bool on_uv) {
    Texture filled = texture;
    const Holes& cut = *texture.pigment.holes;
    filled.pigment.color = cut.color;
    if (cut.one_color || on_uv) {
        filled.pigment.pattern.reset();
        return filled;
    }
    PatternPtr& known = pictures_without_holes_[texture.pigment.pattern.get()];
    if (!known) {
        auto map = std::make_shared<PatternMap>(*texture.pigment.pattern);
        ImageTexture& image = map->image_map->image;
        image.is_transparent = false;
        image.otherwise = cut.color;
        if (image.beyond_s == Beyond::Nothing)
            image.beyond_s = image.beyond_t = Beyond::Clamp;
        known = std::move(map);
    }
    filled.pigment.pattern = known;
    return filled;
}

void Gatherer::tell_of_holes(const Object& object, const ovc::Material& material,
                             bool has_lost_picture) const {
    const auto tell = [&](const char* kind, const char* sentence) {
        if (look_.tell)
            look_.tell({kind, object.place, sentence});
    };
    if (has_lost_picture)
        tell("image_map", "an image_map with holes on texture coordinates has its average color");
    const Finish& finish = *material.finish;
    if (finish.specular > 0 || finish.phong > 0 || material.mirror > 0 || material.ior != 1)
        tell("holes", "the holes of an image_map neither shine nor bend light");
}

void Gatherer::add_solid(const Object& object, Inherited from) {
    Solid solid;
    solid.object = &object;
    solid.placed = from.placed * object.placed;
    solid.seen_by = from.seen_by & object.seen_by;
    solid.lit_by = from.lit_by;
    from.in_solid = glm::inverse(object.placed);
    from.inverse = from.turned = false; // the inverse of a whole solid has the same surface
    if (gather_node(object, from, solid) && is_wanted(solid.seen_by))
        solids.push_back(std::move(solid));
}

bool Gatherer::gather_node(const Object& object, Inherited from, Solid& solid) {
    const Inherited outside = from;
    inherit(object, from);
    if (solid.nodes.empty() && &object == solid.object)
        from.in_solid = dmat4(1);
    if (const auto* light = std::get_if<LightSource>(&object.shape)) {
        add_light(*light, from.placed, from.lit_by.group, scene_);
        return false;
    }
    csg::Node node;
    if (!std::holds_alternative<std::monostate>(object.shape) || object.kind == "mesh" ||
        object.kind == "mesh2") {
        node.operand = uint32_t(solid.leaves.size());
        solid.leaves.push_back(leaf_of(object, from));
    } else {
        node.kind = kind_of(object, from.inverse, from.turned);
        for (const ObjectPtr& child : object.children) {
            Inherited down = from;
            const bool is_taken_away = object.kind == "difference" && !node.children.empty();
            down.inverse = from.inverse != is_taken_away;
            down.turned = from.turned || is_taken_away;
            if (gather_node(*child, down, solid))
                node.children.push_back(uint32_t(solid.nodes.size() - 1));
        }
        if (node.children.empty())
            return false;
    }
    solid.nodes.push_back(node);
    if (object.clips.empty())
        return true;
    csg::Node clip{csg::Kind::Clip, 0, {uint32_t(solid.nodes.size() - 1)}};
    for (const ObjectPtr& other : object.clips) {
        Inherited down = outside;
        down.inverse = down.turned = false;
        if (gather_node(*other, down, solid))
            clip.children.push_back(uint32_t(solid.nodes.size() - 1));
    }
    solid.nodes.push_back(clip);
    return true;
}

SolidLeaf Gatherer::leaf_of(const Object& object, const Inherited& from) {
    SolidLeaf leaf;
    leaf.placed = from.in_solid;
    leaf.inverse = from.inverse;
    leaf.has_inside = object.has_inside;
    if (!std::holds_alternative<std::monostate>(object.shape))
        leaf.skins.push_back({&object, cover_of(object, from, /* in_solid= */ true)});
    if (std::holds_alternative<EndlessShape>(object.shape))
        for (const ObjectPtr& bound : object.bounds) {
            const Box box =
                moved(bounds_of(*bound, look_.max_triangles), glm::inverse(object.placed));
            leaf.bounds.add(moved(box, from.in_solid));
        }
    for (const ObjectPtr& child : object.children) { // a mesh has a child for each texture
        Inherited down = from;
        inherit(*child, down);
        leaf.skins.push_back({child.get(), cover_of(*child, down, /* in_solid= */ true)});
    }
    return leaf;
}

} // namespace ovc::pov
