// SPDX-License-Identifier: Apache-2.0
// Pipes and cables.
#include "testscenes/noise.h"
#include "testscenes/powerplant/plant.h"

namespace ovc::powerplant {

namespace {

constexpr Paint kMedia[] = {Paint::Lagging, Paint::Water, Paint::Gas,  Paint::Lagging,
                            Paint::Oil,     Paint::Fire,  Paint::Brass};

Paint pick_medium(Random& random) {
    return kMedia[random.below(std::size(kMedia))];
}

/// A strap and a rod from the ceiling.
void add_hanger(Corners& out, dvec3 at, double radius, double ceiling) {
    std::vector<dvec3> strap;
    for (int i = 0; i < 12; ++i) {
        const dvec2 c = circle(i / 12.0);
        strap.push_back(at + (radius + 0.012) * dvec3(0, c.x, c.y));
    }
    add_sweep(out, strap, 0.014, 6, true);
    add_rod(out, at + dvec3(0, radius, 0), {at.x, ceiling, at.z}, 0.012, 6);
}

/// A loop that lets a hot pipe grow.
std::vector<dvec3> line_with_loops(dvec3 from, double length, double loop, Random& random) {
    std::vector<dvec3> line = {from};
    for (double x = 12 + random.uniform(0, 20); loop > 0 && x < length - 12; x += 34) {
        line.push_back(from + dvec3(x, 0, 0));
        line.push_back(from + dvec3(x, -loop, 0));
        line.push_back(from + dvec3(x + 2.5, -loop, 0));
        line.push_back(from + dvec3(x + 2.5, 0, 0));
    }
    line.push_back(from + dvec3(length, 0, 0));
    return line;
}

} // namespace

void add_pipe_rack(Works& works, const Plan& plan, uint32_t storey, uint32_t row) {
    Random random(301, uint64_t(storey) << 32 | row);
    const double ceiling = kStorey * (storey + 1) - 0.55;
    const bool aisle = row == plan.aisle();
    // Over the aisle only along its sides, so that the shaft stays open.
    for (double z = 0.45; z < kBay - 0.3;) {
        const double radius = 0.04 + 0.17 * random.uniform() * random.uniform();
        if (aisle && z > 1.4 && z < 4.5)
            z = 4.5;
        const double y = ceiling - 0.25 - radius - (random.chance(0.3) ? 0.5 : 0);
        const dvec3 from(-0.15, y, kBay * row + z + radius);
        const double loop = !aisle && random.chance(0.3) ? 0.7 : 0;
        add_pipe(works, pick_medium(random),
                 line_with_loops(from, plan.length() + 0.3, loop, random), radius,
                 random.chance(0.15));
        for (uint32_t bay = 0; bay < plan.bays_x; ++bay)
            add_hanger(works[Paint::Steel], from + dvec3(kBay * bay + 1.5, 0, 0), radius, ceiling);
        z += 2 * radius + 0.22 + 0.25 * random.uniform();
    }
}

void add_cable_trays(Works& works, const Bay& bay, Random& random) {
    const dvec3 at = bay.corner();
    const double y = at.y + kStorey - 1.45 - 0.3 * random.below(2),
                 z = at.z + 0.5 + 0.35 * random.below(3);
    for (const double side : {0.0, 0.5})
        add_box(works[Paint::Steel], {at.x, y, z + side}, {at.x + kBay, y + 0.1, z + side + 0.008});
    for (int rung = 0; rung < 20; ++rung)
        add_box(works[Paint::Steel], {at.x + 0.3 * rung, y, z},
                {at.x + 0.3 * rung + 0.03, y + 0.015, z + 0.5});
    for (int cable = 0; cable < 9; ++cable) {
        const double radius = random.uniform(0.012, 0.028);
        std::vector<dvec3> line;
        constexpr int kPieces = 20;
        for (int i = 0; i <= kPieces; ++i) {
            // Whole waves at the bay's ends, where the next bay goes on.
            const double fade = smooth_step(0, 3, i) * smooth_step(kPieces, kPieces - 3, i);
            const double sway = 0.03 * fade * noise(dvec2(0.7 * i, cable + 10.0 * bay.x), 311);
            line.push_back({at.x + kBay * i / kPieces, y + 0.015 + radius + 0.02 * (cable % 2),
                            z + 0.05 + 0.05 * cable + sway});
        }
        add_sweep(works[Paint::Cable], line, radius, 8);
    }
}

void add_risers(Works& works, const Bay& bay, Random& random) {
    const dvec3 at = bay.corner();
    const uint32_t count = 1 + random.below(3);
    for (uint32_t i = 0; i < count; ++i) {
        const double radius = random.uniform(0.04, 0.12);
        const double x = at.x + 0.5 + 0.42 * i, z = at.z + kBay - 0.45 - 0.2 * random.below(2);
        const double knee = at.y + random.uniform(1.0, 2.2);
        const double away = random.uniform(0.8, 1.6);
        const dvec3 line[] = {
            {x, at.y, z}, {x, knee, z}, {x, knee, z - away}, {x, at.y + kStorey, z - away}};
        add_pipe(works, pick_medium(random), line, radius, random.chance(0.6));
    }
}

} // namespace ovc::powerplant
