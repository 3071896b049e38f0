// SPDX-License-Identifier: Apache-2.0
// Cliffs are cases of rays that took longest of all.
#include "host/suites/stability/stability_cases.h"

#include "host/suites/stability/stability_meshes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace ovc {

using std::numbers::pi;

namespace {

constexpr const char* kTypical = "decided exactly, for time";
constexpr double kBar = 100;  // times the time of a typical ray
constexpr double kMax = 2000; // on a machine with other work, where a test must not fail

Soup of_floats(Corners corners) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    return soup;
}

Soup of_doubles(std::vector<dvec3> corners) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
    return soup;
}

/// Returns `count` triangles round the side from (0, 0, 0) to (0, 0, 1), like pages of a book.
Soup book(int count) {
    Corners corners;
    for (int i = 0; i < count; ++i) {
        const double a = 2 * pi * i / count;
        add_triangle(corners, dvec3(0), dvec3(0, 0, 1), dvec3(std::cos(a), std::sin(a), 0.5));
    }
    return of_floats(std::move(corners));
}

/// Returns large triangles round the z axis with corners at height(x, y, i) for triangle i, which
/// all overlap at (0.1, 0.2).
template <class Height>
Soup stacked(int count, Height&& height) {
    Random random(/* seed= */ 7);
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * count; ++i) {
        const double a = 2 * pi * (i % 3) / 3;
        // Coordinates have few bits, so that heights of planes are exact.
        const auto rounded = [](double x) { return std::round(x * 1024) / 1024; };
        const double x = rounded(8 * std::cos(a) + random.uniform(-1, 1));
        const double y = rounded(8 * std::sin(a) + random.uniform(-1, 1));
        corners.push_back({x, y, height(x, y, i / 3)});
    }
    return of_doubles(std::move(corners));
}

/// Returns copies of one triangle with each corner moved by some units in the last place.
Soup copies_within_ulps(int count) {
    Random random(/* seed= */ 8);
    const dvec3 triangle[3] = {{-0.8, -0.8, 0.7}, {0.8, -0.8, 0.65}, {0, 0.9, 0.6}};
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * count; ++i)
        corners.push_back(triangle[i % 3] + 50 * 0x1p-53 * random.in_ball());
    return of_doubles(std::move(corners));
}

/// Returns one triangle of size 1e76 and `count` of size 1e-71, all round the origin.
Soup large_and_small(int count) {
    Random random(/* seed= */ 9);
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * (count + 1); ++i)
        corners.push_back((i < 3 ? 1e76 : 1e-71) * random.in_ball());
    return of_doubles(std::move(corners));
}

/// Makes rays at the point from about so far away.
auto rays_at(dvec3 point, double far) {
    return [=](const Soup&, Random& random, size_t count) {
        AimedRays set;
        for (size_t i = 0; i < count; ++i) {
            const dvec3 org = far * (dvec3(0.1, 0.2, 1) + 0.5 * random.in_ball());
            set.rays.push_back({org, 0, point - org});
        }
        return set;
    };
}

/// Makes rays at corners of triangles, with unit directions, from so far away.
auto rays_at_corners(double far) {
    return [=](const Soup& soup, Random& random, size_t count) {
        AimedRays set;
        for (size_t i = 0; i < count; ++i) {
            const TriangleId id{0, random.below(soup.chunks[0].size())};
            const dvec3 corner = soup.triangle(id)[random.below(3)];
            const dvec3 towards = random.direction();
            set.rays.push_back({corner - far * towards, 0, towards});
        }
        return set;
    };
}

} // namespace

std::vector<StabilityCase> cliff_cases() {
    const auto knot = [] { return of_floats(small_knot()); };
    std::vector<StabilityCase> cases = {
        // The rays start too far away for doubles to walk along, so no kernel takes part.
        {kTypical, false, 2000, knot, rays_at_corners(1e17), ""}};
    const auto add = [&](std::string name, size_t rays, std::function<Soup()> soup, auto&& aim) {
        cases.push_back({std::move(name), false, rays, std::move(soup), aim, kTypical, kMax, kBar});
    };
    for (const double far : {1e15, 1e100, 1e200})
        add(fmt::format("from {:.0e} away", far), 2000, knot, rays_at_corners(far));
    add(
        "fan of 20,000 at its hub", 64, [] { return of_floats(fan(20'000)); },
        rays_at(dvec3(0), 5));
    add(
        "book of 10,000 at its spine", 64, [] { return book(10'000); },
        rays_at(dvec3(0, 0, 0.5), 5));
    add(
        "10,000 in a plane", 64,
        [] { return stacked(10'000, [](double x, double y, int) { return x + y; }); },
        rays_at(dvec3(0.1, 0.2, 0.3), 5));
    add(
        "10,000 on the floor", 64,
        [] { return stacked(10'000, [](double, double, int) { return 0.3; }); },
        rays_at(dvec3(0.1, 0.2, 0.3), 5));
    add(
        "10,000 an ulp apart", 64,
        [] {
            return stacked(10'000, [](double x, double y, int i) { return x + y + i * 0x1p-50; });
        },
        rays_at(dvec3(0.1, 0.2, 0.3), 5));
    add(
        "10,000 copies within ulps", 64, [] { return copies_within_ulps(10'000); },
        rays_at(dvec3(0, 0, 0.65), 5));
    for (const double far : {1e-71, 1e76})
        add(
            fmt::format("301 of 1e76 and 1e-71, from {:.0e}", far), 64,
            [] { return large_and_small(300); }, rays_at(dvec3(0), far));
    return cases;
}

} // namespace ovc
