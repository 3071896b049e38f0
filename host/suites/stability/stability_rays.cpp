// SPDX-License-Identifier: Apache-2.0
// Makes the rays of the stability suite.
#include "host/suites/stability/stability_rays.h"

#include "core/exact/triangle.h"

#include <cassert>
#include <cmath>

namespace ovc {

namespace {

dvec3 as_float(dvec3 v) {
    return dvec3(vec3(v));
}

dvec3 snapped(dvec3 p, double grid) {
    return grid > 0 ? glm::round(p / grid) * grid : p;
}

/// One chunk in its own coordinates.
class Local {
public:
    explicit Local(const Soup& soup, uint32_t chunk = 0)
        : chunk_(soup.chunks[chunk]), mesh_(chunk) {
        assert(chunk < soup.chunks.size());
    }

    Triangle triangle(uint32_t prim) const {
        const vec3* c = &chunk_.corners()[size_t(prim) * 3];
        return {dvec3(c[0]), dvec3(c[1]), dvec3(c[2])};
    }
    uint32_t size() const { return chunk_.size(); }
    TriangleId id(uint32_t prim) const { return {mesh_, prim}; }

    /// Returns the ray from one local point through another.
    Ray ray(dvec3 from, dvec3 to) const { return towards(from, to - as_float(from)); }
    Ray towards(dvec3 from, dvec3 dir) const {
        Ray ray;
        ray.org = chunk_.origin() + as_float(from);
        ray.dir = as_float(dir);
        return ray;
    }

private:
    const Chunk& chunk_;
    uint32_t mesh_;
};

dvec3 normal_of(const Triangle& t) {
    return glm::cross(t[1] - t[0], t[2] - t[0]);
}

/// A closed mesh that knows which side of its triangles is inside.
class ClosedMesh : public Local {
public:
    explicit ClosedMesh(const Soup& soup) : Local(soup) {
        double volume = 0;
        for (uint32_t prim = 0; prim < size(); ++prim)
            volume += glm::dot(triangle(prim)[0], normal_of(triangle(prim)));
        in_ = volume > 0 ? -1 : 1;
    }

    /// Returns the point a twentieth of the triangle's shortest edge below its middle.
    dvec3 below(uint32_t prim) const {
        const Triangle t = triangle(prim);
        const double edge = std::min(
            {glm::length(t[1] - t[0]), glm::length(t[2] - t[1]), glm::length(t[0] - t[2])});
        return (t[0] + t[1] + t[2]) / 3.0 + 0.05 * edge * in_ * glm::normalize(normal_of(t));
    }

private:
    double in_;
};

Ray closed_mesh_ray(const ClosedMesh& mesh, Random& random, const Aim& aim) {
    const uint32_t prim = random.below(mesh.size());
    const dvec3 target = point_of(mesh.triangle(prim), random, aim.target);
    const uint32_t other = random.chance(0.5) ? prim : random.below(mesh.size());
    const dvec3 in = mesh.below(other);
    if (aim.side == Side::Inside)
        return mesh.ray(snapped(in, aim.grid), target);
    const double away = std::exp2(random.uniform(-1, 7));
    return mesh.ray(snapped(target + away * (target - in), aim.grid), target);
}

double log_uniform(Random& random, double from, double to) {
    return std::pow(10.0, random.uniform(from, to));
}

/// Returns `count` rays, each made by one call.
template <class Make>
AimedRays collect(size_t count, const Make& make) {
    AimedRays set;
    set.rays.reserve(count);
    while (set.rays.size() < count)
        set.rays.push_back(make());
    return set;
}

} // namespace

dvec3 point_of(const Triangle& t, Random& random, Target target) {
    const uint32_t k = random.below(3);
    const dvec3 a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    const uint32_t kind = target == Target::Any ? random.below(3) : target == Target::Edges;
    if (kind == 0)
        return a;
    const double w = random.chance(0.5) ? (1 + random.below(7)) / 8.0 : random.uniform();
    const dvec3 on_edge = a + w * (b - a);
    return as_float(kind == 1 ? on_edge : on_edge + random.uniform() * (c - on_edge));
}

AimedRays closed_mesh_rays(const Soup& soup, Random& random, size_t count, const Aim& aim) {
    const ClosedMesh mesh(soup);
    return collect(count, [&] { return closed_mesh_ray(mesh, random, aim); });
}

AimedRays any_closed_mesh_rays(const Soup& soup, Random& random, size_t count) {
    const ClosedMesh mesh(soup);
    return collect(count, [&] {
        const Side side = random.chance(0.5) ? Side::Inside : Side::Outside;
        return closed_mesh_ray(mesh, random, {side, Target::Any, 0});
    });
}

AimedRays edge_and_vertex_rays(const Soup& soup, Random& random, size_t count, double grid) {
    const ClosedMesh mesh(soup);
    return collect(count, [&] {
        const Side side = random.chance(0.5) ? Side::Inside : Side::Outside;
        const Target target = random.chance(0.5) ? Target::Vertices : Target::Edges;
        return closed_mesh_ray(mesh, random, {side, target, grid});
    });
}

AimedRays rays_at_triangles(const Soup& soup, Random& random, size_t count) {
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    const double all = max_component(bounds.extent());
    return collect(count, [&] {
        const TriangleId id = ids[random.below(uint32_t(ids.size()))];
        const Local local(soup, id.mesh);
        const Triangle t = local.triangle(id.prim);
        const double own = max_component(bounds_of(t).extent());
        const dvec3 target = point_of(t, random, Target::Any);
        const double share = random.uniform();
        const double away = 2 * std::exp(std::log(own) * (1 - share) + std::log(all) * share);
        return local.ray(target + away * random.direction(), target);
    });
}

AimedRays grazing_rays(const Soup& soup, Random& random, size_t count, double height) {
    const Local sheet(soup);
    const dvec3 up = glm::normalize(normal_of(sheet.triangle(0)));
    return collect(count, [&] {
        const uint32_t prim = random.below(sheet.size());
        const dvec3 target = 0.9 * point_of(sheet.triangle(prim), random, Target::Any);
        const dvec3 along = glm::normalize(glm::cross(up, random.direction()));
        return sheet.ray(as_float(target + along) + height * up, as_float(target));
    });
}

AimedRays strip_rays(const Soup& soup, Random& random, size_t count) {
    const Local strip(soup);
    assert(strip.size() > 4);
    const uint32_t inner = strip.size() - 4; // without the first and the last row
    return collect(count, [&] {
        dvec3 target(0);
        while (target.x == 0 || target.x == 1) // at the rim a rounded ray may miss
            target = point_of(strip.triangle(2 + random.below(inner)), random, Target::Any);
        const double y = strip.triangle(random.below(strip.size()))[1].y;
        return strip.ray({random.uniform(), y, random.chance(0.5) ? 1 : -1}, target);
    });
}

AimedRays fan_rays(const Soup& soup, Random& random, size_t count) {
    const Local cone(soup);
    return collect(count, [&] {
        const dvec3 on = point_of(cone.triangle(random.below(cone.size())), random, Target::Any);
        const dvec3 target = random.chance(0.25) ? dvec3(0) : as_float(0.9 * on);
        return cone.ray(dvec3(0.2, 0.2, 1) * random.in_ball() + dvec3(0, 0, 2), target);
    });
}

/// Makes half of the components that are zero -0.
static Ray with_signed_zeros(Ray ray, Random& random) {
    for (int axis = 0; axis < 3; ++axis)
        if (ray.dir[axis] == 0 && random.chance(0.5))
            ray.dir[axis] = -0.0;
    return ray;
}

AimedRays axis_rays(const Soup& soup, Random& random, size_t count) {
    const Local box(soup);
    return collect(count, [&] {
        dvec3 from, dir(0);
        for (int axis = 0; axis < 3; ++axis)
            from[axis] = (1 + random.below(7)) / 8.0;
        const uint32_t axis = random.below(3);
        dir[int(axis)] = random.chance(0.5) ? 1 : -1;
        if (random.chance(0.3))
            dir[int(axis + 1) % 3] = random.chance(0.5) ? 0.5 : -1;
        return with_signed_zeros(box.towards(from, dir), random);
    });
}

AimedRays in_plane_rays(const Soup& soup, Random& random, size_t count) {
    const Local box(soup);
    return collect(count, [&] {
        const int axis = int(random.below(3));
        dvec3 from, dir(0);
        from[axis] = random.below(2);
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
            from[other] =
                random.chance(0.5) ? (1 + random.below(7)) / 8.0 : random.uniform(0.01, 0.99);
            dir[other] = int(random.below(3)) - 1;
        }
        dir[(axis + 1) % 3] += dir == dvec3(0);
        return with_signed_zeros(box.towards(from, dir), random);
    });
}

AimedRays surface_rays(const Soup& soup, Random& random, size_t count, Start start, bool skip,
                       bool inwards) {
    const ClosedMesh mesh(soup);
    AimedRays set;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t prim = random.below(mesh.size());
        const Target target = start == Start::Vertex ? Target::Vertices : Target::Any;
        const dvec3 from = point_of(mesh.triangle(prim), random, target);
        set.rays.push_back(inwards ? mesh.ray(from, mesh.below(random.below(mesh.size())))
                                   : mesh.towards(from, random.direction()));
        // The range begins behind the triangles that the ray starts on, so that it must find the
        // far side.
        if (inwards && i % 2)
            set.rays.back().t_min = 0x1p-20;
        if (skip)
            set.skip.push_back(mesh.id(prim));
    }
    return set;
}

AimedRays range_rays(const Soup& soup, Random& random, size_t count) {
    AimedRays set = rays_at_triangles(soup, random, count);
    const Local mesh(soup);
    for (Ray& ray : set.rays) {
        // One triangle is tested by itself, so that t is the reference's own.
        const uint32_t prim = random.below(mesh.size());
        const Triangle local = mesh.triangle(prim);
        ray = mesh.ray(local[0] + 2.0 * random.direction(), (local[0] + local[1] + local[2]) / 3.0);
        const auto met = candidate(PreparedRay(ray), soup.triangle(mesh.id(prim)), mesh.id(prim));
        if (!met)
            continue;
        const double hit = met->hit.t;
        const double t =
            std::array{std::nextafter(hit, 0.0), hit, std::nextafter(hit, 1e308)}[random.below(3)];
        (random.chance(0.5) ? ray.t_min : ray.t_max) = t;
    }
    return set;
}

AimedRays long_direction_rays(const Soup& soup, Random& random, size_t count, double from,
                              double to) {
    AimedRays set = any_closed_mesh_rays(soup, random, count);
    for (Ray& ray : set.rays)
        ray.dir = as_float(ray.dir * log_uniform(random, from, to));
    return set;
}

AimedRays bad_rays(const Soup& soup, Random& random, size_t count) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    AimedRays set = any_closed_mesh_rays(soup, random, count);
    for (size_t i = 0; i < count; ++i) {
        Ray& ray = set.rays[i];
        const double bad = std::array{std::nan(""), inf, -inf}[i / 10 % 3];
        const int field = int(i % 10);
        switch (field) {
        case 6:
            ray.t_min = bad;
            break;
        case 7:
            ray.t_max = bad > 0 ? std::nan("") : bad; // an infinite t_max would be valid
            break;
        case 8:
            ray.dir = dvec3(0, -0.0, 0);
            break;
        case 9:
            ray.t_min = 2;
            ray.t_max = 1;
            break;
        default:
            (field < 3 ? ray.org : ray.dir)[field % 3] = bad;
        }
    }
    return set;
}

} // namespace ovc
