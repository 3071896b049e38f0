// SPDX-License-Identifier: Apache-2.0
// Small soups and rays for tests of acceleration structures, and their answers by testing every
// triangle.
#pragma once

#include "core/exact/triangle.h"
#include "tests/random.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace ovc::test {

struct NamedSoup {
    std::string name;
    Soup soup;
};

inline Soup one_chunk(std::vector<vec3> corners, dvec3 origin = dvec3(0)) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(origin, std::move(corners)));
    return soup;
}

/// Returns triangles of `size` strewn over the unit cube.
inline Soup random_soup(uint64_t seed, size_t count, double size, dvec3 origin = dvec3(0)) {
    Random random(seed);
    std::vector<vec3> corners;
    for (size_t i = 0; i < count; ++i) {
        const dvec3 p = random.point(0, 1);
        for (int k = 0; k < 3; ++k)
            corners.push_back(vec3(p + random.point(-size, size)));
    }
    return one_chunk(std::move(corners), origin);
}

/// A square of a plane: what lies from `through` as far as along and across to either side.
struct Floor {
    dvec3 through;
    dvec3 along;
    dvec3 across;

    dvec3 at(double a, double b) const { return through + a * along + b * across; }

    /// Returns it as n x n quads.
    Chunk chunk(int n) const {
        const auto corner = [&](int i, int j) { return at(2.0 * i / n - 1, 2.0 * j / n - 1); };
        std::vector<dvec3> corners;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                corners.insert(corners.end(),
                               {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j),
                                corner(i + 1, j + 1), corner(i, j + 1)});
        return Chunk::owning_doubles(dvec3(0), std::move(corners));
    }
};

/// Returns a closed n x n torus-like sheet of quads, which share edges and vertices everywhere.
inline Soup closed_grid(int n, dvec3 origin = dvec3(0)) {
    const auto at = [&](int i, int j) {
        const double a = 6.283185307179586 * (i % n) / n;
        const double b = 6.283185307179586 * (j % n) / n;
        const double r = 1 + 0.4 * std::cos(b);
        return vec3(dvec3(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)));
    };
    std::vector<vec3> corners;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (const vec3& v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                  at(i + 1, j + 1), at(i, j + 1)})
                corners.push_back(v);
    return one_chunk(std::move(corners), origin);
}

/// Returns a closed grid that dips into a floor of two triangles, twenty times as wide.
inline Soup grid_on_floor(int n) {
    Soup soup = closed_grid(n);
    const std::vector<vec3> floor{{-14, -14, -0.3f}, {14, -14, -0.3f}, {14, 14, -0.3f},
                                  {-14, -14, -0.3f}, {14, 14, -0.3f},  {-14, 14, -0.3f}};
    soup.chunks.push_back(Chunk::owning(dvec3(0), floor));
    return soup;
}

/// Returns the soups that every structure must get right: ordinary and unpleasant ones.
inline std::vector<NamedSoup> unpleasant_soups() {
    std::vector<NamedSoup> soups;
    soups.push_back({"empty", one_chunk({})});
    soups.push_back({"one", random_soup(1, 1, 0.5)});
    soups.push_back({"random", random_soup(2, 3000, 0.05)});
    soups.push_back({"slivers", random_soup(3, 1000, 0.6)});
    soups.push_back({"closed", closed_grid(24)});
    soups.push_back({"far", closed_grid(24, dvec3(4.5e6, 6e6, -6))});
    soups.push_back({"floor", grid_on_floor(24)});
    std::vector<vec3> same, flat, fan, mixed;
    for (int i = 0; i < 400; ++i) {
        const float x = float(i % 20), y = float(i / 20);
        for (const vec3& v : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)}) {
            same.push_back(v);
            flat.push_back(v + vec3(x, y, 0));
        }
        const float a = float(i) * 0.0157f;
        for (const vec3& v : {vec3(0), vec3(std::cos(a), std::sin(a), 0.1f),
                              vec3(std::cos(a + 0.0157f), std::sin(a + 0.0157f), 0.1f)})
            fan.push_back(v);
        for (const vec3& v : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)})
            mixed.push_back(v * std::pow(0.93f, float(i)) + vec3(float(i % 3), 0, 0));
    }
    mixed.insert(mixed.end(), {vec3(NAN, 0, 0), vec3(1), vec3(2)});
    mixed.insert(mixed.end(), {vec3(0), vec3(1), vec3(2)});
    mixed.insert(mixed.end(), {vec3(-500, -500, -1), vec3(500, -500, -1), vec3(0, 900, -1)});
    soups.push_back({"coincident", one_chunk(std::move(same))});
    soups.push_back({"flat", one_chunk(std::move(flat))});
    soups.push_back({"fan", one_chunk(std::move(fan))});
    soups.push_back({"mixed sizes", one_chunk(std::move(mixed))});
    return soups;
}

/// Returns rays at, into, along and past the soup. Some aim at vertices and edges, some go along
/// axes or in planes, and some are invalid.
inline std::vector<Ray> unpleasant_rays(const Soup& soup, uint64_t seed, size_t count) {
    Random random(seed);
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    if (ids.empty())
        bounds = {dvec3(0), dvec3(1)};
    const double size = std::max(max_component(bounds.extent()), 1e-30);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        Ray ray;
        ray.org = bounds.center() + random.point(-1.5, 1.5) * size;
        dvec3 target = bounds.center() + random.point(-0.5, 0.5) * bounds.extent();
        if (!ids.empty() && i % 2) {
            const Triangle t = soup.triangle(ids[random.below(ids.size())]);
            const double w = i % 4 == 1 ? 0 : random(0, 1);
            target = t[0] + w * (t[1] - t[0]);
        }
        ray.dir = target - ray.org;
        switch (i % 12) {
        case 5:
            ray.org = target; // starts on the surface
            ray.dir = random.point(-1, 1);
            break;
        case 7:
            ray.dir = dvec3(0);
            ray.dir[int(random.below(3))] = random.below(2) ? 1 : -1;
            ray.org = target - ray.dir * (2 * size);
            break;
        case 8:
            ray.dir[int(random.below(3))] = random.below(2) ? 0.0 : -0.0;
            break;
        case 9:
            ray.t_min = random(0, 1);
            ray.t_max = ray.t_min + random(0, 1);
            break;
        case 10:
            ray.dir *= random.below(2) ? 1e-30 : 1e30;
            break;
        case 11:
            if (i % 36 == 11)
                ray.dir = dvec3(0);
            else if (i % 36 == 23)
                ray.org.y = NAN;
            else
                ray.t_max = -1;
            break;
        default:
            break;
        }
        rays.push_back(ray);
    }
    return rays;
}

/// Returns the nearest hit, found by testing every triangle.
inline Hit brute_force(const Soup& soup, const std::vector<TriangleId>& ids, const Ray& ray,
                       TriangleId skip = {}) {
    if (!ray.valid())
        return {};
    const PreparedRay p(ray, skip);
    Nearest nearest(p);
    for (const TriangleId id : ids)
        nearest.offer(soup.triangle(id), id);
    return nearest.hit();
}

inline bool same(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.id == b.id;
}

inline std::string describe(const Hit& h) {
    return h.is_hit() ? "t " + std::to_string(h.t) + " mesh " + std::to_string(h.id.mesh) +
                            " prim " + std::to_string(h.id.prim)
                      : "miss";
}

} // namespace ovc::test
