// SPDX-License-Identifier: Apache-2.0
#include "tests/oracle/cases.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ovc::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Corner operator+(const Corner& a, const Corner& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Corner operator-(const Corner& a, const Corner& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Corner operator*(double s, const Corner& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
Corner in_floats(const Corner& a) {
    return {double(float(a[0])), double(float(a[1])), double(float(a[2]))};
}

ovc_ray ray_of(const Corner& org, const Corner& dir) {
    return {{org[0], org[1], org[2]}, 0, {dir[0], dir[1], dir[2]}, kInfinity};
}

/// Returns a point at a vertex, on an edge, inside a triangle, or near one of these.
Corner target(Random& random, std::span<const Triangle> triangles) {
    const auto& c = triangles[random.below(triangles.size())].corners;
    const size_t i = random.below(3);
    switch (random.below(5)) {
    case 0:
        return c[i];
    case 1:
        return 0.5 * (c[i] + c[(i + 1) % 3]);
    case 2:
        return c[i] + random(0, 1) * (c[(i + 1) % 3] - c[i]);
    case 3:
        return c[i] + random(-1e-9, 1e-9) * (c[(i + 1) % 3] - c[(i + 2) % 3]);
    default: {
        const double u = random(0, 1), v = random(0, 1) * (1 - u);
        return c[0] + (u * (c[1] - c[0]) + v * (c[2] - c[0]));
    }
    }
}

Corner center(std::span<const Triangle> triangles) {
    Corner sum{};
    for (const Triangle& t : triangles)
        sum = sum + (1.0 / double(triangles.size())) * t.corners[0];
    return sum;
}

/// Returns the largest absolute coordinate relative to `from`.
double reach(std::span<const Triangle> triangles, const Corner& from) {
    double most = 0;
    for (const Triangle& t : triangles)
        for (const Corner& c : t.corners)
            for (const double x : c - from)
                most = std::max(most, std::abs(x));
    return most;
}

/// Returns a ray that comes from a few sizes of the scene away.
ovc_ray aimed(Random& random, std::span<const Triangle> triangles) {
    const Corner middle = center(triangles);
    const Corner org = middle + random.point(3 * reach(triangles, middle));
    return ray_of(org, target(random, triangles) - org);
}

/// Returns a ray with ends at hits or one rounding beside them, with zeros of either sign, or with
/// an origin on a triangle.
ovc_ray with_ends(Random& random, std::span<const Triangle> triangles) {
    ovc_ray ray = aimed(random, triangles);
    const double ends[] = {
        0.0,    -0.0,  1,           std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), -1,
        5e-324, 1e300, random(0, 2)};
    ray.t_min = ends[random.below(std::size(ends))];
    ray.t_max = random.below(3) ? kInfinity : ends[random.below(std::size(ends))];
    if (ray.t_max < ray.t_min)
        std::swap(ray.t_min, ray.t_max);
    if (random.below(3) == 0) { // The ray begins at its target.
        const Corner on = target(random, triangles);
        std::copy(on.begin(), on.end(), ray.org);
    }
    for (double& x : ray.dir)
        if (random.below(4) == 0)
            x = random.below(2) ? 0.0 : -0.0;
    if (ray.dir[0] == 0 && ray.dir[1] == 0 && ray.dir[2] == 0)
        ray.dir[random.below(3)] = -1;
    return ray;
}

/// Returns a ray with components that are tiny beside the others, some of them denormal.
ovc_ray with_tiny_parts(Random& random, std::span<const Triangle> triangles) {
    ovc_ray ray = aimed(random, triangles);
    const double tiny[] = {5e-324, 1e-310, 1e-300, 1e-160, 1e-30};
    const auto shrink = [&](double& x) {
        if (random.below(3) == 0)
            x = (random.below(2) ? 1 : -1) * tiny[random.below(std::size(tiny))] *
                double(1 + random.below(3));
    };
    for (double& x : ray.dir)
        shrink(x);
    for (double& x : ray.org)
        shrink(x);
    ray.dir[random.below(3)] = random.below(2) ? 1 : -0.75;
    return ray;
}

ovc_ray from_afar(Random& random, std::span<const Triangle> triangles) {
    const double distances[] = {1e4, 1e9, 1e16, 1e40, 1e100, 1e300};
    const double far = distances[random.below(std::size(distances))];
    const Corner at = target(random, triangles);
    Corner away = random.point();
    for (double& x : away)
        if (random.below(2))
            // The origin then has the target's coordinate, to the last bit.
            x = 0;
    if (away == Corner{})
        away[random.below(3)] = 1;
    ovc_ray ray = ray_of(at + far * away, -1.0 * away);
    ray.t_min = random.below(2) ? 0 : -1e305;
    return ray;
}

/// Returns a ray of the shortest directions, of which doubles tell no t beyond 1.8e8 away.
ovc_ray barely_moving(Random& random, std::span<const Triangle> triangles) {
    const double distances[] = {1, 1e3, 1e7, 1e8};
    const Corner at = target(random, triangles);
    const Corner away = random.point(distances[random.below(std::size(distances))]);
    ovc_ray ray = ray_of(at + away, -1.0 * away);
    const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const double longest = std::abs(*std::max_element(ray.dir, ray.dir + 3, by_size));
    for (double& x : ray.dir)
        x *= 1.5e-300 / longest;
    return ray;
}

ovc_ray from_the_lattice(Random& random, std::span<const Triangle> triangles) {
    Corner org = random.lattice(), dir = random.lattice();
    if (random.below(2))
        dir = target(random, triangles) - org;
    if (dir == Corner{})
        dir = {0, 0, 1};
    return ray_of(org, dir);
}

std::vector<Mesh> soup(Random& random) {
    Mesh mesh{.in_floats = true};
    for (int i = 0; i < 80; ++i) {
        const Corner at = random.point();
        for (int k = 0; k < 3; ++k)
            mesh.corners.push_back(in_floats(at + random.point(0.2)));
    }
    return {mesh};
}

std::vector<Mesh> slivers(Random& random) {
    Mesh mesh;
    for (int i = 0; i < 60; ++i) {
        const Corner a = random.point(), along = random.point();
        const double thin = std::pow(10.0, -double(random.below(18)));
        mesh.corners.insert(mesh.corners.end(),
                            {a, a + along, a + (random(-0.5, 1.5) * along + random.point(thin))});
    }
    return {mesh};
}

Corner rotated(const std::array<Corner, 3>& rows, const Corner& p) {
    Corner q;
    for (size_t i = 0; i < 3; ++i)
        q[i] = rows[i][0] * p[0] + rows[i][1] * p[1] + rows[i][2] * p[2];
    return q;
}

/// Makes a box as CAD programs write it. The triangles of a face meet those of the next in
/// T-junctions, which triangles with corners on a line close. After a rotation, these corners are
/// on a line only up to a rounding.
std::vector<Mesh> collinear(Random& random) {
    Mesh mesh;
    std::array<Corner, 3> rows;
    for (Corner& row : rows)
        row = random.point();
    const auto put = [&](const Corner& a, const Corner& b, const Corner& c) {
        for (const Corner& corner : {a, b, c})
            mesh.corners.push_back(rotated(rows, corner));
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto at = [&](double x, double y) {
                Corner p;
                p[size_t(axis)] = side;
                p[size_t(axis + 1) % 3] = x;
                p[size_t(axis + 2) % 3] = y;
                return p;
            };
            put(at(-1, -1), at(1, -1), at(1, 1));
            put(at(-1, -1), at(1, 1), at(-1, 1));
            Corner last = at(-1, -1);
            for (int i = 1; i <= 4; ++i) { // Slivers lie along two sides.
                const double x = i == 4 ? 1 : random(-1 + 0.4 * i, -0.8 + 0.4 * i);
                put(last, at(x, -1), at(1, -1));
                put(at(-1, x), at(x, 1), at(-1, 1));
                last = at(x, -1);
            }
        }
    return {mesh};
}

std::vector<Mesh> denormals(Random& random) {
    Mesh mesh{.in_floats = true};
    const double sizes[] = {1e-44, 1e-40, 1e-38, 1e-30};
    for (int i = 0; i < 60; ++i) {
        const double size = sizes[random.below(std::size(sizes))];
        const Corner at = random.point(size);
        for (int k = 0; k < 3; ++k)
            mesh.corners.push_back(in_floats(at + random.point(size)));
    }
    return {mesh};
}

std::vector<Mesh> extremes(Random& random) {
    Mesh mesh;
    const double sizes[] = {0x1p-254, 0x1p-240, 0x1p-100, 1, 0x1p100, 0x1p254};
    const double size = sizes[random.below(std::size(sizes))];
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 3; ++k)
            mesh.corners.push_back(size * random.lattice());
    return {mesh};
}

std::vector<Mesh> mixed_sizes(Random& random) {
    Mesh mesh;
    for (int i = 0; i < 60; ++i) {
        const double size = std::ldexp(1.0, int(random.below(120)) - 60);
        const Corner at = random.point(size);
        for (int k = 0; k < 3; ++k)
            mesh.corners.push_back(at + random.point(size));
    }
    return {mesh};
}

/// Makes triangles that overlap in planes, and each of them again in another mesh.
std::vector<Mesh> coplanar(Random& random) {
    Mesh mesh;
    for (int plane = 0; plane < 3; ++plane) {
        const Corner at = random.lattice(), u = random.lattice(), v = random.lattice();
        for (int i = 0; i < 16; ++i)
            for (int k = 0; k < 3; ++k)
                mesh.corners.push_back(at +
                                       (double(random.below(5)) * u + double(random.below(5)) * v));
    }
    Mesh again = mesh;
    std::reverse(again.corners.begin(), again.corners.end());
    return {mesh, again};
}

/// Makes triangles around a hub.
std::vector<Mesh> fan(Random& random) {
    Mesh mesh{.in_floats = true};
    const Corner hub = random.lattice();
    Corner last = in_floats(random.point());
    for (int i = 0; i < 60; ++i) {
        const Corner next = in_floats(random.point());
        for (const Corner& c : {hub, last, next})
            mesh.corners.push_back(c);
        last = next;
    }
    return {mesh};
}

/// Makes copies of a triangle that are a few roundings apart.
std::vector<Mesh> copies(Random& random) {
    Mesh mesh;
    std::array<Corner, 3> corners{random.point(), random.point(), random.point()};
    for (int i = 0; i < 60; ++i)
        for (Corner corner : corners) {
            for (double& x : corner)
                for (uint64_t k = random.below(4); k > 0; --k)
                    x = std::nextafter(x, 10.0);
            mesh.corners.push_back(corner);
        }
    return {mesh};
}

std::vector<Mesh> instances(Random& random) {
    std::vector<Mesh> meshes = soup(random);
    meshes[0].corners.resize(30);
    for (int i = 0; i < 8; ++i) {
        std::array<double, 12> m{};
        const uint64_t kind = random.below(5);
        for (size_t j = 0; j < 12; ++j) {
            const bool diagonal = j % 5 == 0 && j < 11, shift = j % 4 == 3;
            m[j] = shift ? random(-1, 1) : diagonal || kind > 1 ? random(-1, 1) : 0;
        }
        if (kind == 1) // This transform is very uneven.
            m[0] *= 1e4;
        if (kind == 2) // This transform is nearly flat.
            for (size_t j = 0; j < 4; ++j)
                m[j] = m[4 + j] + (j == 3 ? 0 : random(-1e-15, 1e-15));
        if (kind == 3) // The instance is exactly where the mesh is.
            m = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        meshes[0].instances.push_back(m);
    }
    return meshes;
}

/// Makes instances with meshes large enough for shared pages, some in the same place, and with
/// duplicates in the mesh.
std::vector<Mesh> shared_instances(Random& random) {
    Mesh mesh;
    for (int i = 0; i < 100; ++i) {
        const Corner at = random.lattice();
        for (int k = 0; k < 3; ++k)
            mesh.corners.push_back(at + 0.5 * random.lattice());
    }
    // Every other triangle comes again, wound the other way.
    for (size_t i = 0; i < 90; ++i)
        mesh.corners.push_back(mesh.corners[6 * (i / 3) + 2 - i % 3]);
    for (int i = 0; i < 8; ++i) {
        const double shift = double(random.below(2));
        const double turned = random.below(3) == 0 ? -1 : 1;
        mesh.instances.push_back({turned, 0, 0, shift, 0, turned, 0, 0, 0, 0, 1, 0});
    }
    return {mesh};
}

/// Makes instances so far apart that many are out of reach of a ray that barely moves: up to 10 to
/// the power of kMaxPower.
template <int kMaxPower>
std::vector<Mesh> spread_instances(Random& random) {
    std::vector<Mesh> meshes = shared_instances(random);
    for (std::array<double, 12>& place : meshes[0].instances)
        place[3 + 4 * random.below(3)] = std::pow(10.0, double(random.below(kMaxPower + 1)));
    return meshes;
}

constexpr Case kCases[] = {
    {"soup", soup, aimed},
    {"soup, ends of rays", soup, with_ends},
    {"soup, tiny parts", soup, with_tiny_parts},
    {"soup, from afar", soup, from_afar},
    {"slivers in doubles", slivers, aimed},
    {"collinear, rotated", collinear, aimed},
    {"denormal floats", denormals, aimed},
    {"denormal floats, tiny parts", denormals, with_tiny_parts},
    {"extreme sizes", extremes, aimed},
    {"extreme sizes, ends of rays", extremes, with_ends},
    {"mixed sizes", mixed_sizes, aimed},
    {"mixed sizes, from afar", mixed_sizes, from_afar},
    {"coplanar", coplanar, from_the_lattice},
    {"coplanar, ends of rays", coplanar, with_ends},
    {"fan", fan, aimed},
    {"copies a rounding apart", copies, aimed},
    {"instances", instances, aimed},
    {"instances, ends of rays", instances, with_ends},
    {"shared instances", shared_instances, aimed},
    {"spread instances", spread_instances<30>, aimed},
    {"spread instances, barely moving", spread_instances<30>, barely_moving},
    {"spread instances, barely reached", spread_instances<12>, barely_moving},
};

} // namespace

std::span<const Case> cases() {
    return kCases;
}

} // namespace ovc::oracle
