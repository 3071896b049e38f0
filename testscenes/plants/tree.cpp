// SPDX-License-Identifier: Apache-2.0
// Broad-leaved trees and bushes: wood grown into a crown, leaves around its twigs.
#include "testscenes/plants/prototype.h"
#include "testscenes/plants/skeleton.h"

#include <algorithm>
#include <cmath>

namespace ovc::plants {

namespace {

struct Foliage {
    double leaves = 9000;      // at full detail
    double length = 0.2;       // of a leaf at full detail; fewer leaves are larger
    double width = 0.6;        // as a share of its length
    double spread = 0.5;       // how far from its twig a leaf may sit
    double twig_radius = 0.03; // leaves grow on wood thinner than this
};

void add_foliage(Corners& out, const std::vector<Knot>& knots, const Crown& crown,
                 const Foliage& foliage, double detail, Random& random) {
    std::vector<uint32_t> twigs;
    for (uint32_t k = 0; k < knots.size(); ++k)
        if (knots[k].radius < foliage.twig_radius)
            twigs.push_back(k);
    if (twigs.empty())
        return;
    const uint32_t count = scaled(foliage.leaves, detail, 60);
    const double length = foliage.length * std::sqrt(foliage.leaves / count);
    const dvec3 heart(0, 0.4 * crown.bottom + 0.6 * crown.top - 0.3 * crown.radius, 0);
    for (uint32_t i = 0; i < count; ++i) {
        const Knot& twig = knots[twigs[random.below(uint32_t(twigs.size()))]];
        const dvec3 base = twig.at + foliage.spread * random.in_ball();
        const dvec3 outwards = glm::normalize(base - heart + dvec3(0, 1e-3, 0));
        // Leaves face outwards and up, mostly: so the crown is lit as a body, and still sparkles.
        const dvec3 normal =
            glm::normalize(0.8 * outwards + dvec3(0, 0.45, 0) + 0.75 * random.direction());
        const dvec3 wish = random.direction() + 0.5 * outwards - dvec3(0, 0.35, 0);
        const dvec3 flat = wish - normal * glm::dot(wish, normal);
        if (glm::dot(flat, flat) < 1e-6)
            continue;
        const double size = length * random.uniform(0.7, 1.25);
        add_leaf(out, base, size * glm::normalize(flat), normal, foliage.width * size);
    }
}

struct Tree {
    Prototype prototype;
    std::vector<Knot> knots;
};

Tree make_tree(const Crown& crown, const Foliage& foliage, double tip_radius, Random& random,
               double detail) {
    Tree tree{{}, grow(crown, tip_radius, random)};
    const double thinnest = detail > 0.5 ? 0 : detail > 0.1 ? 1.5 * tip_radius : 4 * tip_radius;
    add_wood(tree.prototype[Part::Wood], tree.knots, thinnest, detail);
    add_foliage(tree.prototype[Part::Tinted], tree.knots, crown, foliage, detail, random);
    return tree;
}

/// Strings of narrow leaves that hang from the tips, for a willow.
void add_hanging(Corners& out, const std::vector<Knot>& knots, double detail, Random& random) {
    const double length = 0.24 / std::sqrt(std::max(detail, 0.02));
    for (const Knot& knot : knots) {
        if (!knot.is_tip || knot.at.y < 2.2)
            continue;
        const uint32_t strings = scaled(6, detail, 1);
        for (uint32_t s = 0; s < strings; ++s) {
            dvec3 at = knot.at + 0.5 * random.in_ball();
            dvec3 along = glm::normalize(knot.along + 0.6 * random.in_ball() + dvec3(0, 0.2, 0));
            const double end = std::max(0.5, at.y - random.uniform(1.4, 4.2));
            for (int i = 0; i < 60 && at.y > end; ++i) {
                along = glm::normalize(along + dvec3(0, -0.32, 0) + 0.12 * random.in_ball());
                at += along * length * 0.62;
                const dvec3 droop = glm::normalize(along + 0.7 * random.in_ball());
                const dvec3 normal = any_perpendicular(droop) + 0.6 * random.in_ball();
                add_leaf(out, at, length * droop, normal, 0.24 * length);
            }
        }
    }
}

} // namespace

uint32_t scaled(double count, double detail, uint32_t min_count) {
    return std::max(min_count, uint32_t(count * detail + 0.5));
}

void add_leaf(Corners& out, dvec3 base, dvec3 along, dvec3 normal, double width) {
    const dvec3 side = glm::cross(normal, along);
    const double length = std::sqrt(glm::dot(side, side));
    if (!(length > 1e-12))
        return;
    const dvec3 half = side * (0.5 * width / length);
    const dvec3 middle = base + 0.45 * along + normal * (0.12 * width);
    const dvec3 tip = base + along;
    add_triangle(out, base, middle - half, tip);
    add_triangle(out, base, tip, middle + half);
}

Prototype make_oak(Random random, double detail) {
    const double height = random.uniform(8.5, 12);
    const Crown crown{height * 0.2, height, height * random.uniform(0.38, 0.46), 0.42, 0.55, 620};
    return make_tree(crown, {16000, 0.2, 0.62, 0.55, 0.035}, 0.013, random, detail).prototype;
}

Prototype make_birch(Random random, double detail) {
    const double height = random.uniform(9, 13);
    const Crown crown{height * 0.22, height, height * random.uniform(0.17, 0.22), 0.35, 0.2, 420};
    return make_tree(crown, {9000, 0.15, 0.7, 0.4, 0.03}, 0.007, random, detail).prototype;
}

Prototype make_willow(Random random, double detail) {
    const double height = random.uniform(7, 9);
    const Crown crown{height * 0.35, height, height * 0.46, 0.5, 0.6, 260};
    Tree tree = make_tree(crown, {2500, 0.2, 0.3, 0.5, 0.03}, 0.016, random, detail);
    add_hanging(tree.prototype[Part::Tinted], tree.knots, detail, random);
    return tree.prototype;
}

Prototype make_bush(Random random, double detail) {
    const double height = random.uniform(1.3, 2.4);
    const Crown crown{0.15, height, height * random.uniform(0.55, 0.8), 0.5, 0.5, 160};
    return make_tree(crown, {3600, 0.11, 0.6, 0.2, 0.03}, 0.006, random, detail).prototype;
}

} // namespace ovc::plants
