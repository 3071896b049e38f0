// SPDX-License-Identifier: Apache-2.0
// The rows of the stability suite's table.
#include "host/suites/stability/stability_cases.h"

#include "host/suites/stability/stability_meshes.h"
#include "host/suites/stability/terrain_rays.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

namespace ovc {

namespace {

using Cases = std::vector<StabilityCase>;
using Generator = Corners (*)();

template <class... Chunks>
Soup soup_of(Chunks&&... chunks) {
    Soup soup;
    (soup.chunks.push_back(std::forward<Chunks>(chunks)), ...);
    return soup;
}

struct NamedAim {
    const char* name;
    Aim aim;
};

constexpr NamedAim kAims[] = {
    {"vertices from inside", {Side::Inside, Target::Vertices, kStabilityGrid}},
    {"vertices from outside", {Side::Outside, Target::Vertices, kStabilityGrid}},
    {"edges from inside", {Side::Inside, Target::Edges, kStabilityGrid}},
    {"edges from outside", {Side::Outside, Target::Edges, kStabilityGrid}},
};

/// Returns a function that makes the generator's soup at the origin.
std::function<Soup()> at_origin(Generator make) {
    return [make] { return soup_of(placed(make())); };
}

auto aimed(const Aim& aim) {
    return [aim](const Soup& soup, Random& random, size_t count) {
        return closed_mesh_rays(soup, random, count, aim);
    };
}

void add_closed_meshes(Cases& cases) {
    for (const NamedMesh& mesh : closed_meshes()) {
        for (const NamedAim& aim : kAims)
            cases.push_back({fmt::format("{}: {}", mesh.name, aim.name), true, 2000,
                             at_origin(mesh.make), aimed(aim.aim), ""});
        for (const NamedPlace& at : unpleasant_places())
            cases.push_back({fmt::format("{} {}", mesh.name, at.name), true, 2000,
                             [=] { return soup_of(placed(mesh.make(), at.place, at.scale)); },
                             any_closed_mesh_rays, ""});
    }
}

void add_dragon(Cases& cases, const Scene& dragon) {
    const auto at = [&dragon](dvec3 place) {
        return [&dragon, place] {
            return soup_of(Chunk::borrowing(place, dragon.soup.chunks[0].corners()));
        };
    };
    // The dragon is not closed, so any ray may leave through a hole. leak_cases.cpp has rays that
    // must hit it.
    cases.push_back({"dragon", false, 2000, at(dvec3(0)), any_closed_mesh_rays, ""});
    cases.push_back({"dragon at UTM (4.5e6, 6e6, 6)", false, 2000, at({4.5e6, 6e6, 6}),
                     any_closed_mesh_rays, ""});
}

/// Returns a function that makes far-terrain, moved by `by`.
std::function<Soup()> far_terrain(dvec3 by) {
    return [by] {
        Result<Scene> scene = make_test_scene("far-terrain");
        Soup soup;
        for (const Chunk& chunk : scene->soup.chunks)
            soup.chunks.push_back(Chunk::owning(
                chunk.origin() + by, Corners(chunk.corners().begin(), chunk.corners().end())));
        return soup;
    };
}

auto from_above(double low, double high) {
    return [=](const Soup& soup, Random& random, size_t count) {
        return terrain_rays(soup, random, count, low, high);
    };
}

void add_far_terrain(Cases& cases) {
    const dvec3 corner(10'485'760, 0, 10'485'760);
    cases.push_back({"far-terrain from 1 to 10 cm above", true, 2000, far_terrain(dvec3(0)),
                     from_above(-2, -1), ""});
    cases.push_back({"far-terrain from up to 1e7 m above", true, 2000, far_terrain(dvec3(0)),
                     from_above(-2, 7), ""});
    cases.push_back({"far-terrain, its corner at the origin", true, 2000, far_terrain(-corner),
                     from_above(-2, -1), ""});
}

/// Aims at insides, corners and sides of triangles of any instance, from twice its size away.
AimedRays rays_at_instances(const Soup& soup, Random& random, size_t count) {
    AimedRays set;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t mesh = random.below(uint32_t(soup.chunks.size()));
        const Triangle t = soup.triangle({mesh, random.below(soup.chunks[mesh].size())});
        const dvec3 target = glm::mix(glm::mix(t[0], t[1], random.uniform()), t[2],
                                      random.chance(0.3) ? 0 : random.uniform());
        const dvec3 org = target + 2 * max_component(bounds_of(t).extent()) * random.direction();
        set.rays.push_back({org, 0, target - org});
    }
    return set;
}

/// Adds one ball in two places by transforms that lose digits.
void add_instances(Cases& cases) {
    using Rows = std::array<std::array<double, 4>, 3>;
    const std::tuple<const char*, Rows, Rows> places[] = {
        {"scaled by 1e-8 and 1e8",
         {{{1e-8, 0, 0, 2}, {0, 1e-8, 0, 0}, {0, 0, 1e-8, 0}}},
         {{{1e8, 0, 0, 0}, {0, 1e8, 0, 3e8}, {0, 0, 1e8, 0}}}},
        {"flattened by 1e6 and 1e12",
         {{{1, 0.5, 0, 0}, {0, 1e-6, 0, 0}, {0, 0, 1, 0}}},
         {{{1, 0, 0, 5}, {0, 1, 0, 0}, {0.7, 0, 1e-12, 0}}}},
        {"sheared by 1e6, mirrored far away",
         {{{1, 1e6, 0, 0}, {0, 1, 0, 0}, {0, 1e6, 1, 0}}},
         {{{-1, 0, 0, 4.5e6}, {0, 1, 0, 6e6}, {0, 0, 1, 6}}}}};
    for (const auto& [name, first, second] : places)
        cases.push_back({fmt::format("instances {}", name), false, 2000,
                         [first = first, second = second] {
                             Soup soup;
                             soup.chunks.push_back(placed(icosphere()));
                             soup.chunks.push_back(soup.chunks[0].unplaced());
                             soup.chunks[0].place({first});
                             soup.chunks[1].place({second});
                             return soup;
                         },
                         rays_at_instances, ""});
}

void add_bad_shapes(Cases& cases) {
    for (const double aspect : {1e3, 1e6, 1e9}) {
        cases.push_back({fmt::format("strip of slivers {:.0e}", aspect), true, 2000,
                         [=] { return soup_of(placed(sliver_strip(aspect))); }, strip_rays, ""});
        cases.push_back({fmt::format("strewn slivers {:.0e}", aspect), false, 300,
                         [=] { return soup_of(placed(strewn_slivers(aspect))); }, rays_at_triangles,
                         ""});
    }
    cases.push_back(
        {"denormal beside kilometres", false, 40,
         [] { return soup_of(placed(denormal_triangles()), placed(kilometre_triangles())); },
         rays_at_triangles, ""});
    cases.push_back({"zero area mixed in", true, 2000,
                     [] { return soup_of(placed(icosphere()), placed(zero_area())); },
                     any_closed_mesh_rays, ""});
    cases.push_back({"every triangle twice", true, 2000,
                     [] { return soup_of(placed(icosphere()), placed(icosphere())); },
                     any_closed_mesh_rays, ""});
    cases.push_back({"coplanar overlapping walls", false, 2000, at_origin(overlapping_walls),
                     rays_at_triangles, ""});
    cases.push_back({"10,000 coincident", false, 40,
                     [] { return soup_of(placed(coincident(10'000))); }, rays_at_triangles, ""});
    cases.push_back(
        {"fan of 10,000", true, 60, [] { return soup_of(placed(fan(10'000))); }, fan_rays, ""});
    cases.push_back({"geometric series 0.75^300", false, 100, at_origin(geometric_series),
                     rays_at_triangles, ""});
}

auto grazing(double height) {
    return [height](const Soup& soup, Random& random, size_t count) {
        return grazing_rays(soup, random, count, height);
    };
}

auto from_surface(Start start, bool skip, bool inwards) {
    return [=](const Soup& soup, Random& random, size_t count) {
        return surface_rays(soup, random, count, start, skip, inwards);
    };
}

auto directions(double from, double to) {
    return [=](const Soup& soup, Random& random, size_t count) {
        return long_direction_rays(soup, random, count, from, to);
    };
}

void add_bad_directions(Cases& cases) {
    cases.push_back(
        {"along axes and split planes", true, 2000, at_origin(box_of_squares), axis_rays, ""});
    cases.push_back(
        {"in planes of triangles", true, 2000, at_origin(box_of_squares), in_plane_rays, ""});
    for (const double angle : {1e-3, 1e-6, 1e-9}) {
        cases.push_back({fmt::format("grazing {:.0e} rad", angle), true, 1000,
                         [] { return soup_of(placed(sheet(16, 0))); }, grazing(angle), ""});
        cases.push_back({fmt::format("grazing {:.0e} rad, tilted", angle), false, 1000,
                         [] { return soup_of(placed(tilted_sheet(16))); }, grazing(angle), ""});
    }
    cases.push_back(
        {"directions 1e-30 to 1e30", true, 2000, at_origin(icosphere), directions(-30, 30), ""});
    cases.push_back({"t near 1e38", true, 1000, at_origin(icosphere), directions(-37.9, -37), ""});
    cases.push_back({"t near 1e-36", true, 1000, at_origin(icosphere), directions(35.5, 36), ""});
    cases.push_back(
        {"t_min and t_max at a hit", false, 2000, at_origin(icosphere), range_rays, ""});
}

void add_surface_starts(Cases& cases) {
    for (const Start start : {Start::Surface, Start::Vertex})
        for (const bool skip : {false, true})
            for (const bool inwards : {false, true})
                cases.push_back(
                    {fmt::format("from {}{}{}", start == Start::Surface ? "a surface" : "a vertex",
                                 inwards ? " inwards" : "", skip ? ", skip" : ""),
                     inwards, 1000, at_origin(icosphere), from_surface(start, skip, inwards), ""});
}

void add_bad_numbers(Cases& cases) {
    cases.push_back(
        {"valid rays, for time", true, 20'000, at_origin(icosphere), any_closed_mesh_rays, ""});
    cases.push_back({"NaN and infinite rays", false, 20'000, at_origin(icosphere), bad_rays,
                     "valid rays, for time"});
    cases.push_back({"NaN and infinite vertices", true, 20'000,
                     [] { return soup_of(placed(icosphere()), placed(not_finite())); },
                     any_closed_mesh_rays, "valid rays, for time"});
}

} // namespace

std::vector<StabilityCase> stability_cases(const Scene* dragon) {
    Cases cases;
    add_closed_meshes(cases);
    add_instances(cases);
    if (dragon)
        add_dragon(cases, *dragon);
    add_far_terrain(cases);
    add_bad_shapes(cases);
    add_bad_directions(cases);
    add_surface_starts(cases);
    add_bad_numbers(cases);
    std::ranges::move(cliff_cases(), std::back_inserter(cases));
    return cases;
}

} // namespace ovc
