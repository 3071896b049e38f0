// SPDX-License-Identifier: Apache-2.0
// Chooses how finely to cut what was gathered, then cuts it into meshes.
#include "importers/pov/flatten.h"

#include "core/system/parallel.h"
#include "importers/origin.h"
#include "importers/pov/gather.h"
#include "importers/pov/shapes/bounds.h"
#include "importers/pov/trace.h"
#include "importers/pov/values/transform.h"
#include "importers/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <map>

namespace ovc::pov {

namespace {

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

/// Returns whether the look of a surface depends on the place.
bool is_patterned(const Cover& cover, const Scene& scene) {
    if (cover.holes != kNone)
        return true;
    const auto any_pattern = [&](const ovc::Material& m) {
        return m.texture || m.bump || m.normal_map || m.maps || m.mix || m.under != kNone;
    };
    const ovc::Material& outside = scene.materials[cover.material];
    return any_pattern(outside) ||
           (outside.inside != kNone && any_pattern(scene.materials[outside.inside]));
}

/// Returns whether any of the shapes that are cut the finer the more segments there are is so.
template <class Is>
bool any_round(const std::vector<Placed>& placed, Is is) {
    return std::ranges::any_of(placed, [&](const Placed& p) {
        const Shape* const shape = std::get_if<Shape>(&p.object->shape);
        return shape && shape->triangles(1) != shape->triangles(0) && is(*shape, p.cover);
    });
}

int choose_segments(const Gatherer& gatherer, std::optional<double> tolerance, int fine) {
    if (tolerance)
        return segments_within(*tolerance);
    int segments = fine;
    if (triangles_at(gatherer, segments) - triangles_at(gatherer, 0) > kMaxFineTriangles)
        segments = kMaxSegments;
    while (segments > 8 &&
           triangles_at(gatherer, segments) - triangles_at(gatherer, 0) > kMaxRoundTriangles)
        segments = std::max(8, segments * 3 / 4 / 4 * 4);
    assert(segments >= 8 && segments % 4 == 0);
    return segments;
}

/// Returns pieces with corners on circles where a tolerance or the patterns of round shapes ask for
/// places, or where solids do, whose corners are rounded to steps of their size; else pieces whose
/// outlines err less, and of which circles alone need fewer.
CirclePieces choose_pieces(const Gatherer& gatherer, const Look& look, const Scene& scene) {
    const auto is_patterned_one = [&](const Shape&, const Cover& cover) {
        return is_patterned(cover, scene);
    };
    if (look.tolerance || !gatherer.solids.empty() || any_round(gatherer.placed, is_patterned_one))
        return {choose_segments(gatherer, look.tolerance, kFineSegments)};
    const bool others = any_round(
        gatherer.placed, [](const Shape& shape, const Cover&) { return !shape.of_circles; });
    return as_large_as_circles(
        choose_segments(gatherer, {}, others ? kFineSegments : kFineSegmentsOfCircles));
}

void require_at_most(uint64_t max, const Gatherer& gatherer, int segments, const Place& at) {
    if (const double count = triangles_at(gatherer, segments); count > double(max))
        throw ParseError(
            at, fmt::format("found about {:.0f} triangles, expected at most {}", count, max));
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
            facets.clear();
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

/// The triangles of one mesh. They have texture coordinates where the mesh has holes.
struct Batch {
    std::vector<vec3> corners, normals;
    std::vector<vec2> uv;
    bool smooth = false;
};

/// Calls use(corners, uv) for each triangle of `facets`, moved into the world. Its corners run
/// counterclockwise seen from outside, and each has a normal of any length. uv: of its corners;
/// null if there are none.
template <class Use>
void for_each_placed(const Facets& facets, const Placed& p, Use use) {
    assert(facets.corners.size() % 3 == 0);
    const dmat3 turned = glm::transpose(glm::inverse(dmat3(p.placed)));
    const bool mirrored = ((glm::determinant(dmat3(p.placed)) < 0) != p.inverse) != p.clockwise;
    const double outward = p.inverse ? -1 : 1;
    const size_t order[3] = {0, mirrored ? size_t(2) : 1, mirrored ? size_t(1) : 2};
    for (size_t t = 0; t + 2 < facets.corners.size(); t += 3) {
        std::array<Corner, 3> corners;
        std::array<vec2, 3> uv;
        for (size_t i = 0; i < 3; ++i) {
            const Corner& corner = facets.corners[t + order[i]];
            uv[i] = facets.uv.empty() ? vec2(0) : facets.uv[t + order[i]];
            corners[i] = {dvec3(p.placed * dvec4(corner.position, 1)),
                          outward * (turned * corner.normal)};
        }
        const dvec3 flat = glm::cross(corners[1].position - corners[0].position,
                                      corners[2].position - corners[0].position);
        for (Corner& corner : corners)
            if (!(glm::dot(corner.normal, corner.normal) > 0))
                corner.normal = flat;
        use(corners, facets.uv.empty() ? nullptr : uv.data());
    }
}

void add_corners(const Facets& facets, const Placed& p, const HoleTable& holes, const dvec3& origin,
                 Batch& batch) {
    for_each_placed(facets, p, [&](const std::array<Corner, 3>& corners, const vec2* uv) {
        holes.add_uv(p.cover.holes, {corners[0].position, corners[1].position, corners[2].position},
                     uv, batch.uv);
        if (p.cover.uv)
            for (size_t i = 0; i < 3; ++i)
                batch.uv.push_back(uv ? uv[i] : vec2(0));
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
    for_each_placed(facets, p, [&](const std::array<Corner, 3>& corners, const vec2*) {
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

/// Adds a square around the point of the plane nearest to `center`, a point near the scene. It is a
/// corner of all four triangles, so that there the plane keeps its place in floats.
void add_plane(const Placed& p, const HoleTable& holes, const dvec3& center, double reach,
               Scene& scene) {
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
    std::vector<vec2> uv;
    const dvec3 rim[4] = {r * (u + v), r * (v - u), -r * (u + v), r * (u - v)};
    for (size_t i = 0; i < 4; ++i) {
        const dvec3 next = rim[(i + 1) % 4];
        corners.insert(corners.end(), {vec3(0), vec3(rim[i]), vec3(next)});
        holes.add_uv(p.cover.holes, {origin, origin + rim[i], origin + next}, nullptr, uv);
    }
    const uint32_t mesh =
        scene.add_mesh("plane", p.cover.material, Chunk::owning(origin, std::move(corners)));
    scene.meshes[mesh].cutout = holes.cutout(p.cover.holes);
    scene.meshes[mesh].uv = std::move(uv);
    scene.meshes[mesh].lit_by = p.lit_by;
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

/// Returns a power of two, so that it is the same for about the same boxes: planes then stay where
/// they are while other things move.
double reach_of(const Box& world) {
    const double reach = std::max(1.0, 0.5 * glm::length(world.extent()));
    return reach < 1e300 ? std::ldexp(1.0, std::ilogb(reach) + 1) : reach;
}

/// Returns the box that cuts off endless solids.
Box reach_of_solids(const Box& world) {
    return Box{world.center(), world.center()}.padded(kPlaneReach * reach_of(world));
}

/// The triangles of a mesh have these in common.
struct MeshKey {
    uint32_t material, cutout, seen_by;
    LitBy lit_by;
    bool curved;

    auto operator<=>(const MeshKey&) const = default;
};

/// The meshes in the making.
class Batches {
public:
    Batches(const HoleTable& holes, const dvec3& origin) : holes_(holes), origin_(origin) {}

    void add(const Facets& facets, const Placed& p) {
        const MeshKey key{p.cover.material, holes_.cutout(p.cover.holes), p.seen_by, p.lit_by,
                          p.cover.curved};
        add_corners(facets, p, holes_, origin_, all_[key]);
    }

    /// Leaves no batches behind.
    void give_to(Scene& scene) {
        for (auto& [key, batch] : all_)
            if (!batch.corners.empty())
                give_to(scene, key, batch);
        all_.clear();
    }

private:
    void give_to(Scene& scene, const MeshKey& key, Batch& batch) const {
        assert(batch.corners.size() == batch.normals.size());
        if (batch.corners.size() / 3 > kMaxTriangles)
            throw ParseError({}, fmt::format("found {} triangles of one material, expected at "
                                             "most {}",
                                             batch.corners.size() / 3, kMaxTriangles));
        const uint32_t mesh =
            scene.add_mesh(scene.materials[key.material].name, key.material,
                           Chunk::owning(origin_, std::move(batch.corners)),
                           batch.smooth ? std::move(batch.normals) : std::vector<vec3>());
        scene.meshes[mesh].curved = key.curved && batch.smooth;
        scene.meshes[mesh].cutout = key.cutout;
        scene.meshes[mesh].uv = std::move(batch.uv);
        scene.meshes[mesh].lit_by = key.lit_by;
        scene.show(mesh, key.seen_by);
    }

    const HoleTable& holes_;
    const dvec3 origin_;
    std::map<MeshKey, Batch> all_;
};

void add_solids(const std::vector<Solid>& solids, int segments, const Box& world,
                Batches& batches) {
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
                    batches.add(part.facets,
                                {solid.object, solid.placed, false, cover_of(solid, part.skin),
                                 solid.seen_by, solid.lit_by});
                }
    }
}

} // namespace

void flatten(const std::vector<DrawnObject>& objects, const Look& look, Scene& scene) {
    Gatherer gatherer(look, scene);
    for (const auto& [object, defaults] : objects)
        gatherer.gather(*object, {.texture = defaults.get()});
    const std::vector<Placed>& placed = gatherer.placed;

    const CirclePieces pieces = choose_pieces(gatherer, look, scene);
    require_at_most(look.max_triangles, gatherer, pieces.segments, {});
    const Box box = box_of(gatherer, 8);
    Batches batches(gatherer.holes, chunk_origin(box, 16));
    Facets facets;
    facets.circle_radius = pieces.radius;
    for (const Placed& p : placed)
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape)) {
            facets.clear();
            shape->cut(pieces.segments, p.object->open, facets);
            batches.add(facets, p);
        }
    add_solids(gatherer.solids, pieces.segments, world_of(box, look), batches);
    // Where a plane and another surface are in one place, the first mesh is seen: povray's planes
    // hide what lies in them.
    const Box world = world_of(box, look);
    for (const Placed& p : placed)
        if (std::holds_alternative<PlaneShape>(p.object->shape))
            add_plane(p, gatherer.holes, chunk_origin(world, 2), reach_of(world), scene);
    batches.give_to(scene);
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
        gatherer.gather(object, {.texture = &any});
    }
    ObjectAlone(const ObjectAlone&) = delete; // the gatherer refers to the other members

    Scene scene;
    Look look;
    Texture any; // nobody sees it
    Gatherer gatherer{look, scene};
};

} // namespace

/// Each ray asks all exact parts of an object, so that further ones are cut into triangles.
static constexpr size_t kMaxExactParts = 256;

CutObject cut_object(const Object& object, uint64_t max_triangles) {
    const ObjectAlone alone(object, max_triangles);
    const Gatherer& gatherer = alone.gatherer;
    const int segments = choose_segments(gatherer, alone.look.tolerance, kFineSegments);
    require_at_most(max_triangles, gatherer, segments, object.place);
    CutObject cut;
    Facets facets;
    for (const Placed& p : gatherer.placed) {
        if (const auto* plane = std::get_if<PlaneShape>(&p.object->shape))
            if (const std::optional<PlaneShape> in_world = placed_plane(*plane, p))
                cut.planes.push_back({in_world->normal, in_world->distance});
        if (const Shape* shape = std::get_if<Shape>(&p.object->shape)) {
            if (shape->exact && !p.inverse && cut.exact.size() < kMaxExactParts) {
                cut.exact.push_back({*shape->exact, rows_of(glm::inverse(p.placed))});
                cut.exact.back().shape.open = p.object->open;
                continue;
            }
            cut.inverted += p.inverse ? 1 : 0;
            facets.clear();
            shape->cut(segments, p.object->open, facets);
            add_finite(facets, p, cut.facets);
        }
    }
    const Box reach = reach_of_solids(world_of(box_of(gatherer, 8), alone.look));
    for (const Solid& solid : gatherer.solids)
        for (const SolidPart& part :
             evaluate(solid, segments, moved(reach, glm::inverse(solid.placed))))
            add_finite(part.facets, {solid.object, solid.placed, false, {}, kSeenByAll},
                       cut.facets);
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
