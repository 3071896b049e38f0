// SPDX-License-Identifier: Apache-2.0
// The catalog: a table of names and generators.
#include "testscenes/catalog.h"

#include "testscenes/landscape/landscape.h"
#include "testscenes/scenes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <optional>
#include <vector>

namespace ovc {

namespace {

struct Generator {
    CatalogEntry entry;
    uint32_t min = 0, max = 0; // the range of N; no N when max is 0
    Scene (*make)(uint32_t size, const Soup* model);
    CameraPath (*path)(uint32_t size) = nullptr;
    Scene (*make_moving)(double clock) = nullptr;
    uint32_t max_streamed = 0; // the N of a scene that streams

    bool sized() const { return max != 0; }
    /// "terrain-" for "terrain-N", "knot" for "knot".
    std::string_view stem() const {
        return sized() ? entry.name.substr(0, entry.name.size() - 1) : entry.name;
    }
};

/// A generator that has no use for a model.
template <Scene (*kMake)(uint32_t size)>
Scene alone(uint32_t size, const Soup*) {
    return kMake(size);
}
template <Scene (*kMake)()>
Scene alone(uint32_t, const Soup*) {
    return kMake();
}

/// A scene that moves.
template <Scene (*kMake)(double clock)>
constexpr Generator moving(std::string_view name, std::string_view description) {
    const auto still = [](uint32_t, const Soup*) { return kMake(0); };
    return {{name, description, 0, false, true}, 0, 0, still, nullptr, kMake};
}

constexpr Generator kGenerators[] = {
    {{"dragons-N", "N dragons on a mirror: 204,800 + N x 871,414 triangles", 100, true},
     1,
     kMaxDragons,
     make_dragons,
     dragons_path},
    {{"dragonball", "a dragon, a mirror ball, a glass ball, a lens, waves: 7,364,817 triangles",
      100, true},
     0,
     0,
     [](uint32_t, const Soup* model) { return make_dragonball(model); },
     [](uint32_t) { return dragonball_path(); }},
    {{"plants", "a river valley with trees, reeds and flowers; the demo: about 7 million triangles",
      255},
     0,
     0,
     [](uint32_t, const Soup*) { return make_plants(uint32_t(kPlantsDemoSize)); },
     [](uint32_t) { return plants_path(); }},
    {{"plants-N", "the same, larger or smaller: about N x 110,000 triangles", 255},
     1,
     200,
     alone<make_plants>,
     [](uint32_t) { return plants_path(); }},
    {{"powerplant",
      "a hall of eight storeys: pipes, tanks, stairs, rails; six lights: 12,748,510 triangles",
      275},
     0,
     0,
     [](uint32_t, const Soup*) { return make_powerplant(kPowerplantTriangles); },
     [](uint32_t) { return powerplant_path(kPowerplantTriangles); }},
    {{"powerplant-N", "the same, smaller or larger: N triangles (N - 1 where N is odd)", 275},
     200'000,
     30'000'000,
     alone<make_powerplant>,
     powerplant_path},
    {{"leaf-canopy", "trees of 100,000 leaves, cut out of quads by a picture: 200,302 triangles"},
     0,
     0,
     alone<make_leaf_canopy>},
    {{"leaf-canopy-modelled", "the same leaves as triangles: 2,200,302 triangles"},
     0,
     0,
     alone<make_modelled_leaf_canopy>},
    moving<make_cloth>("cloth", "a banner that waves with --frames: 131,082 triangles"),
    moving<make_grass_in_wind>("grass-in-wind",
                               "8,100 tufts of grass that bend with --frames: 1,377,002 triangles"),
    {{"terrain-N", "hills over N x N cells: 2 N^2 triangles"}, 1, 4096, alone<make_terrain>},
    {{"landscape-N", "hills with stones, in tiles: N x 1,000,000 triangles", 0, false, false, true},
     1,
     kMaxLandscapeHeld,
     alone<make_landscape>,
     nullptr,
     nullptr,
     kMaxLandscape},
    {{"far-terrain", "a ground of 1e7 m, down to 1 mm at its far corner: 274,160 triangles"},
     0,
     0,
     alone<make_far_terrain>},
    {{"sphere-N", "a closed icosphere: 20 x 4^N triangles"}, 0, 10, alone<make_sphere_scene>},
    {{"knot", "a bumpy torus knot, closed: 873,600 triangles"}, 0, 0, alone<make_knot>},
    {{"soup-N", "random slivers in a unit cube: N x 1000 triangles"}, 1, 20000, alone<make_soup>},
    {{"city", "houses of axis-aligned, coplanar, long thin triangles: about 718,000"},
     0,
     0,
     alone<make_city>},
    {{"fractal", "a ball of 29,848 triangles that carries others, in 25,250 places: 753,662,000"},
     0,
     0,
     [](uint32_t, const Soup*) { return make_fractal(kFractalBalls); }},
    {{"fractal-N", "the same in N places: N x 29,848 triangles"},
     1,
     70'000, // a scene takes 2^31 triangles
     alone<make_fractal>},
    {{"mirrors", "spheres over a mirror floor: 81,922 triangles"}, 0, 0, alone<make_mirrors>},
    {{"glass", "a glass and a mirror ball over a checked floor: 41,472 triangles"},
     0,
     0,
     alone<make_glass>},
    {{"box", "a small room with two blocks: 30 triangles"}, 0, 0, alone<make_box>},
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

/// The request, where its size is in the range of scenes that are held or, with `streamed`, of
/// those that stream.
Result<Request> find(std::string_view name, bool streamed = false) {
    const std::optional<Request> request = parse(name);
    if (!request)
        return Error{"no test scene is called \"" + std::string(name) + "\"; did you mean \"" +
                     std::string(nearest_name(name)) + "\"?"};
    const Generator& generator = *request->generator;
    const uint32_t max = streamed ? generator.max_streamed : generator.max;
    const bool in_range = request->size >= generator.min && request->size <= max;
    if (generator.sized() && !in_range)
        return Error{"test scene \"" + std::string(name) + "\": the N of " +
                     std::string(generator.entry.name) + " must be from " +
                     std::to_string(generator.min) + " to " + std::to_string(max)};
    return *request;
}

Result<Done> check_model(const Generator& generator, const Soup& model) {
    if (!generator.entry.takes_model)
        return Error{"the test scene " + std::string(generator.entry.name) +
                     " shows no model of yours; dragons-N and dragonball do"};
    Dropped dropped;
    hittable_triangles(model, &dropped, nullptr);
    if (dropped.total() == model.triangle_count())
        return Error{"the model has no triangle that a ray can hit"};
    return Done{};
}

} // namespace

std::span<const CatalogEntry> catalog() {
    return kEntries;
}

bool is_test_scene(std::string_view name) {
    return parse(name).has_value();
}

const CatalogEntry& test_scene_entry(std::string_view name) {
    assert(is_test_scene(name));
    return parse(name)->generator->entry;
}

Result<Scene> make_test_scene(std::string_view name, const Soup* model, double clock) {
    const Result<Request> request = find(name);
    if (!request)
        return request.error();
    const Generator& generator = *request->generator;
    if (model)
        if (const Result<Done> fine = check_model(generator, *model); !fine)
            return fine.error();
    Scene scene = generator.make_moving ? generator.make_moving(clock)
                                        : generator.make(uint32_t(request->size), model);
    scene.name = name;
    return scene;
}

Result<Scene> stream_test_scene(std::string_view name, TriangleSink& sink) {
    assert(is_test_scene(name) && test_scene_entry(name).streams);
    const Result<Request> request = find(name, /* streamed= */ true);
    if (!request)
        return request.error();
    const Landscape landscape(uint32_t(request->size)); // the only scene that streams
    Scene scene = landscape.empty_scene();
    scene.name = name;
    if (!landscape.write(sink))
        return Error{"cancelled", ErrorKind::Cancelled};
    return scene;
}

Result<CameraPath> test_scene_path(std::string_view name) {
    const Result<Request> request = find(name);
    if (!request)
        return request.error();
    if (!request->generator->path)
        return Error{"the test scene " + std::string(name) + " has no camera path of its own"};
    return request->generator->path(uint32_t(request->size));
}

} // namespace ovc
