// SPDX-License-Identifier: Apache-2.0
// The catalog: a table of names and generators.
#include "testscenes/catalog.h"

#include "testscenes/scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

namespace ovc {

namespace {

struct Generator {
    CatalogEntry entry;
    uint32_t least = 0, most = 0; // the range of N; no N when most is 0
    Scene (*make)(uint32_t size);

    bool sized() const { return most != 0; }
    /// "terrain-" for "terrain-N", "knot" for "knot".
    std::string_view stem() const {
        return sized() ? entry.name.substr(0, entry.name.size() - 1) : entry.name;
    }
};

constexpr Generator kGenerators[] = {
    {{"plants",
      "a river valley with trees, reeds and flowers; the demo: about 7 million triangles"},
     0,
     0,
     [](uint32_t) { return make_plants(uint32_t(kPlantsDemoSize)); }},
    {{"plants-N", "the same, larger or smaller: about N x 110,000 triangles"}, 1, 200, make_plants},
    {{"terrain-N", "hills over N x N cells: 2 N^2 triangles"}, 1, 4096, make_terrain},
    {{"far-terrain", "a ground of 1e7 m, down to 1 mm at its far corner: 274,160 triangles"},
     0,
     0,
     [](uint32_t) { return make_far_terrain(); }},
    {{"sphere-N", "a closed icosphere: 20 x 4^N triangles"}, 0, 10, make_sphere_scene},
    {{"knot", "a bumpy torus knot, closed: 873,600 triangles"},
     0,
     0,
     [](uint32_t) { return make_knot(); }},
    {{"soup-N", "random slivers in a unit cube: N x 1000 triangles"}, 1, 20000, make_soup},
    {{"city", "houses of axis-aligned, coplanar, long thin triangles: about 718,000"},
     0,
     0,
     [](uint32_t) { return make_city(); }},
    {{"mirrors", "spheres over a mirror floor: 81,922 triangles"},
     0,
     0,
     [](uint32_t) { return make_mirrors(); }},
    {{"box", "a small room with two blocks: 30 triangles"},
     0,
     0,
     [](uint32_t) { return make_box(); }},
};

constexpr auto kEntries = [] {
    std::array<CatalogEntry, std::size(kGenerators)> entries{};
    for (size_t i = 0; i < entries.size(); ++i)
        entries[i] = kGenerators[i].entry;
    return entries;
}();

struct Request {
    const Generator* generator;
    uint64_t size; // UINT64_MAX when larger than that
};

/// The generator that `name` belongs to, whatever the size.
std::optional<Request> parse(std::string_view name) {
    for (const Generator& generator : kGenerators) {
        if (!generator.sized() && name == generator.entry.name)
            return Request{&generator, 0};
        if (!generator.sized() || !name.starts_with(generator.stem()))
            continue;
        const std::string_view digits = name.substr(generator.stem().size());
        if (digits.empty() || digits.find_first_not_of("0123456789") != digits.npos)
            continue;
        uint64_t size = 0;
        const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), size);
        return Request{&generator, parsed.ec == std::errc() ? size : UINT64_MAX};
    }
    return std::nullopt;
}

/// Levenshtein's distance: single characters inserted, removed, replaced.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

std::string_view nearest_name(std::string_view name) {
    // Digits stand for the N of a sized scene.
    std::string pattern(name.substr(0, name.find_last_not_of("0123456789") + 1));
    if (pattern.size() < name.size())
        pattern += 'N';
    return std::ranges::min(
               kEntries, {},
               [&](const CatalogEntry& entry) { return edit_distance(pattern, entry.name); })
        .name;
}

} // namespace

std::span<const CatalogEntry> catalog() {
    return kEntries;
}

bool is_test_scene(std::string_view name) {
    return parse(name).has_value();
}

Result<Scene> make_test_scene(std::string_view name) {
    const std::optional<Request> request = parse(name);
    if (!request)
        return Error{"no test scene is called \"" + std::string(name) + "\"; did you mean \"" +
                     std::string(nearest_name(name)) + "\"?"};
    const Generator& generator = *request->generator;
    if (generator.sized() && (request->size < generator.least || request->size > generator.most))
        return Error{"test scene \"" + std::string(name) + "\": the N of " +
                     std::string(generator.entry.name) + " must be from " +
                     std::to_string(generator.least) + " to " + std::to_string(generator.most)};
    Scene scene = generator.make(uint32_t(request->size));
    scene.name = name;
    return scene;
}

} // namespace ovc
