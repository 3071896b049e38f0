// SPDX-License-Identifier: Apache-2.0
// Grass, reeds, flowers and water lilies.
#include "testscenes/noise.h"
#include "testscenes/plants/prototype.h"

#include <algorithm>
#include <cmath>

namespace ovc::plants {

namespace {

dvec3 level(double turns) {
    const dvec2 c = circle(turns);
    return {c.x, 0, c.y};
}

/// A point beside the middle of a plant, at a distance between `from` and `to`.
dvec3 beside(Random& random, double from, double to) {
    const dvec3 outwards = level(random.uniform());
    return outwards * random.uniform(from, to);
}

/// A blade that bends over towards `lean` in `segments` steps, the last one a point.
void add_blade(Corners& out, dvec3 base, double height, dvec3 lean, double width, int segments) {
    const double lean_length = std::sqrt(glm::dot(lean, lean));
    const dvec3 side =
        lean_length > 1e-9 ? dvec3(-lean.z, 0, lean.x) / lean_length : dvec3(1, 0, 0);
    const auto at = [&](double s) {
        return base + dvec3(0, height * s * (1.15 - 0.15 * s), 0) + lean * (s * s);
    };
    for (int i = 0; i < segments; ++i) {
        const double from = double(i) / segments, to = double(i + 1) / segments;
        const dvec3 a = side * (0.5 * width * (1 - 0.7 * from)),
                    b = side * (0.5 * width * (1 - 0.7 * to));
        if (i + 1 == segments)
            add_triangle(out, at(from) - a, at(from) + a, at(to));
        else
            add_quad(out, at(from) - a, at(from) + a, at(to) + b, at(to) - b);
    }
}

struct Tuft {
    double blades;
    double radius;
    double height;
    double bend; // as a share of the height
    double width;
    uint32_t min_blades;
};

void add_tuft(Corners& out, const Tuft& tuft, double detail, Random& random) {
    const uint32_t count = scaled(tuft.blades, detail, tuft.min_blades);
    const double width = tuft.width * std::min(4.0, std::sqrt(tuft.blades / count));
    const double radius = detail > 0.2 ? tuft.radius : 2 * tuft.radius; // hides gaps far away
    const int segments = detail > 0.6 ? 3 : detail > 0.2 ? 2 : 1;
    for (uint32_t i = 0; i < count; ++i) {
        const double out_by = std::sqrt(random.uniform());
        const dvec3 outwards = level(random.uniform());
        const double height = tuft.height * random.uniform(0.55, 1.1);
        const dvec3 towards = outwards * (0.3 + out_by) + level(random.uniform()) * 0.5;
        const dvec3 lean = towards * (height * tuft.bend * random.uniform(0.2, 1.0));
        const dvec3 base = outwards * (out_by * radius) - dvec3(0, 0.05, 0);
        add_blade(out, base, height, lean, width * random.uniform(0.7, 1.3), segments);
    }
}

void add_petals(Corners& out, dvec3 centre, double length, uint32_t petals, double lift,
                double width, Random& random) {
    const double turn = random.uniform();
    for (uint32_t i = 0; i < petals; ++i) {
        const dvec3 outwards = level(turn + double(i) / petals);
        const dvec3 along = length * glm::normalize(outwards + dvec3(0, lift, 0));
        add_leaf(out, centre, along, dvec3(0, 1, 0) - lift * outwards, width * length);
    }
}

void add_cattail(Corners& out, dvec3 foot, double length, double radius) {
    const dvec3 up(0, length, 0);
    for (int i = 0; i < 5; ++i) {
        const dvec3 a = radius * level(i / 5.0), b = radius * level((i + 1) / 5.0);
        add_quad(out, foot + a, foot + b, foot + b + up, foot + a + up);
        add_triangle(out, foot + a + up, foot + b + up, foot + 1.15 * up);
    }
}

Prototype make_blossoms(Random& random, double detail, uint32_t petals, double size, double lift,
                        double height) {
    Prototype plant;
    const bool coarse = detail < 0.2;
    add_tuft(plant[Part::Wood], {9, 0.08, 0.5 * height, 0.7, 0.014, 4}, detail, random);
    const uint32_t stems = 2 + random.below(4);
    for (uint32_t i = 0; i < stems; ++i) {
        const dvec3 base = beside(random, 0, 0.1);
        const dvec3 lean = beside(random, 0.02, 0.14);
        const double tall = height * random.uniform(0.7, 1.15);
        add_blade(plant[Part::Wood], base, tall, lean, 0.008, 2);
        const dvec3 head = base + lean + dvec3(0, tall, 0);
        add_petals(plant[Part::Tinted], head, size, coarse ? 5 : petals, lift, coarse ? 1.1 : 0.7,
                   random);
        if (coarse)
            continue;
        add_petals(plant[Part::Accent], head + dvec3(0, 0.1 * size, 0), 0.32 * size, 4, 0.6, 0.9,
                   random);
    }
    return plant;
}

} // namespace

Prototype make_grass(Random random, double detail) {
    Prototype tuft;
    add_tuft(tuft[Part::Tinted], {34, 0.17, random.uniform(0.2, 0.42), 0.8, 0.011, 10}, detail,
             random);
    return tuft;
}

Prototype make_reed(Random random, double detail) {
    Prototype reed;
    add_tuft(reed[Part::Tinted], {22, 0.3, random.uniform(1.1, 1.7), 0.3, 0.03, 8}, detail, random);
    const uint32_t cattails = random.below(3);
    for (uint32_t i = 0; i < cattails; ++i) {
        const dvec3 base = beside(random, 0, 0.25);
        const dvec3 lean = beside(random, 0, 0.12);
        const double tall = random.uniform(1.2, 1.8);
        add_blade(reed[Part::Tinted], base, tall + 0.3, lean, 0.018, 2);
        add_cattail(reed[Part::Accent], base + lean * 0.7 + dvec3(0, tall, 0), 0.15, 0.014);
    }
    return reed;
}

Prototype make_flower(Random random, double detail) {
    return make_blossoms(random, detail, 5, 0.05, 0.8, 0.42);
}

Prototype make_daisy(Random random, double detail) {
    return make_blossoms(random, detail, 11, 0.04, 0.12, 0.3);
}

Prototype make_lily(Random random, double detail) {
    Prototype lily;
    const uint32_t pads = 3 + random.below(4);
    for (uint32_t p = 0; p < pads; ++p) {
        const dvec3 centre = beside(random, 0.1, 0.6) + dvec3(0, 0.012 + 0.004 * p, 0);
        const double radius = random.uniform(0.1, 0.2), turn = random.uniform();
        const uint32_t sides = scaled(14, detail, 7);
        for (uint32_t i = 0; i + 1 < sides; ++i) { // one sector stays open: the notch
            const dvec3 rise(0, 0.008, 0);
            add_triangle(lily[Part::Tinted], centre,
                         centre + radius * level(turn + double(i + 1) / sides) + rise,
                         centre + radius * level(turn + double(i) / sides) + rise);
        }
    }
    if (random.chance(0.5)) {
        const dvec3 heart = level(random.uniform()) * 0.1 + dvec3(0, 0.03, 0);
        add_petals(lily[Part::Accent], heart, 0.11, 8, 0.5, 0.5, random);
        add_petals(lily[Part::Accent], heart + dvec3(0, 0.01, 0), 0.08, 7, 1.4, 0.5, random);
    }
    return lily;
}

} // namespace ovc::plants
