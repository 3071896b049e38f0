// SPDX-License-Identifier: Apache-2.0
// The steel and concrete of a bay.
#include "testscenes/powerplant/plant.h"

namespace ovc::powerplant {

namespace {

/// An I-section from a to b.
void add_girder(Corners& out, dvec3 a, dvec3 b, double width, double height) {
    const dvec3 up(0, height, 0);
    add_bar(out, a, b, 0.08 * width, height);
    add_bar(out, a + up, b + up, width, 0.08 * height);
    add_bar(out, a - up, b - up, width, 0.08 * height);
}

void add_column(Works& works, dvec3 foot) {
    Corners& out = works[Paint::Steel];
    const dvec3 head = foot + dvec3(0, kStorey, 0);
    add_box(out, foot + dvec3(-0.15, 0, -0.012), head + dvec3(0.15, 0, 0.012));
    add_box(out, foot + dvec3(-0.17, 0, -0.15), head + dvec3(-0.14, 0, 0.15));
    add_box(out, foot + dvec3(0.14, 0, -0.15), head + dvec3(0.17, 0, 0.15));
    add_box(out, foot + dvec3(-0.3, 0, -0.3), foot + dvec3(0.3, 0.04, 0.3));
    const dvec2 bolt[] = {{0.03, 0}, {0.03, 0.03}, {0.018, 0.03}, {0.018, 0.08}, {0, 0.08}};
    for (int i = 0; i < 4; ++i)
        add_turned(out, foot + dvec3(i & 1 ? 0.23 : -0.23, 0.04, i & 2 ? 0.23 : -0.23), {0, 1, 0},
                   bolt, 6);
}

void add_beams(Works& works, dvec3 corner) {
    Corners& out = works[Paint::Steel];
    const dvec3 at = corner + dvec3(0, kStorey - 0.35, 0);
    add_girder(out, at, at + dvec3(kBay, 0, 0), 0.11, 0.2);
    add_girder(out, at, at + dvec3(0, 0, kBay), 0.11, 0.2);
    for (int joist = 1; joist < 4; ++joist) {
        const dvec3 from = at + dvec3(0.25 * joist * kBay, 0.1, 0);
        add_girder(out, from, from + dvec3(0, 0, kBay), 0.06, 0.09);
    }
    add_bar(out, at - dvec3(0, 0.2, 0) + dvec3(0.9, 0, 0), corner + dvec3(0, kStorey - 1.4, 0),
            0.04, 0.04); // knee braces
    add_bar(out, at - dvec3(0, 0.2, 0) + dvec3(0, 0, 0.9), corner + dvec3(0, kStorey - 1.4, 0),
            0.04, 0.04);
}

/// Bars on edge, ten centimetres apart, and ties across.
void add_grating(Corners& out, dvec3 corner) {
    constexpr int kBars = 60, kTies = 12;
    for (int i = 0; i <= kBars; ++i) {
        const double x = corner.x + kBay * i / kBars;
        add_box(out, {x - 0.003, corner.y - 0.04, corner.z},
                {x + 0.003, corner.y, corner.z + kBay});
    }
    for (int i = 0; i <= kTies; ++i) {
        const double z = corner.z + kBay * i / kTies;
        add_box(out, {corner.x, corner.y - 0.02, z - 0.004},
                {corner.x + kBay, corner.y - 0.008, z + 0.004});
    }
}

bool is_shaft(const Plan& plan, const Bay& bay) {
    return bay.x == plan.shaft() && bay.z == plan.aisle();
}

bool is_stairwell(const Plan& plan, const Bay& bay) {
    return bay.x == plan.shaft() && bay.z == plan.aisle() + 1;
}

void add_floor(Works& works, const Plan& plan, const Bay& bay) {
    const dvec3 at = bay.corner();
    if (bay.storey > 0 && (is_shaft(plan, bay) || is_stairwell(plan, bay)))
        return;
    const bool grating = bay.storey > 0 && bay.z != plan.aisle() && (bay.x + bay.z) % 3 == 1;
    if (grating)
        add_grating(works[Paint::Grating], at);
    else
        add_box(works[Paint::Concrete], at - dvec3(0, 0.15, 0), at + dvec3(kBay, 0, kBay));
}

/// Round the shaft, with the sides open where one walks in.
void add_shaft_railings(Works& works, const Plan& plan, const Bay& bay) {
    if (!is_shaft(plan, bay) || bay.storey == 0)
        return;
    const dvec3 at = bay.corner();
    add_railing(works, at + dvec3(0, 0, 0.1), at + dvec3(kBay, 0, 0.1));
    add_railing(works, at + dvec3(0.1, 0, 0), at + dvec3(0.1, 0, kBay));
    add_railing(works, at + dvec3(kBay - 0.1, 0, 0), at + dvec3(kBay - 0.1, 0, kBay));
}

/// Corrugated sheet from `from` to `to` on the floor, between two heights; thick: to which side.
void add_sheet(Corners& out, dvec3 from, dvec3 to, double bottom, double top, dvec3 thick) {
    constexpr int kFolds = 40;
    const dvec3 step = (to - from) / double(kFolds);
    const auto at = [&](double fold, bool out_of_line, double height) {
        return from + fold * step + (out_of_line ? 0.06 : 0.0) * thick + dvec3(0, height, 0);
    };
    for (int fold = 0; fold < kFolds; ++fold) {
        const bool side = fold % 2 == 1;
        add_quad(out, at(fold, side, bottom), at(fold + 0.8, side, bottom),
                 at(fold + 0.8, side, top), at(fold, side, top));
        add_quad(out, at(fold + 0.8, side, bottom), at(fold + 1, !side, bottom),
                 at(fold + 1, !side, top), at(fold + 0.8, side, top));
    }
}

/// A band of panes over a band of sheet; the aisle's ends stay open.
void add_facade(Works& works, const Plan& plan, const Bay& bay) {
    const dvec3 at = bay.corner();
    const auto side = [&](dvec3 from, dvec3 to, dvec3 outwards) {
        from += 0.25 * outwards;
        to += 0.25 * outwards;
        add_sheet(works[Paint::Sheet], from, to, 0, 2.6, outwards);
        add_sheet(works[Paint::Sheet], from, to, 4.1, 5, outwards);
        const dvec3 step = (to - from) / 8.0;
        for (int pane = 0; pane < 8; ++pane) {
            const dvec3 a = from + double(pane) * step + dvec3(0, 2.6, 0);
            add_bar(works[Paint::Steel], a, a + dvec3(0, 1.5, 0), 0.03, 0.03);
            if ((bay.x * 7 + bay.z * 3 + bay.storey * 5 + uint32_t(pane)) % 6 > 1)
                add_quad(works[Paint::Window], a + 0.05 * step, a + 0.95 * step,
                         a + 0.95 * step + dvec3(0, 1.5, 0), a + 0.05 * step + dvec3(0, 1.5, 0));
        }
    };
    const bool door = bay.z == plan.aisle() && bay.storey == 0;
    if (bay.x == 0)
        side(at, at + dvec3(0, 0, kBay), {-1, 0, 0});
    if (bay.x + 1 == plan.bays_x && !door)
        side(at + dvec3(kBay, 0, 0), at + dvec3(kBay, 0, kBay), {1, 0, 0});
    // The front shows its inside: only every other bay is clad.
    if (bay.z + 1 == plan.bays_z && (bay.x + bay.storey) % 3 != 0)
        side(at + dvec3(0, 0, kBay), at + dvec3(kBay, 0, kBay), {0, 0, 1});
    if (bay.z == 0)
        side(at, at + dvec3(kBay, 0, 0), {0, 0, -1});
}

/// Walls between rooms, with a doorway in the aisle.
void add_inner_wall(Works& works, const Plan& plan, const Bay& bay) {
    if (bay.x != plan.first_wall() && bay.x != plan.second_wall())
        return;
    const dvec3 at = bay.corner();
    Corners& out = works[Paint::Concrete];
    const auto wall = [&](double z0, double z1, double y0, double y1) {
        add_box(out, at + dvec3(-0.12, y0, z0), at + dvec3(0.12, y1, z1));
    };
    if (bay.z != plan.aisle()) {
        wall(0, kBay, 0, 3.4);
        return;
    }
    wall(0, 1.6, 0, 3.4);
    wall(kBay - 1.6, kBay, 0, 3.4);
    wall(1.6, kBay - 1.6, 2.8, 3.4);
    add_box(works[Paint::Rail], at + dvec3(-0.16, 0, 1.6), at + dvec3(0.16, 2.85, 1.68));
    add_box(works[Paint::Rail], at + dvec3(-0.16, 0, kBay - 1.68),
            at + dvec3(0.16, 2.85, kBay - 1.6));
    add_box(works[Paint::Rail], at + dvec3(-0.16, 2.77, 1.6), at + dvec3(0.16, 2.85, kBay - 1.6));
}

void add_lamps(Works& works, dvec3 corner) {
    for (int i = 0; i < 2; ++i) {
        const dvec3 at = corner + dvec3(1.6 + 2.8 * i, kStorey - 0.62, 3);
        const dvec2 shade[] = {
            {0.05, 0.28}, {0.06, 0.1}, {0.32, -0.12}, {0.3, -0.12}, {0.05, 0.06}};
        add_turned(works[Paint::Rail], at, {0, 1, 0}, shade, 20);
        const dvec2 bulb[] = {{0, -0.14}, {0.06, -0.1}, {0.08, -0.03}, {0.04, 0.08}};
        add_turned(works[Paint::Window], at, {0, 1, 0}, bulb, 14);
    }
}

/// Two flights of steps with a landing between, and rails.
void add_stairs(Works& works, dvec3 corner) {
    constexpr int kSteps = 13;
    constexpr double kRise = kStorey / (2 * kSteps), kGoing = 0.28;
    const double length = kSteps * kGoing;
    for (int flight = 0; flight < 2; ++flight) {
        const double sense = flight == 0 ? 1 : -1, z = corner.z + (flight == 0 ? 1.2 : 3.2);
        const dvec3 foot(corner.x + (flight == 0 ? 1.0 : 1.0 + length),
                         corner.y + 0.5 * kStorey * flight, z);
        for (int step = 0; step < kSteps; ++step)
            for (int bar = 0; bar < 5; ++bar) {
                const double x = foot.x + sense * kGoing * (step + 0.2 * bar),
                             y = foot.y + kRise * (step + 1);
                add_box(works[Paint::Grating], {x - 0.012, y - 0.03, z}, {x + 0.012, y, z + 1.1});
            }
        const dvec3 rise(sense * length, 0.5 * kStorey, 0);
        for (const double side : {0.0, 1.1}) {
            const dvec3 at = foot + dvec3(0, 0.05, side);
            add_bar(works[Paint::Steel], at, at + rise, 0.02, 0.13);
            add_railing(works, at, at + rise);
        }
    }
    const dvec3 landing(corner.x + 1.0 + length, corner.y + 0.5 * kStorey, corner.z + 1.2);
    add_box(works[Paint::Steel], landing - dvec3(0, 0.05, 0), landing + dvec3(1.2, 0, 3.1));
    add_railing(works, landing + dvec3(1.15, 0, 0), landing + dvec3(1.15, 0, 3.1));
}

} // namespace

void add_structure(Works& works, const Plan& plan, const Bay& bay) {
    const dvec3 at = bay.corner();
    for (uint32_t i = 0; i < 4; ++i) // a column in its corner, and where the hall ends, in others
        if ((!(i & 1) || bay.x + 1 == plan.bays_x) && (!(i & 2) || bay.z + 1 == plan.bays_z))
            add_column(works, at + dvec3(i & 1 ? kBay : 0, 0, i & 2 ? kBay : 0));
    if (!is_shaft(plan, bay) && !is_stairwell(plan, bay))
        add_beams(works, at);
    add_floor(works, plan, bay);
    add_shaft_railings(works, plan, bay);
    add_facade(works, plan, bay);
    add_inner_wall(works, plan, bay);
    add_lamps(works, at);
    if (is_stairwell(plan, bay) && bay.storey + 1 < plan.storeys)
        add_stairs(works, at);
    if (bay.storey + 1 == plan.storeys)
        add_box(works[Paint::Sheet], at + dvec3(0, kStorey, 0),
                at + dvec3(kBay, kStorey + 0.2, kBay));
}

} // namespace ovc::powerplant
