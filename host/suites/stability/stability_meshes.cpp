// SPDX-License-Identifier: Apache-2.0
// The meshes of the stability suite.
#include "host/suites/stability/stability_meshes.h"

#include "importers/importer.h"
#include "testscenes/random.h"
#include "testscenes/sphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace ovc {

using std::numbers::pi;

static dvec3 on_grid(dvec3 p) {
    return glm::round(p / kStabilityGrid) * kStabilityGrid;
}

Corners icosphere() {
    Corners corners = make_sphere(4);
    for (vec3& corner : corners)
        corner = vec3(on_grid(dvec3(corner)));
    return corners;
}

Corners lat_long() {
    constexpr int n = 16;
    Random random(16);
    std::vector<double> radii(n * (n + 1));
    for (double& radius : radii)
        radius = random.uniform(0.5, 1.5);
    const auto at = [&](int row, int column) {
        const bool pole = row == 0 || row == n;
        const double down = pi * row / n, round = 2 * pi * (column % n) / n;
        const double radius = radii[size_t(row * n + (pole ? 0 : column % n))];
        const double out = pole ? 0 : std::sin(down);
        return on_grid(radius *
                       dvec3(out * std::cos(round), out * std::sin(round), std::cos(down)));
    };
    Corners corners;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const dvec3 a = at(row, column), b = at(row + 1, column);
            const dvec3 c = at(row + 1, column + 1), d = at(row, column + 1);
            if (row < n - 1)
                add_triangle(corners, a, b, c);
            if (row > 0)
                add_triangle(corners, a, c, d);
        }
    return corners;
}

/// Returns a point of the tube round a trefoil; both parameters are in turns.
static dvec3 on_knot(double along, double around) {
    const auto centre = [](double turns) {
        const double a = 2 * pi * turns, radius = 1 + 0.42 * std::cos(3 * a);
        return dvec3(radius * std::cos(2 * a), 0.42 * std::sin(3 * a), radius * std::sin(2 * a));
    };
    const dvec3 at = centre(along), ahead = glm::normalize(centre(along + 1e-4) - at);
    const dvec3 side = glm::normalize(glm::cross(ahead, dvec3(0, 1, 0)));
    return at + 0.2 * (std::cos(2 * pi * around) * side +
                       std::sin(2 * pi * around) * glm::cross(side, ahead));
}

Corners small_knot() {
    constexpr int along = 128, around = 16;
    const auto at = [](int i, int j) {
        return on_grid(on_knot(double(i % along) / along, double(j % around) / around));
    };
    Corners corners;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j)
            add_quad(corners, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return corners;
}

std::span<const NamedMesh> closed_meshes() {
    static constexpr NamedMesh meshes[] = {
        {"icosphere", icosphere}, {"lat-long", lat_long}, {"knot", small_knot}};
    return meshes;
}

std::span<const NamedPlace> unpleasant_places() {
    static const NamedPlace places[] = {
        {"at (148376, 1234, -223423)", {148376, 1234, -223423}, 1},
        {"at UTM (4.5e6, 6e6, 6)", {4.5e6, 6e6, 6}, 1},
        {"at 1e7", dvec3(1e7), 1},
        {"at 1e9", dvec3(1e9), 1},
        {"times 1e-30", dvec3(0), 1e-30},
        {"times 1e-12", dvec3(0), 1e-12},
        {"times 1e-6", dvec3(0), 1e-6},
        {"times 1e6", dvec3(0), 1e6},
        {"times 1e12", dvec3(0), 1e12},
        {"times 1e30", dvec3(0), 1e30},
    };
    return places;
}

Result<std::string> dragon_file(const std::string& data) {
    const std::filesystem::path folder = std::filesystem::path(data) / "meshes" / "stanford-dragon";
    for (const char* name : {"dragon_vrip.ply", "dragon_vrip.ply.gz"})
        if (std::filesystem::exists(folder / name))
            return (folder / name).string();
    return Error{fmt::format("--data: '{}' holds no meshes/stanford-dragon/dragon_vrip.ply", data)};
}

Result<std::unique_ptr<const Scene>> load_dragon(const std::string& data) {
    const Result<std::string> file = dragon_file(data);
    if (!file)
        return file.error();
    Result<Scene> scene = load(*file);
    if (!scene)
        return scene.error();
    return std::make_unique<const Scene>(std::move(*scene));
}

Corners box_of_squares() {
    constexpr int n = 8;
    Corners corners;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto at = [&](int a, int b) {
                        dvec3 p;
                        p[axis] = side;
                        p[(axis + (side ? 1 : 2)) % 3] = double(a) / n;
                        p[(axis + (side ? 2 : 1)) % 3] = double(b) / n;
                        return p;
                    };
                    add_quad(corners, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                }
    return corners;
}

/// Returns [0, 1]^2 in n x n squares, mapped by `at`.
template <class At>
static Corners squares(int n, const At& at) {
    Corners corners;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x0 = double(i) / n, x1 = double(i + 1) / n;
            const double y0 = double(j) / n, y1 = double(j + 1) / n;
            add_quad(corners, at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1));
        }
    return corners;
}

Corners sheet(int n, double z) {
    return squares(n, [&](double x, double y) { return dvec3(2 * x - 1, 2 * y - 1, z); });
}

Corners tilted_sheet(int n) {
    const dvec3 a = glm::normalize(dvec3(3, 1, -2)),
                b = glm::cross(a, glm::normalize(dvec3(1, 2, 2.5)));
    return squares(n, [&](double x, double y) { return (2 * x - 1) * a + (2 * y - 1) * b; });
}

Corners sliver_strip(double aspect) {
    constexpr int rows = 256;
    Corners corners;
    for (int row = 0; row < rows; ++row) {
        const double y0 = row / aspect, y1 = (row + 1) / aspect;
        add_quad(corners, {0, y0, 0}, {1, y0, 0}, {1, y1, 0}, {0, y1, 0});
    }
    return corners;
}

Corners strewn_slivers(double aspect) {
    Random random{uint64_t(aspect)};
    Corners corners;
    for (int i = 0; i < 1000; ++i) {
        const dvec3 a{random.uniform(), random.uniform(), random.uniform()};
        const dvec3 along = random.direction();
        const dvec3 across = any_perpendicular(along) / aspect;
        add_triangle(corners, a, a + along, a + random.uniform() * along + across);
    }
    return corners;
}

/// Adds a triangle with each corner within `size` of `at`.
static void add_random_triangle(Corners& corners, Random& random, dvec3 at, double size) {
    for (int corner = 0; corner < 3; ++corner)
        corners.push_back(vec3(at + size * random.in_ball()));
}

Corners denormal_triangles() {
    Random random(38);
    Corners corners;
    for (int i = 0; i < 500; ++i) {
        const double size = std::pow(10.0, random.uniform(-44, -37));
        const dvec3 at = 3 * size * random.in_ball();
        add_random_triangle(corners, random, at, size);
    }
    return corners;
}

Corners kilometre_triangles() {
    Random random(3);
    Corners corners;
    for (int i = 0; i < 200; ++i) {
        const dvec3 at = 2000.0 * random.in_ball();
        add_random_triangle(corners, random, at, 1000);
    }
    return corners;
}

Corners geometric_series() {
    Corners corners;
    double size = 1;
    for (int i = 0; i < 300; ++i, size *= 0.75)
        add_triangle(corners, {size, 0, 0}, {0, size, 0}, {0, 0, size});
    return corners;
}

Corners overlapping_walls() {
    Random random(400);
    Corners corners = sheet(4, -1);
    for (int i = 0; i < 400; ++i) {
        const dvec3 a(on_grid({random.uniform(-1, 0.5), random.uniform(-1, 0.5), 0}));
        const dvec3 size(on_grid({random.uniform(0.01, 0.5), random.uniform(0.01, 0.5), 0}));
        add_quad(corners, a, a + dvec3(size.x, 0, 0), a + size, a + dvec3(0, size.y, 0));
    }
    return corners;
}

Corners coincident(int count) {
    Corners corners;
    for (int i = 0; i < count; ++i)
        add_triangle(corners, {0.25, 0, 0.5}, {1, 0.125, 0}, {0, 1, 0});
    return corners;
}

Corners fan(int count) {
    const auto rim = [&](int i) {
        const double a = 2 * pi * (i % count) / count;
        return dvec3(std::cos(a), std::sin(a), 0.25);
    };
    Corners corners;
    for (int i = 0; i < count; ++i)
        add_triangle(corners, dvec3(0), rim(i), rim(i + 1));
    return corners;
}

Corners zero_area() {
    Random random(5);
    const Corners sphere = icosphere();
    Corners corners;
    for (int i = 0; i < 1000; ++i) {
        const vec3* t = &sphere[3 * random.below(uint32_t(sphere.size() / 3))];
        const vec3 middle = 0.5f * (t[0] + t[1]);
        corners.insert(corners.end(), {t[0], t[1], i % 2 ? t[0] : middle});
    }
    return corners;
}

Corners not_finite() {
    Random random(9);
    const Corners sphere = icosphere();
    Corners corners;
    for (int i = 0; i < 40; ++i)
        for (const float bad : {NAN, INFINITY, -INFINITY})
            for (int field = 0; field < 9; ++field) {
                const vec3* t = &sphere[3 * random.below(uint32_t(sphere.size() / 3))];
                corners.insert(corners.end(), t, t + 3);
                corners[corners.size() - 3 + size_t(field / 3)][field % 3] = bad;
            }
    return corners;
}

Chunk placed(const Corners& corners, dvec3 place, double scale) {
    Corners scaled = corners;
    for (vec3& corner : scaled)
        corner = vec3(dvec3(corner) * scale);
    return Chunk::owning(place, std::move(scaled));
}

} // namespace ovc
