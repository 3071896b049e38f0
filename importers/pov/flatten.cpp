// SPDX-License-Identifier: Apache-2.0
// Gathers every visible shape with what it inherits, chooses how finely to cut, then cuts.
#include "importers/pov/flatten.h"

#include "core/system/parallel.h"
#include "importers/origin.h"
#include "importers/pov/shapes/bounds.h"
#include "importers/pov/solid.h"
#include "importers/pov/trace.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <unordered_map>

namespace ovc::pov {

namespace {

/// A placed object takes as much memory as a few triangles. Most objects are cut into more than
/// this, so max_triangles / kTrianglesAnObject bounds the number of objects.
constexpr uint64_t kTrianglesAnObject = 20;

/// A shape as it stands in the world.
struct Placed {
    const Object* object;
    dmat4 placed;
    bool inverse;
    uint32_t material;
    uint32_t seen_by;
};

/// The state that an object inherits from its parents.
struct Inherited {
    dmat4 placed{1};                  // to the world
    dmat4 in_solid{1};                // to the space of the solid that contains the object
    const Texture* texture = nullptr; // null: the scene's default
    dmat4 texture_placed{1};          // applied after the texture's own transformation
    const Interior* interior = nullptr;
    uint32_t seen_by = kSeenByAll;
    bool inverse = false;
};

void tell_all(const Notes& notes, const Look& look) {
    for (const auto& note : notes)
        if (look.tell)
            look.tell(*note);
}

/// Adds materials to a scene. Equal ones are added once.
class MaterialTable {
public:
    MaterialTable(const Look& look, Scene& scene) : look_(look), scene_(scene) {}

    uint32_t number(const Texture& texture, const dmat4& placed, const Interior* interior) {
        for (const Notes* notes : {&texture.notes, &texture.pigment.notes, &texture.surface.notes})
            tell_all(*notes, look_);
        if (interior)
            tell_all(interior->notes, look_);
        ovc::Material material = made(texture, placed, interior);
        const auto [first, last] = by_color_.equal_range(color_key(material));
        for (auto known = first; known != last; ++known) {
            const ovc::Material& other = scene_.materials[known->second];
            material.name = other.name; // the name must not make equal materials differ
            if (material == other)
                return known->second;
        }
        const auto number = uint32_t(scene_.materials.size());
        material.name = fmt::format("material {}", number + 1);
        by_color_.emplace(color_key(material), number);
        scene_.materials.push_back(std::move(material));
        return number;
    }

private:
    ovc::Material made(const Texture& texture, const dmat4& placed,
                       const Interior* interior) const {
        const Color& color = texture.pigment.color;
        ovc::Material material;
        Finish finish = texture.surface.finish;
        const float opacity = std::clamp(color.opacity(), 0.0f, 1.0f);
        finish.diffuse *= opacity;
        finish.ambient =
            opacity * (texture.surface.ambient * look_.ambient_light + texture.surface.emission);
        material.color = color.rgb;
        material.mirror =
            std::max(max_component(finish.reflection), max_component(finish.grazing_reflection));
        const vec3 through =
            texture.surface.refraction * (color.filter * color.rgb + vec3(color.transmit));
        material.transmission = std::clamp(max_component(through), 0.0f, 1.0f);
        if (material.transmission > 0)
            material.filter = glm::clamp(through / material.transmission, 0.0f, 1.0f);
        const double ior = texture.surface.ior.value_or(interior ? interior->ior : 1);
        material.ior = is_usable_ior(ior) ? ior : 1;
        material.finish = finish;
        if (texture.pigment.other) {
            const dmat4 whole = placed * texture.pigment.placed;
            const dmat4 back = glm::inverse(whole);
            Checker checker;
            checker.other = texture.pigment.other->rgb;
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    checker.to_cubes[size_t(row)][column] = back[column][row];
            material.checker = checker;
        }
        return material;
    }

    /// Returns a hash of the color, in which materials usually differ.
    static size_t color_key(const ovc::Material& m) {
        size_t key = 0;
        for (int i = 0; i < 3; ++i)
            key = 31 * key + std::hash<float>()(m.color[i]);
        return key;
    }

    const Look& look_;
    Scene& scene_;
    std::unordered_multimap<size_t, uint32_t> by_color_; // numbers of materials
};

void add_light(const LightSource& source, const dmat4& placed, Scene& scene) {
    Light light = source.light;
    light.position = dvec3(placed * dvec4(light.position, 1));
    const dvec3 way(placed * dvec4(light.direction, 0));
    if (glm::length(way) > 0)
        light.direction = glm::normalize(way);
    scene.lights.push_back(light);
}

class Gatherer {
public:
    Gatherer(const Look& look, Scene& scene)
        : look_(look), scene_(scene), materials_(look, scene) {}

    void gather(const Object& object, Inherited from) {
        if (is_solid(object)) {
            add_solid(object, from);
            return;
        }
        inherit(object, from);
        if (const auto* light = std::get_if<LightSource>(&object.shape))
            add_light(*light, from.placed, scene_);
        else if (!std::holds_alternative<std::monostate>(object.shape) && is_wanted(from.seen_by))
            placed.push_back({&object, from.placed, from.inverse, material_of(from), from.seen_by});
        for (const ObjectPtr& child : object.children)
            gather(*child, from);
    }

    std::vector<Placed> placed;
    std::vector<Solid> solids;
    bool gather_unseen = false; // whether objects that no ray sees are gathered too

private:
    bool is_wanted(uint32_t seen_by) const { return seen_by != 0 || gather_unseen; }

    void inherit(const Object& object, Inherited& from) {
        if (!object.refused.empty())
            throw ParseError(object.place, object.refused, object.caller);
        tell_all(object.notes, look_);
        from.texture_placed = object.texture ? from.placed : from.texture_placed;
        from.texture = object.texture ? &*object.texture : from.texture;
        from.placed = from.placed * object.placed;
        from.in_solid = from.in_solid * object.placed;
        from.interior = object.interior ? &*object.interior : from.interior;
        from.seen_by &= object.seen_by;
        from.inverse = from.inverse != object.inverse;
        // A short scene with groups of groups can place more objects than memory holds.
        if (++visited_ > look_.max_triangles / kTrianglesAnObject)
            throw ParseError(object.place,
                             fmt::format("found more than {} objects in the scene, expected at "
                                         "most that",
                                         look_.max_triangles / kTrianglesAnObject));
    }

    uint32_t material_of(const Inherited& from) {
        const Texture& texture = from.texture ? *from.texture : look_.defaults;
        return materials_.number(texture, from.texture_placed, from.interior);
    }

    void add_solid(const Object& object, Inherited from) {
        Solid solid;
        solid.object = &object;
        solid.placed = from.placed * object.placed;
        solid.seen_by = from.seen_by & object.seen_by;
        from.in_solid = glm::inverse(object.placed);
        from.inverse = false; // the inverse of a whole solid has the same surface
        if (gather_node(object, from, solid) && is_wanted(solid.seen_by))
            solids.push_back(std::move(solid));
    }

    /// Adds an object to the solid's tree as its last node. Returns false, and adds none, for a
    /// light or a group without shapes.
    bool gather_node(const Object& object, Inherited from, Solid& solid) {
        const Inherited outside = from;
        inherit(object, from);
        if (solid.nodes.empty() && &object == solid.object)
            from.in_solid = dmat4(1);
        if (const auto* light = std::get_if<LightSource>(&object.shape)) {
            add_light(*light, from.placed, scene_);
            return false;
        }
        csg::Node node;
        if (!std::holds_alternative<std::monostate>(object.shape) || object.kind == "mesh" ||
            object.kind == "mesh2") {
            node.operand = uint32_t(solid.leaves.size());
            solid.leaves.push_back(leaf_of(object, from));
        } else {
            node.kind = kind_of(object, from.inverse);
            for (const ObjectPtr& child : object.children) {
                Inherited down = from;
                down.inverse =
                    from.inverse != (object.kind == "difference" && !node.children.empty());
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
            down.inverse = false;
            if (gather_node(*other, down, solid))
                clip.children.push_back(uint32_t(solid.nodes.size() - 1));
        }
        solid.nodes.push_back(clip);
        return true;
    }

    SolidLeaf leaf_of(const Object& object, const Inherited& from) {
        SolidLeaf leaf;
        leaf.placed = from.in_solid;
        leaf.inverse = from.inverse;
        leaf.has_inside = object.has_inside;
        if (!std::holds_alternative<std::monostate>(object.shape))
            leaf.skins.push_back({&object, material_of(from)});
        if (std::holds_alternative<EndlessShape>(object.shape))
            for (const ObjectPtr& bound : object.bounds) {
                const Box box =
                    moved(bounds_of(*bound, look_.max_triangles), glm::inverse(object.placed));
                leaf.bounds.add(moved(box, from.in_solid));
            }
        for (const ObjectPtr& child : object.children) { // a mesh has a child for each texture
            Inherited down = from;
            inherit(*child, down);
            leaf.skins.push_back({child.get(), material_of(down)});
        }
        return leaf;
    }

    const Look& look_;
    Scene& scene_;
    MaterialTable materials_;
    uint64_t visited_ = 0;
};

double triangles_at(const Gatherer& gatherer, int segments) {
    double sum = 0;
    for (const Solid& solid : gatherer.solids)
        sum += triangles_of(solid, segments);
    for (const Placed& p : gatherer.placed)
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape))
            sum += shape->triangles(segments);
    return sum;
}

/// Returns how many segments keep a sphere's facets within `tolerance` radii of it. Facets between
/// steps of angle a in both directions lie about 2 (1 - cos(a / 2)) radii off the sphere.
int segments_within(double tolerance) {
    assert(tolerance > 0);
    return std::max(8, 4 * int(std::ceil(std::numbers::pi / std::sqrt(tolerance) / 4)));
}

int choose_segments(const Gatherer& gatherer, std::optional<double> tolerance) {
    if (tolerance)
        return segments_within(*tolerance);
    int segments = kMaxSegments;
    while (segments > 8 &&
           triangles_at(gatherer, segments) - triangles_at(gatherer, 0) > kMaxRoundTriangles)
        segments = std::max(8, segments * 3 / 4 / 4 * 4);
    assert(segments >= 8 && segments % 4 == 0);
    return segments;
}

void require_at_most(uint64_t most, const Gatherer& gatherer, int segments, const Place& at) {
    if (const double count = triangles_at(gatherer, segments); count > double(most))
        throw ParseError(
            at, fmt::format("found about {:.0f} triangles, expected at most {}", count, most));
}

/// Returns a box around all shapes that are not endless and the origins of solids that are.
Box box_of(const Gatherer& gatherer, int segments) {
    Box box;
    for (const Solid& solid : gatherer.solids) {
        const Box own = bounds_of(solid, segments);
        if (is_finite(own.lo) && is_finite(own.hi))
            box.add(moved(own, solid.placed));
        else if (!own.empty())
            box.add(dvec3(solid.placed[3]));
    }
    Facets facets;
    for (const Placed& p : gatherer.placed)
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape)) {
            facets.corners.clear();
            if (shape->box) {
                box.add(moved(*shape->box, p.placed));
                continue;
            }
            shape->cut(segments, p.object->open, facets);
            for (const Corner& corner : facets.corners)
                if (const dvec3 at(p.placed * dvec4(corner.position, 1)); is_finite(at))
                    box.add(at);
        }
    return box;
}

/// The triangles of one material.
struct Batch {
    std::vector<vec3> corners, normals;
    bool smooth = false;
};

/// Calls use(corners) for each triangle of `facets`, moved into the world. Its corners run
/// counterclockwise seen from outside, and each has a normal of any length.
template <class Use>
void for_each_placed(const Facets& facets, const Placed& p, Use use) {
    assert(facets.corners.size() % 3 == 0);
    const dmat3 turned = glm::transpose(glm::inverse(dmat3(p.placed)));
    const bool mirrored = (glm::determinant(dmat3(p.placed)) < 0) != p.inverse;
    const double outward = p.inverse ? -1 : 1;
    const size_t order[3] = {0, mirrored ? size_t(2) : 1, mirrored ? size_t(1) : 2};
    for (size_t t = 0; t + 2 < facets.corners.size(); t += 3) {
        std::array<Corner, 3> corners;
        for (size_t i = 0; i < 3; ++i) {
            const Corner& corner = facets.corners[t + order[i]];
            corners[i] = {dvec3(p.placed * dvec4(corner.position, 1)),
                          outward * (turned * corner.normal)};
        }
        const dvec3 flat = glm::cross(corners[1].position - corners[0].position,
                                      corners[2].position - corners[0].position);
        for (Corner& corner : corners)
            if (!(glm::dot(corner.normal, corner.normal) > 0))
                corner.normal = flat;
        use(corners);
    }
}

void add_corners(const Facets& facets, const Placed& p, const dvec3& origin, Batch& batch) {
    for_each_placed(facets, p, [&](const std::array<Corner, 3>& corners) {
        for (const Corner& corner : corners) {
            batch.corners.push_back(vec3(corner.position - origin));
            const double length = glm::length(corner.normal);
            batch.normals.push_back(
                length > 0 && std::isfinite(length) ? vec3(corner.normal / length) : vec3(0));
        }
    });
    batch.smooth = batch.smooth || facets.smooth;
}

void add_finite(const Facets& facets, const Placed& p, Facets& out) {
    for_each_placed(facets, p, [&](const std::array<Corner, 3>& corners) {
        if (std::all_of(corners.begin(), corners.end(),
                        [](const Corner& c) { return is_finite(c.position); }))
            out.corners.insert(out.corners.end(), corners.begin(), corners.end());
    });
}

/// Returns the plane in the world with a normal of length 1, or nothing where it is not finite.
std::optional<PlaneShape> placed_plane(const PlaneShape& plane, const Placed& p) {
    const dmat3 turned = glm::transpose(glm::inverse(dmat3(p.placed)));
    const dvec3 normal = glm::normalize(turned * plane.normal) * (p.inverse ? -1.0 : 1.0);
    const dvec3 on_plane(p.placed * dvec4(plane.distance * plane.normal, 1));
    if (!is_finite(normal) || !is_finite(on_plane))
        return std::nullopt;
    return PlaneShape{normal, glm::dot(normal, on_plane)};
}

/// Adds a square around the point of the plane nearest to the scene's center. That point is a
/// corner of all four triangles, so that there the plane keeps its place in floats.
void add_plane(const Placed& p, const dvec3& center, double reach, Scene& scene) {
    const auto plane = placed_plane(std::get<PlaneShape>(p.object->shape), p);
    if (!plane)
        return;
    const dvec3& normal = plane->normal;
    const dvec3 origin = center + (plane->distance - glm::dot(center, normal)) * normal;
    const int major = major_axis(normal);
    dvec3 u(0);
    u[(major + 1) % 3] = 1;
    u = glm::normalize(u - glm::dot(u, normal) * normal);
    const dvec3 v = glm::cross(normal, u);
    const double r = kPlaneReach * std::max(reach, glm::length(origin - center));
    std::vector<vec3> corners;
    const dvec3 rim[4] = {r * (u + v), r * (v - u), -r * (u + v), r * (u - v)};
    for (int i = 0; i < 4; ++i)
        corners.insert(corners.end(), {vec3(0), vec3(rim[i]), vec3(rim[(i + 1) % 4])});
    const uint32_t mesh =
        scene.add_mesh("plane", p.material, Chunk::owning(origin, std::move(corners)));
    scene.show(mesh, p.seen_by);
}

/// Returns a box around the scene and the camera, which is never empty.
Box world_of(Box box, const Look& look) {
    if (look.eye)
        box.add(*look.eye);
    if (box.empty())
        box.add(dvec3(0));
    return box;
}

double reach_of(const Box& world) {
    return std::max(1.0, 0.5 * glm::length(world.extent()));
}

/// Returns the box that cuts off endless solids.
Box reach_of_solids(const Box& world) {
    return Box{world.center(), world.center()}.padded(kPlaneReach * reach_of(world));
}

/// By the number of their material and the rays that see them.
using Batches = std::map<std::pair<uint32_t, uint32_t>, Batch>;

void add_solids(const std::vector<Solid>& solids, int segments, const Box& world,
                const dvec3& origin, Batches& batches) {
    constexpr size_t kAtOnce = 64; // so that not all solids are in memory twice
    const Box reach = reach_of_solids(world);
    const std::vector<std::vector<uint32_t>> groups = alike(solids);
    for (size_t start = 0; start < groups.size(); start += kAtOnce) {
        std::vector<std::vector<SolidPart>> parts(std::min(kAtOnce, groups.size() - start));
        parallel_for(parts.size(), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                const Solid& solid = solids[groups[start + i][0]];
                parts[i] = evaluate(solid, segments, moved(reach, glm::inverse(solid.placed)));
            }
        });
        for (size_t i = 0; i < parts.size(); ++i)
            for (const uint32_t number : groups[start + i])
                for (const SolidPart& part : parts[i]) {
                    const Solid& solid = solids[number];
                    const Placed p{solid.object, solid.placed, false, material_of(solid, part.skin),
                                   solid.seen_by};
                    add_corners(part.facets, p, origin, batches[{p.material, p.seen_by}]);
                }
    }
}

} // namespace

void flatten(const std::vector<ObjectPtr>& objects, const Look& look, Scene& scene) {
    Gatherer gatherer(look, scene);
    for (const ObjectPtr& object : objects)
        gatherer.gather(*object, {});
    const std::vector<Placed>& placed = gatherer.placed;

    const int segments = choose_segments(gatherer, look.tolerance);
    require_at_most(look.max_triangles, gatherer, segments, {});
    const Box box = box_of(gatherer, 8);
    const dvec3 origin = chunk_origin(box, 16);
    Batches batches;
    Facets facets;
    for (const Placed& p : placed)
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape)) {
            facets.corners.clear();
            facets.smooth = false;
            shape->cut(segments, p.object->open, facets);
            add_corners(facets, p, origin, batches[{p.material, p.seen_by}]);
        }
    add_solids(gatherer.solids, segments, world_of(box, look), origin, batches);
    for (auto& [key, batch] : batches) {
        assert(batch.corners.size() == batch.normals.size());
        if (batch.corners.empty())
            continue;
        if (batch.corners.size() / 3 > kMaxTriangles)
            throw ParseError({}, fmt::format("found {} triangles of one material, expected at "
                                             "most {}",
                                             batch.corners.size() / 3, kMaxTriangles));
        const uint32_t mesh =
            scene.add_mesh(scene.materials[key.first].name, key.first,
                           Chunk::owning(origin, std::move(batch.corners)),
                           batch.smooth ? std::move(batch.normals) : std::vector<vec3>());
        scene.show(mesh, key.second);
    }

    const Box world = world_of(box, look);
    for (const Placed& p : placed)
        if (std::holds_alternative<PlaneShape>(p.object->shape))
            add_plane(p, world.center(), reach_of(world), scene);
}

Box moved(const Box& box, const dmat4& by) {
    Box all;
    for (int i = 0; !box.empty() && i < 8; ++i) {
        const dvec3 corner(i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                           i & 4 ? box.hi.z : box.lo.z);
        if (is_finite(corner))
            all.add(dvec3(by * dvec4(corner, 1)));
    }
    return all;
}

namespace {

/// An object gathered by itself, whether any ray sees it or not.
struct ObjectAlone {
    ObjectAlone(const Object& object, uint64_t max_triangles) {
        look.max_triangles = max_triangles;
        gatherer.gather_unseen = true;
        gatherer.gather(object, {});
    }
    ObjectAlone(const ObjectAlone&) = delete; // the gatherer refers to the other members

    Scene scene;
    Look look;
    Gatherer gatherer{look, scene};
};

} // namespace

CutObject cut_object(const Object& object, uint64_t max_triangles) {
    const ObjectAlone alone(object, max_triangles);
    const Gatherer& gatherer = alone.gatherer;
    const int segments = choose_segments(gatherer, alone.look.tolerance);
    require_at_most(max_triangles, gatherer, segments, object.place);
    CutObject cut;
    Facets facets;
    for (const Placed& p : gatherer.placed) {
        if (const auto* plane = std::get_if<PlaneShape>(&p.object->shape))
            if (const std::optional<PlaneShape> in_world = placed_plane(*plane, p))
                cut.planes.push_back(*in_world);
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape)) {
            facets.corners.clear();
            shape->cut(segments, p.object->open, facets);
            add_finite(facets, p, cut.facets);
        }
    }
    const Box reach = reach_of_solids(world_of(box_of(gatherer, 8), alone.look));
    for (const Solid& solid : gatherer.solids)
        for (const SolidPart& part :
             evaluate(solid, segments, moved(reach, glm::inverse(solid.placed))))
            add_finite(part.facets, {solid.object, solid.placed, false, 0, kSeenByAll}, cut.facets);
    return cut;
}

Box bounds_of(const Object& object, uint64_t max_triangles) {
    const ObjectAlone alone(object, max_triangles);
    const Gatherer& gatherer = alone.gatherer;
    for (const Placed& p : gatherer.placed)
        if (std::holds_alternative<PlaneShape>(p.object->shape))
            return {dvec3(-1e10), dvec3(1e10)};
    for (const Solid& solid : gatherer.solids)
        if (const Box around = bounds_of(solid, 8); !around.empty() && !is_finite(around.extent()))
            return {dvec3(-1e10), dvec3(1e10)};
    Box box = box_of(gatherer, 32);
    if (box.empty())
        box.add(dvec3(0));
    return box;
}

} // namespace ovc::pov
