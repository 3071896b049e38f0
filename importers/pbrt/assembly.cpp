// SPDX-License-Identifier: Apache-2.0
// assemble() collects shapes in runs, places them, and writes their corners and normals.
#include "importers/pbrt/assembly.h"

#include "core/system/parallel.h"
#include "importers/origin.h"
#include "importers/pbrt/runs.h"

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

namespace {

Box bounds_of(const Object& object) {
    Box bounds;
    for (const Shape& shape : object.shapes)
        bounds.add(parallel_reduce(
            shape.mesh.size() * 3, Box{},
            [&](size_t first, size_t last, Box box) {
                for (size_t c = first; c < last; ++c)
                    if (const dvec3 p = point_through(shape.to_object, shape.mesh.corner(c));
                        ovc::is_finite(p))
                        box.add(p);
                return box;
            },
            [](Box a, const Box& b) {
                a.add(b);
                return a;
            }));
    return bounds;
}

Box moved(const Box& box, const dmat4& by) {
    Box result;
    for (int i = 0; i < 8 && !box.empty(); ++i) {
        const dvec3 corner(i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                           i & 4 ? box.hi.z : box.lo.z);
        if (const dvec3 p = point_through(by, corner); ovc::is_finite(p))
            result.add(p);
    }
    return result;
}

/// Returns the size of an instance, the same however it is turned: at least half of any extent.
double size_of(const Box& local, const dmat4& place) {
    double squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(dvec3(place[column]), dvec3(place[column]));
    return glm::length(local.extent()) * std::sqrt(squares / 3);
}

Frame frame_of(const Box& local, const dmat4& place, const dvec3& common) {
    const Frame shared{common};
    const Box box = moved(local, place);
    const double size = size_of(local, place);
    if (box.empty() || !(size > 1e-200) || !(size < 1e200))
        return shared;
    const dvec3 middle = box.center();
    if (max_component(glm::abs(middle - common)) <= kFar * max_component(box.extent()))
        return shared;
    // 2^24 steps reach over an offset, which is no larger than `size`. The size is raised a little,
    // so that instances whose sizes differ by a rounding have the same lattice.
    const double lattice = std::ldexp(1.0, std::ilogb(size * 1.000001) + 1 - 24);
    return {glm::round(middle / lattice) * lattice, lattice};
}

struct PlacedObject {
    uint32_t object;
    dmat4 place;
};

/// Returns whether the matrix has no projective part, so that it fits into an instance's transform.
bool is_affine(const dmat4& m) {
    return m[0].w == 0 && m[1].w == 0 && m[2].w == 0 && m[3].w == 1;
}

/// Returns the instances that have shapes, nested ones included, outermost first.
std::vector<PlacedObject> placed_objects(const World& world, const Census& census) {
    std::vector<PlacedObject> found;
    std::vector<PlacedObject> open;
    const auto add = [&](const Object& object, const dmat4& place) {
        for (auto i = object.instances.rbegin(); i != object.instances.rend(); ++i)
            if (census.within[i->object] > 0)
                open.push_back({i->object, place * i->to_parent});
    };
    add(world.top, dmat4(1));
    while (!open.empty()) {
        const PlacedObject next = open.back();
        open.pop_back();
        if (!world.objects[next.object].shapes.empty())
            found.push_back(next);
        add(world.objects[next.object], next.place);
    }
    return found;
}

std::vector<vec3> normals_of(const Object& object, const Run& run, bool mirrored_place) {
    std::vector<vec3> normals(run.has_normals ? size_t(run.triangles) * 3 : 0);
    vec3* to = normals.data();
    for (size_t i = run.first; i < run.last && run.has_normals; ++i) {
        write_normals(object.shapes[i], mirrored_place, 0, object.shapes[i].mesh.size(), to);
        to += 3 * object.shapes[i].mesh.size();
    }
    assert(to == normals.data() + normals.size());
    return normals;
}

/// Returns texture coordinates in the order of write_corners(); none where nothing wants them.
std::vector<vec2> uv_of(const Object& object, const Run& run, bool mirrored_place) {
    std::vector<vec2> uv;
    for (size_t i = run.first; i < run.last && run.sight.wants_uv; ++i)
        append_uv(object.shapes[i], mirrored_place, uv);
    return uv;
}

/// Tells the mesh which rays see it; its texture coordinates are the caller's to set.
void set_sight(const Run& run, uint32_t mesh, Scene& scene) {
    scene.meshes[mesh].cutout = run.sight.cutout;
    scene.meshes[mesh].shadow_cutout = run.sight.shadow_cutout;
    scene.show(mesh, run.sight.seen_by);
}

std::vector<vec3> corners_of(const Object& object, const Run& run, const dmat4& place,
                             const Frame& frame, bool mirrored_place = false) {
    std::vector<vec3> corners(size_t(run.triangles) * 3);
    vec3* to = corners.data();
    for (size_t i = run.first; i < run.last; ++i) {
        write_corners(object.shapes[i], place, frame, mirrored_place, to);
        to += 3 * object.shapes[i].mesh.size();
    }
    assert(to == corners.data() + corners.size());
    return corners;
}

const std::string& name_of(const Object& object, const Run& run) {
    return run.last == run.first + 1 && !run.name.empty() ? run.name : object.name;
}

/// Adds the world's own shapes. Each run's memory moves to the soup or is given back before the
/// next run is taken.
void add_top(Object& top, const Frame& frame, Scene& scene) {
    for (const Run& run : runs_of(top)) {
        std::string name = name_of(top, run);
        std::vector<vec3> normals = normals_of(top, run, /* mirrored_place= */ false);
        std::vector<vec2> uv = uv_of(top, run, /* mirrored_place= */ false);
        std::vector<vec3> corners;
        Mesh& first = top.shapes[run.first].mesh;
        if (run.last == run.first + 1 && !first.is_indexed()) {
            write_corners(top.shapes[run.first], dmat4(1), frame, /* mirrored_place= */ false,
                          first.corners.data());
            corners = std::move(first.corners);
        } else {
            corners = corners_of(top, run, dmat4(1), frame);
        }
        for (size_t i = run.first; i < run.last; ++i)
            top.shapes[i].mesh = {};
        const uint32_t mesh =
            scene.add_mesh(std::move(name), run.material,
                           Chunk::owning(frame.origin, std::move(corners)), std::move(normals));
        scene.meshes[mesh].uv = std::move(uv);
        set_sight(run, mesh, scene);
        run.tell_left_out(scene.meshes[mesh]);
    }
}

/// Returns a chunk of the run's corners in the object's own coordinates, placed by the instance's
/// transform, which must be affine. The first such chunk owns the corners; later ones borrow them.
Chunk placed_chunk(const Object& object, const Run& run, const PlacedObject& instance,
                   const Frame& frame, bool mirrored, const Scene& scene) {
    assert(is_affine(instance.place));
    const uint32_t from = run.corners_from[mirrored];
    assert(from == kNone || from < scene.soup.chunks.size());
    Chunk chunk = from != kNone ? scene.soup.chunks[from].unplaced()
                                : Chunk::owning(frame.origin,
                                                corners_of(object, run, dmat4(1), frame, mirrored));
    ovc::Transform rows{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            rows.rows[size_t(row)][size_t(column)] = instance.place[column][row];
    chunk.place(rows);
    return chunk;
}

/// Gives an instance's mesh its texture coordinates, of which all that are not mirrored share one.
void share_uv(const Object& object, Run& run, bool mirrored, uint32_t mesh, Scene& scene) {
    if (!run.sight.wants_uv)
        return;
    if (!mirrored && run.uv_from != kNone) {
        scene.meshes[mesh].uv_from = run.uv_from;
        return;
    }
    scene.meshes[mesh].uv = uv_of(object, run, mirrored);
    if (!mirrored)
        run.uv_from = mesh;
}

/// Adds an instance's meshes. `frame` is that of the corners: the object's if the instances share
/// them, else one in the world.
void add_instance(const Object& object, std::vector<Run>& runs, const PlacedObject& instance,
                  const Frame& frame, bool shares_corners, MeshOutput& output) {
    Scene& scene = output.scene();
    const bool mirrored = swaps_handedness(instance.place);
    dmat3 turn = normal_matrix(instance.place);
    const double largest =
        std::max({max_component(glm::abs(turn[0])), max_component(glm::abs(turn[1])),
                  max_component(glm::abs(turn[2]))});
    turn = largest > 0 && largest < 1e300 ? turn / largest : dmat3(1);
    for (Run& run : runs) {
        const bool shares = run.has_normals && !mirrored && run.normals_from != kNone;
        Chunk chunk =
            shares_corners
                ? placed_chunk(object, run, instance, frame, mirrored, scene)
                : Chunk::owning(frame.origin, corners_of(object, run, instance.place, frame));
        const uint32_t mesh =
            output.add_mesh(name_of(object, run), run.material, std::move(chunk),
                            shares ? std::vector<vec3>() : normals_of(object, run, mirrored));
        if (shares_corners && run.corners_from[mirrored] == kNone)
            run.corners_from[mirrored] = mesh;
        run.tell_left_out(scene.meshes[mesh]);
        set_sight(run, mesh, scene);
        share_uv(object, run, mirrored, mesh, scene);
        if (!run.has_normals)
            continue;
        scene.meshes[mesh].turn = turn;
        if (shares)
            scene.meshes[mesh].normals_from = run.normals_from;
        else if (!mirrored)
            run.normals_from = mesh;
    }
}

/// Adds the world's own shapes that are streamed.
void add_streamed(Object& top, StreamedShapes& shapes, const Frame& frame, MeshOutput& output) {
    for (size_t i = 0; i < shapes.runs().size() && output.is_wanted(); ++i) {
        const Run& run = shapes.runs()[i];
        const uint32_t mesh = output.begin_mesh(name_of(top, run), run.material, frame.origin);
        shapes.pass_on(i, frame, output);
        output.scene().meshes[mesh].uv = shapes.take_uv(i);
        set_sight(run, mesh, output.scene());
        run.tell_left_out(output.scene().meshes[mesh]);
    }
}

} // namespace

void assemble(World world, const Census& census, MeshOutput& output, StreamedShapes* streamed) {
    assert(census.within.size() == world.objects.size());
    assert(census.shared.size() == world.objects.size());
    const std::vector<PlacedObject> instances = placed_objects(world, census);
    std::vector<Box> boxes;
    std::vector<std::vector<Run>> runs;
    for (const Object& object : world.objects) {
        boxes.push_back(bounds_of(object));
        runs.push_back(runs_of(object));
    }
    Box bounds = streamed ? streamed->bounds() : bounds_of(world.top);
    for (const PlacedObject& p : instances)
        bounds.add(moved(boxes[p.object], p.place));
    const Frame common{chunk_origin(bounds, kFar)};

    if (streamed)
        add_streamed(world.top, *streamed, common, output);
    else
        add_top(world.top, common, output.scene());
    for (const PlacedObject& p : instances) {
        const Box& box = boxes[p.object];
        const bool shares_corners = census.shared[p.object] && is_affine(p.place);
        assert(!shares_corners || !streamed);
        add_instance(world.objects[p.object], runs[p.object], p,
                     shares_corners ? Frame{chunk_origin(box, kFar)}
                                    : frame_of(box, p.place, common.origin),
                     shares_corners, output);
    }
}

} // namespace ovc::pbrt
