// SPDX-License-Identifier: Apache-2.0
// The model of fuzz_calls, which tells what each call must return for a scene, by a loop over its
// triangles; and the arguments of calls, right and wrong.
#pragma once

#include "core/exact/triangle.h"
#include "core/soup.h"
#include "tests/abi/abi.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <vector>

namespace ovc::fuzz {

#define OVC_REQUIRE(condition)                                                                     \
    ((condition) ? void(0) : ovc::fuzz::failed(#condition, __FILE__, __LINE__))

[[noreturn]] inline void failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: not so: %s\n", file, line, condition);
    std::abort();
}

using test::api;
using test::sized;

/// Choices from bytes; zeros when they are used up.
class Choices {
public:
    Choices(const uint8_t* data, size_t size) : next_(data), end_(data + size) {}

    bool over() const { return next_ == end_; }
    uint8_t byte() { return over() ? 0 : *next_++; }
    uint32_t below(uint32_t count) { return byte() % count; }
    bool once_in(uint32_t count) { return below(count) == count - 1; }
    /// Returns one of few values, so that rays meet corners, edges and ties.
    double coordinate() { return (int(byte()) - 128) / 16.0; }

private:
    const uint8_t* next_;
    const uint8_t* end_;
};

/// A handle, and what the model knows of it.
struct Slot {
    ovc_scene scene = nullptr;
    enum { Null, Open, Committed, Destroyed } state = Null;
    bool tells_active = false;
    Soup soup;
    /// One per chunk: whose corners it has, its own or another's; OVC_NONE: it was removed.
    std::vector<uint32_t> sources;
    std::deque<Chunk> removed; // whose corners instances have still

    /// Returns the result of a call that needs a committed scene, or any scene.
    ovc_result expected(bool committed) const {
        if (state == Null || state == Destroyed)
            return OVC_ERROR_INVALID_ARGUMENT;
        return state == Committed || !committed ? OVC_OK : OVC_ERROR_INVALID_STATE;
    }
    bool has_lost_meshes() const { return std::ranges::find(sources, OVC_NONE) != sources.end(); }
    bool is_there(uint32_t mesh) const {
        return mesh < sources.size() && sources[mesh] != OVC_NONE;
    }

    /// Returns the answer of a loop over all triangles.
    Hit nearest_hit(const ovc_ray& ray, const ovc_triangle& skip,
                    const HitPlace& after = {}) const {
        Ray asked;
        std::memcpy(static_cast<void*>(&asked), &ray, sizeof asked);
        if (!asked.valid())
            return {};
        const PreparedRay prepared(asked, {TriangleId{skip.mesh, skip.prim}, after});
        const bool named =
            after.id.mesh < soup.chunks.size() && after.id.prim < soup.chunks[after.id.mesh].size();
        const Triangle triangle_after = named ? soup.triangle(after.id) : Triangle();
        const bool is_there = named && triangle_fault(triangle_after) != TriangleFault::NotFinite;
        Nearest nearest(prepared, is_there ? &triangle_after : nullptr);
        for (uint32_t mesh = 0; mesh < soup.chunks.size(); ++mesh)
            for (uint32_t prim = 0; prim < soup.chunks[mesh].size(); ++prim) {
                const Triangle triangle = soup.triangle({mesh, prim});
                if (triangle_fault(triangle) != TriangleFault::NotFinite)
                    nearest.offer(triangle, {mesh, prim});
            }
        return nearest.hit();
    }
    void check_hit(const ovc_ray& ray, const ovc_triangle& skip, const ovc_hit& hit) const {
        const Hit expected = nearest_hit(ray, skip);
        OVC_REQUIRE(hit.mesh == expected.id.mesh && hit.prim == expected.id.prim);
        OVC_REQUIRE(std::memcmp(&hit.t, &expected.t, sizeof hit.t) == 0);
    }
};

inline dvec3 point_by(Choices& choices) {
    const double x = choices.coordinate(), y = choices.coordinate();
    return {x, y, choices.coordinate()};
}
inline dvec3 point_of(const Slot& slot, Choices& choices) {
    if (slot.soup.chunks.empty())
        return point_by(choices);
    const uint32_t mesh = choices.below(uint32_t(slot.soup.chunks.size()));
    if (slot.soup.chunks[mesh].size() == 0)
        return point_by(choices);
    const uint32_t prim = choices.below(uint32_t(slot.soup.chunks[mesh].size()));
    const Triangle triangle = slot.soup.triangle({mesh, prim});
    const double u = choices.below(3) / 2.0, v = (1 - u) * choices.below(3) / 2.0;
    return (1 - u - v) * triangle[0] + u * triangle[1] + v * triangle[2];
}

/// Returns rays of which most go towards the scene, at corners, sides and insides of its triangles.
inline std::vector<ovc_ray> rays_to(const Slot& slot, Choices& choices) {
    std::vector<ovc_ray> made(choices.below(40));
    for (ovc_ray& ray : made) {
        const dvec3 target = choices.once_in(4) ? point_by(choices) : point_of(slot, choices);
        const dvec3 org = point_by(choices);
        for (int axis = 0; axis < 3; ++axis) {
            ray.org[axis] = org[axis];
            ray.dir[axis] = target[axis] - org[axis];
        }
        ray.t_max = HUGE_VAL;
        if (choices.once_in(16))
            (&ray.org[0])[choices.below(8)] = choices.below(2) ? NAN : -HUGE_VAL;
    }
    return made;
}

/// Returns a triangle to skip for each ray, which for most rays is none.
inline std::vector<ovc_triangle> skips(const Slot& slot, size_t count, Choices& choices) {
    std::vector<ovc_triangle> made(count, {OVC_NONE, OVC_NONE});
    if (!slot.soup.chunks.empty())
        for (ovc_triangle& skip : made)
            if (choices.once_in(4))
                skip = {choices.below(uint32_t(slot.soup.chunks.size()) + 1),
                        choices.below(24)}; // a triangle that may not exist
    return made;
}

/// Makes a config wrong in one of several ways.
inline void spoil(ovc_scene_config& config, Choices& choices) {
    switch (choices.below(7)) {
    case 0:
        config.struct_size = choices.below(40);
        break;
    case 1:
        config.precision = 2 + choices.byte();
        break;
    case 2:
        config.structure = 1 + choices.byte();
        break;
    case 3:
        config.level1 = 1 + choices.byte();
        break;
    case 4:
        config.reserved = 1;
        break;
    case 5:
        config.kernel_variant = "packets,fragment";
        break;
    default:
        config.leaves = config.leaf_triangles = 1;
    }
}

/// Does the same to a mesh.
inline void spoil(ovc_mesh& mesh, Choices& choices) {
    switch (choices.below(5)) {
    case 0:
        mesh.struct_size = choices.below(40);
        break;
    case 1:
        mesh.stride = 1 + choices.below(11);
        break;
    case 2:
        mesh.vertex_count = mesh.triangle_count = 7;
        mesh.indices = nullptr;
        break;
    case 3:
        mesh.origin[choices.below(3)] = HUGE_VAL;
        break;
    default:
        mesh.flags |= 128;
    }
}

} // namespace ovc::fuzz
