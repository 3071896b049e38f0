// SPDX-License-Identifier: Apache-2.0
// Placement of plants: rings of cells around the viewer, at most one plant a cell, chosen by what
// grows there.
#include "testscenes/plants/placement.h"

#include "core/system/parallel.h"
#include "testscenes/noise.h"
#include "testscenes/plants/landscape.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ovc::plants {

namespace {

struct Site {
    dvec2 at;
    double distance; // from the viewpoint
    double shore;
    double height;
};

struct Choice {
    Kind kind;
    double size = 1;
};

/// One layer of plants: cells of `cell` metres, growing with the distance, each asked what grows in
/// it.
struct Layer {
    uint64_t seed;
    double cell;
    double cell_per_distance;
    double reach;
    std::optional<Choice> (*choose)(const Site& site, Random& random);
};

double forest_share(const Site& site) {
    const double patches = fractal_noise(site.at / 55.0, 3, 51) + 0.12;
    return smooth_step(-0.05, 0.2, patches) * smooth_step(8, 22, site.shore);
}

/// Kept free of trees: what would stand between the viewer and the water, or all around shut out
/// the sun.
bool blocks_the_view(const Site& site) {
    const double ahead = kViewpoint.y - site.at.y;
    const double across = site.at.x - kViewpoint.x;
    const bool between =
        ahead > -3 && site.distance < 46 && across < 0.36 * ahead + 2 && across > -0.95 * ahead - 5;
    const bool sunny = ahead < 9 && site.distance < 42 && across > -6;
    return between || sunny;
}

std::optional<Choice> choose_tree(const Site& site, Random& random) {
    if (site.shore < 2.5 || blocks_the_view(site))
        return std::nullopt;
    if (site.shore < 11) {
        if (!random.chance(0.09))
            return std::nullopt;
        const double pick = random.uniform();
        return Choice{pick < 0.4    ? Kind::Willow
                      : pick < 0.75 ? Kind::Birch
                                    : Kind::Oak,
                      random.uniform(0.7, 1.05)};
    }
    if (!random.chance(0.02 + 0.85 * forest_share(site)) || ground_slope(site.at) > 1.1)
        return std::nullopt;
    // Conifers take over on the right bank and uphill.
    const double conifers = smooth_step(4, 24, site.height + 6 * noise(site.at / 30.0, 52));
    // Far away a few stand for many; above the tree line, none.
    if (random.chance(0.8 * smooth_step(190, 520, site.distance)) || site.height > 75)
        return std::nullopt;
    const double size = random.uniform(0.65, 1.25);
    if (random.chance(0.1 + 0.85 * conifers))
        return Choice{Kind::Spruce, size};
    const double pick = random.uniform();
    return Choice{pick < 0.07 ? Kind::Maple : pick < 0.38 ? Kind::Birch : Kind::Oak, size};
}

std::optional<Choice> choose_bush(const Site& site, Random& random) {
    if (site.shore < 2 || (blocks_the_view(site) && site.distance < 20))
        return std::nullopt;
    const double edge = 1 - std::abs(2 * forest_share(site) - 1);
    const double bank = smooth_step(2, 4, site.shore) * smooth_step(14, 7, site.shore);
    if (!random.chance(0.04 + 0.45 * edge +
                       0.3 * bank * smooth_step(-0.1, 0.3, noise(site.at / 9.0, 53))))
        return std::nullopt;
    return Choice{Kind::Bush, random.uniform(0.5, 1.15)};
}

std::optional<Choice> choose_grass(const Site& site, Random& random) {
    const double thin = 0.75 + 0.35 * noise(site.at / 3.0, 54);
    if (site.shore < 0.7 || !random.chance(thin * smooth_step(0.5, 3.0, site.shore)))
        return std::nullopt;
    return Choice{Kind::Grass, random.uniform(0.6, 1.2) + std::min(0.9, 0.012 * site.distance)};
}

std::optional<Choice> choose_flower(const Site& site, Random& random) {
    if (site.shore < 1.8)
        return std::nullopt;
    const bool daisies = noise(site.at / 2.6, 55) > 0.3;
    const bool flowers = noise(site.at / 3.4, 56) > 0.28;
    if (!(daisies || flowers) || !random.chance(0.65))
        return std::nullopt;
    return Choice{flowers ? Kind::Flower : Kind::Daisy, random.uniform(0.7, 1.2)};
}

std::optional<Choice> choose_water_plant(const Site& site, Random& random) {
    const double clump = noise(site.at / 7.0, 57) + 0.35 * noise(site.at / 1.5, 58);
    if (site.shore > -2.2 && site.shore < 0.9 && clump > 0.3 && random.chance(0.75))
        return Choice{Kind::Reed, random.uniform(0.7, 1.1)};
    if (site.shore < -1.6 && site.shore > -6.5 && clump < -0.28 && random.chance(0.4))
        return Choice{Kind::Lily, random.uniform(0.8, 1.3)};
    return std::nullopt;
}

std::optional<Choice> choose_rock(const Site& site, Random& random) {
    const bool bank = site.shore > -2.5 && site.shore < 2.5 && noise(site.at / 7.0, 59) > 0.05;
    if (!random.chance(bank ? 0.3 : site.shore > 0 ? 0.012 : 0))
        return std::nullopt;
    const double u = random.uniform();
    return Choice{Kind::Rock, 0.12 + 0.75 * u * u * u};
}

constexpr Layer kLayers[] = {
    {61, 4.8, 0.005, 900, choose_tree},         {62, 2.6, 0.012, 170, choose_bush},
    {63, 0.2, 0.015, 130, choose_grass},        {64, 0.3, 0.022, 60, choose_flower},
    {65, 0.38, 0.012, 170, choose_water_plant}, {66, 0.9, 0.02, 110, choose_rock},
};

/// Trees that frame the picture, and throw the long shadows across its foreground.
constexpr Plant kFramingTrees[] = {
    {Kind::Oak, 1, 1, 0.95, 0.10, {8.4, 0, -13}},
    {Kind::Birch, 0, 2, 0.9, 0.30, {15, 0, -22}},
    {Kind::Oak, 0, 3, 1.1, 0.70, {17, 0, 12}},
    {Kind::Birch, 1, 0, 1.0, 0.55, {9, 0, 13}},
};

struct Ring {
    double from, to;
};

std::vector<Ring> rings_of(const Layer& layer, double density) {
    const double narrower = 1 / std::sqrt(density);
    std::vector<Ring> rings;
    for (double from = 0.9; from < layer.reach;) {
        const double to = from + narrower * std::max(layer.cell, layer.cell_per_distance * from);
        rings.push_back({from, to});
        from = to;
    }
    return rings;
}

/// Nothing grows far behind the viewer, where it could not even throw a shadow into the picture.
bool worth_planting(dvec2 offset, double distance) {
    return (distance < 40 && offset.y < 25) || -offset.y > 0.35 * distance;
}

Plant make_plant(const Choice& choice, dvec2 at, Random& random) {
    const Species& kind = species()[size_t(choice.kind)];
    Plant plant{choice.kind};
    plant.tint = uint8_t(random.below(uint32_t(kind.tints.size())));
    plant.variant = uint8_t(random.below(kind.variants));
    plant.size = choice.size;
    plant.turn = random.uniform();
    plant.at = {at.x, choice.kind == Kind::Lily ? 0.0 : ground_height(at) - 0.02, at.y};
    if (choice.kind == Kind::Flower) // flowers of one colour grow together
        plant.tint = uint8_t(double(kind.tints.size()) *
                             std::clamp(0.5 + 0.9 * noise(at / 7.0, 60), 0.0, 0.999));
    return plant;
}

void plant_ring(const Layer& layer, const Ring& ring, uint64_t number, std::vector<Plant>& out) {
    const double size = ring.to - ring.from;
    const uint32_t cells = uint32_t(6.283 * ring.from / size) + 1;
    for (uint32_t cell = 0; cell < cells; ++cell) {
        Random random(mix_bits(layer.seed ^ number << 32), cell);
        const double distance = ring.from + size * random.uniform();
        const dvec2 offset = distance * circle((cell + random.uniform()) / cells);
        if (!worth_planting(offset, distance))
            continue;
        Site site{kViewpoint + offset, distance};
        site.shore = shore_distance(site.at);
        site.height = ground_height(site.at);
        if (const std::optional<Choice> choice = layer.choose(site, random))
            out.push_back(make_plant(*choice, site.at, random));
    }
}

} // namespace

std::vector<Plant> place_plants(double density) {
    std::vector<Plant> plants;
    for (const Plant& plant : kFramingTrees) {
        plants.push_back(plant);
        plants.back().at.y = ground_height({plant.at.x, plant.at.z}) - 0.05;
    }
    for (const Layer& layer : kLayers) {
        const std::vector<Ring> rings = rings_of(layer, density);
        std::vector<std::vector<Plant>> by_ring(rings.size());
        parallel_for(rings.size(), 1, [&](size_t first, size_t last) {
            for (size_t r = first; r < last; ++r)
                plant_ring(layer, rings[r], r, by_ring[r]);
        });
        for (const std::vector<Plant>& ring : by_ring)
            plants.insert(plants.end(), ring.begin(), ring.end());
    }
    return plants;
}

} // namespace ovc::plants
