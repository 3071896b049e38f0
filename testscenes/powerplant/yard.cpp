// SPDX-License-Identifier: Apache-2.0
// Outside the hall: ground, chimneys, cooling tower, tank farm, conveyor, coal.
#include "testscenes/noise.h"
#include "testscenes/powerplant/plant.h"
#include "testscenes/tube.h"

#include <algorithm>
#include <cassert>

namespace ovc::powerplant {

namespace {

void add_ground(Works& works, const Plan& plan) {
    const double reach = 3 * (plan.length() + plan.depth());
    add_quad(works[Paint::Concrete], {-reach, -0.2, -reach}, {-reach, -0.2, reach},
             {reach, -0.2, reach}, {reach, -0.2, -reach});
}

void add_chimney(Works& works, dvec3 foot, double height) {
    std::vector<dvec2> wall;
    constexpr int kRings = 60;
    for (int i = 0; i <= kRings; ++i) {
        const double share = double(i) / kRings, r = height * (0.055 - 0.028 * share);
        wall.push_back({r, height * share});
        if (i % 6 == 5) // platforms
            for (const dvec2& p :
                 {dvec2(r * 1.25, height * share), dvec2(r * 1.25, height * share + 0.2),
                  dvec2(r, height * share + 0.2)})
                wall.push_back(p);
    }
    wall.push_back({0.8 * wall.back().x, height + 0.1});
    wall.push_back({0.8 * wall.back().x, 0.5 * height}); // the flue
    add_turned(works[Paint::Concrete], foot, kUp, wall, 48);
}

/// A hyperboloid shell on legs.
void add_cooling_tower(Works& works, dvec3 foot, double height) {
    constexpr int kRings = 40, kLegs = 44;
    std::vector<dvec2> shell;
    const auto radius = [&](double share) {
        const double x = (share - 0.72) / 0.55;
        return height * 0.21 * std::sqrt(1 + 0.9 * x * x);
    };
    for (int i = 0; i <= kRings; ++i)
        shell.push_back({radius(double(i) / kRings), height * (0.08 + 0.92 * i / kRings)});
    for (int i = kRings; i >= 0; --i) // the inside
        shell.push_back({0.985 * radius(double(i) / kRings), height * (0.08 + 0.92 * i / kRings)});
    add_turned(works[Paint::Concrete], foot, kUp, shell, 96);
    const double ring = radius(0), ground = radius(-0.08);
    for (int leg = 0; leg < 2 * kLegs; ++leg) { // pairs that lean towards each other
        const dvec2 a = circle((leg / 2 + (leg % 2 ? 0.9 : 0.1)) / kLegs),
                    b = circle((leg / 2 + 0.5) / kLegs);
        add_rod(works[Paint::Concrete], foot + ground * dvec3(a.x, 0, a.y),
                foot + ring * dvec3(b.x, 0, b.y) + dvec3(0, 0.085 * height, 0), 0.008 * height, 10);
    }
}

void add_tank_farm(Works& works, const Plan& plan) {
    for (int i = 0; i < 4; ++i) {
        // Two to each side of the way to the door.
        const double door = kBay * (plan.aisle() + 0.5), aside = 8 + 13 * (i % 2);
        const dvec3 foot(plan.length() + 22, -0.2, i < 2 ? door - aside : door + aside);
        const dvec2 shell[] = {{5, 0},      {5, 3},       {5.08, 3.02}, {5.08, 3.1}, {5, 3.12},
                               {5, 6},      {5.08, 6.02}, {5.08, 6.1},  {5, 6.12},   {5, 8},
                               {5.2, 8.02}, {5.2, 8.2},   {2.5, 8.9},   {0, 9.1}};
        add_turned(works[i % 2 ? Paint::Lagging : Paint::Sheet], foot, kUp, shell, 64);
        const dvec3 line[] = {foot + dvec3(-4.9, 1.5, 0),
                              foot + dvec3(-8, 1.5, 0),
                              {foot.x - 8, 6.5, foot.z},
                              {plan.length() - 0.5, 6.5, foot.z}};
        add_pipe(works, Paint::Oil, line, 0.3, true);
        for (int step = 0; step < 60; ++step) { // a stair round the shell
            const dvec2 c = circle(0.3 + 0.6 * step / 60), d = circle(0.3 + 0.6 * (step + 1) / 60);
            const dvec3 at = foot + dvec3(5.4 * c.x, 8.0 * step / 60, 5.4 * c.y),
                        next = foot + dvec3(5.4 * d.x, 8.0 * (step + 1) / 60, 5.4 * d.y);
            const dvec3 out(0.4 * c.x, 0, 0.4 * c.y);
            add_bar(works[Paint::Grating], at - out, at + out, 0.14, 0.02);
            add_rod(works[Paint::Rail], at + out, at + out + kUp, 0.02, 8);
            add_rod(works[Paint::Rail], at + out + kUp, next + out + kUp, 0.02, 8);
        }
    }
}

/// A covered belt from the coal to the roof, on trestles.
void add_conveyor(Works& works, const Plan& plan) {
    const dvec3 from(-48, 1.5, 0.5 * plan.depth()), to(1, plan.height() - 2, 0.5 * plan.depth());
    constexpr int kPieces = 24;
    for (int i = 0; i < kPieces; ++i) {
        const dvec3 a = from + (to - from) * (double(i) / kPieces),
                    b = from + (to - from) * ((i + 1.0) / kPieces);
        for (const double side : {-1.3, 1.3}) {
            const dvec3 z(0, 0, side);
            add_bar(works[Paint::Steel], a + z, b + z, 0.08, 0.12);
            add_bar(works[Paint::Steel], a + z + 2.4 * kUp, b + z + 2.4 * kUp, 0.08, 0.1);
            add_bar(works[Paint::Steel], a + z, b + z + 2.4 * kUp, 0.05, 0.05);
            add_bar(works[Paint::Steel], a + z, a + z + 2.4 * kUp, 0.05, 0.05);
        }
        add_bar(works[Paint::Cable], a + 0.5 * kUp, b + 0.5 * kUp, 0.8, 0.03);
        add_bar(works[Paint::Sheet], a + 2.6 * kUp, b + 2.6 * kUp, 1.5, 0.03);
        add_rod(works[Paint::Steel], a + dvec3(0, 0.4, -0.85), a + dvec3(0, 0.4, 0.85), 0.07, 14);
        if (i % 6 == 3)
            for (const double side : {-1.3, 1.3}) {
                add_bar(works[Paint::Steel], {a.x - 1.2, -0.2, a.z + 2 * side},
                        a + dvec3(0, 0, side), 0.15, 0.15);
                add_bar(works[Paint::Steel], {a.x + 1.2, -0.2, a.z + 2 * side},
                        a + dvec3(0, 0, side), 0.15, 0.15);
            }
    }
}

} // namespace

void add_yard(Works& works, const Plan& plan) {
    add_ground(works, plan);
    const double height = 0.5 * plan.length() + plan.height();
    add_chimney(works, {0.3 * plan.length(), -0.2, -14}, 1.35 * height);
    add_chimney(works, {0.7 * plan.length(), -0.2, -14}, 1.35 * height);
    add_cooling_tower(works, {-0.15 * plan.length() - 20, -0.2, -0.75 * height - 12}, height);
    add_tank_farm(works, plan);
    add_conveyor(works, plan);
}

void add_coal_heap(Works& works, const Plan& plan, uint64_t triangles) {
    assert(triangles % 2 == 0 && triangles >= kMinHeap);
    const double radius = 20, height = 10;
    const dvec3 middle(-58, -0.4, 0.5 * plan.depth());
    const TubeGrid grid = tube_grid(triangles, 0.5);
    Surface heap;
    add_tube(heap, grid, false, [&](uint32_t ring, double turns) {
        // From below the ground to the top, with all but the first ring above it.
        const double share = double(ring) / (grid.along + 1);
        const dvec2 c = circle(turns);
        const double r = radius * (share < 0.02 ? share / 0.02 : (1 - share) / 0.98);
        const dvec2 at(middle.x + r * c.x, middle.z + 1.1 * r * c.y);
        const double slope = share < 0.02 ? 0 : 1 - r / radius;
        const double lumps =
            slope * (3 * fractal_noise(at / 9.0, 3, 331) + 0.9 * fractal_noise(at * 1.3, 4, 332));
        return dvec3(at.x, middle.y + height * slope + lumps * smooth_step(0, 0.15, slope), at.y);
    });
    Corners& coal = works[Paint::Coal];
    coal.insert(coal.end(), heap.corners.begin(), heap.corners.end());
}

} // namespace ovc::powerplant
