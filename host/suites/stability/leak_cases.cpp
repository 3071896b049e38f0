// SPDX-License-Identifier: Apache-2.0
// Combines each mesh with each place.
#include "host/suites/stability/leak_cases.h"

#include "host/suites/stability/sound_targets.h"
#include "host/suites/stability/stability_meshes.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace ovc {

namespace {

using Cases = std::vector<StabilityCase>;

std::vector<NamedPlace> all_places() {
    std::vector<NamedPlace> places = {{"at the origin", dvec3(0), 1}};
    places.insert(places.end(), unpleasant_places().begin(), unpleasant_places().end());
    return places;
}

Soup soup_of(Chunk chunk) {
    Soup soup;
    soup.chunks.push_back(std::move(chunk));
    return soup;
}

void add_closed(Cases& cases, const NamedMesh& mesh, const NamedPlace& at) {
    // The grid's points are floats only where the mesh is not scaled.
    const double grid = at.scale == 1 ? kStabilityGrid : 0;
    cases.push_back({fmt::format("{} {}", mesh.name, at.name), true, 0,
                     [=] { return soup_of(placed(mesh.make(), at.place, at.scale)); },
                     [=](const Soup& soup, Random& random, size_t count) {
                         return edge_and_vertex_rays(soup, random, count, grid);
                     },
                     ""});
}

/// The targets of the dragon's case that runs now. All its cases share them, because they take as
/// much memory as the mesh, and no case knows which of them ends last.
using Targets = std::shared_ptr<std::optional<SoundTargets>>;

void add_dragon(Cases& cases, const Scene& dragon, const NamedPlace& at, const Targets& targets) {
    cases.push_back({fmt::format("dragon {}", at.name), true, 0,
                     [&dragon, at, targets] {
                         targets->reset();
                         const auto corners = dragon.soup.chunks[0].corners();
                         return soup_of(
                             placed(Corners(corners.begin(), corners.end()), at.place, at.scale));
                     },
                     [=](const Soup& soup, Random& random, size_t count) {
                         if (!*targets)
                             targets->emplace(soup);
                         return (*targets)->rays(random, count);
                     },
                     ""});
}

} // namespace

std::vector<StabilityCase> leak_cases(const Scene* dragon) {
    Cases cases;
    for (const NamedMesh& mesh : closed_meshes())
        for (const NamedPlace& at : all_places())
            add_closed(cases, mesh, at);
    if (dragon) {
        const auto targets = std::make_shared<std::optional<SoundTargets>>();
        for (const NamedPlace& at : all_places())
            add_dragon(cases, *dragon, at, targets);
    }
    return cases;
}

void share_rays(std::span<StabilityCase> cases, uint64_t rays) {
    for (StabilityCase& one : cases)
        one.rays = (rays + cases.size() - 1) / cases.size();
}

} // namespace ovc
