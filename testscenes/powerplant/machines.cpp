// SPDX-License-Identifier: Apache-2.0
// Makes the machines in the bays: tanks, heat exchangers, pumps, manifolds, tube walls, cabinets,
// ducts.
#include "testscenes/noise.h"
#include "testscenes/powerplant/plant.h"

namespace ovc::powerplant {

namespace {

constexpr dvec3 kAlong{1, 0, 0}, kAcross{0, 0, 1};

/// A ladder with a cage up the side of something round.
void add_ladder(Works& works, dvec3 foot, double height) {
    Corners& out = works[Paint::Rail];
    for (const double side : {-0.22, 0.22})
        add_rod(out, foot + dvec3(side, 0, 0), foot + dvec3(side, height, 0), 0.02, 8);
    for (double y = 0.3; y < height; y += 0.28)
        add_rod(out, foot + dvec3(-0.22, y, 0), foot + dvec3(0.22, y, 0), 0.012, 6);
    for (double y = 2.1; y < height; y += 0.7) {
        std::vector<dvec3> hoop;
        for (int i = 0; i <= 10; ++i) {
            const dvec2 c = circle(0.5 * i / 10);
            hoop.push_back(foot + dvec3(0.32 * c.x, y, 0.62 * c.y));
        }
        add_sweep(out, hoop, 0.014, 6);
    }
}

void add_tank(Works& works, dvec3 foot, Random& random) {
    const Paint paint = random.chance(0.5) ? Paint::Lagging : Paint::Machine;
    const double r = random.uniform(0.9, 1.5), height = random.uniform(2.2, 3.0);
    std::vector<dvec2> shell = {{0, 0.5}};
    for (int i = 1; i <= 6; ++i)
        shell.push_back({r * circle(i / 24.0).y, 0.9 - 0.4 * circle(i / 24.0).x});
    for (int i = 1; i < 5; ++i) { // seams
        const double y = 0.9 + (height - 0.9) * i / 5;
        for (const dvec2& p : {dvec2(r, y - 0.03), dvec2(r + 0.02, y - 0.02),
                               dvec2(r + 0.02, y + 0.02), dvec2(r, y + 0.03)})
            shell.push_back(p);
    }
    for (int i = 6; i >= 0; --i)
        shell.push_back({i == 0 ? 0 : r * circle(i / 24.0).y, height + 0.4 * circle(i / 24.0).x});
    add_turned(works[paint], foot, kUp, shell, 36);
    for (int leg = 0; leg < 6; ++leg) {
        const dvec2 c = circle(leg / 6.0);
        add_rod(works[Paint::Steel], foot + 0.9 * r * dvec3(c.x, 0, c.y),
                foot + 0.9 * r * dvec3(c.x, 0, c.y) + dvec3(0, 1.0, 0), 0.07, 12);
    }
    for (int nozzle = 0; nozzle < 5; ++nozzle) {
        const dvec2 c = circle(0.3 + 0.19 * nozzle);
        const dvec3 out(c.x, 0, c.y), at = foot + r * out + dvec3(0, 1.1 + 0.37 * nozzle, 0);
        add_rod(works[paint], at - 0.1 * out, at + 0.3 * out, 0.09, 14);
        add_flange(works, paint, at + 0.25 * out, out, 0.09);
    }
    add_flange(works, paint, foot + dvec3(0.3 * r, height + 0.42, 0), kUp, 0.24);
    add_ladder(works, foot + dvec3(0, 0, r + 0.12), height + 0.3);
}

/// A shell on saddles, its tubes bare at one end.
void add_exchanger(Works& works, dvec3 foot, Random& random) {
    const double r = random.uniform(0.5, 0.8), length = 3.4;
    const dvec3 from = foot + dvec3(-0.5 * length, 0.5 + r, 0);
    const dvec2 shell[] = {{0, -0.3}, {0.5 * r, -0.28},   {0.85 * r, -0.18},
                           {r, 0},    {r, 0.35 * length}, {0, 0.35 * length}};
    add_turned(works[Paint::Lagging], from, kAlong, shell, 32);
    for (const double at : {0.02, 0.35 * length, length})
        add_flange(works, Paint::Machine, from + dvec3(at, 0, 0), kAlong, r);
    for (double y = -0.85 * r; y <= 0.85 * r; y += 0.105)
        for (double z = -0.85 * r; z <= 0.85 * r; z += 0.105)
            if (y * y + z * z < 0.7 * r * r)
                add_rod(works[Paint::Brass], from + dvec3(0.33 * length, y, z),
                        from + dvec3(length, y, z), 0.036, 10);
    for (int plate = 1; plate < 5; ++plate) {
        const double x = length * (0.35 + 0.13 * plate);
        const dvec2 disc[] = {{0, x}, {0.93 * r, x}, {0.93 * r, x + 0.015}, {0, x + 0.015}};
        add_turned(works[Paint::Steel], from, kAlong, disc, 24);
    }
    for (const double x : {0.2, 0.9})
        add_box(works[Paint::Concrete], from + dvec3(x * length - 0.15, -0.5 - r, -0.8 * r),
                from + dvec3(x * length + 0.15, -0.6 * r, 0.8 * r));
    for (const double x : {0.1, 0.25}) {
        const dvec3 line[] = {from + dvec3(x * length, 0.9 * r, 0),
                              from + dvec3(x * length, r + 0.9, 0),
                              from + dvec3(x * length, r + 0.9, 1.8),
                              {from.x + x * length, foot.y + kStorey - 0.6, from.z + 1.8}};
        add_pipe(works, Paint::Water, line, 0.1, true);
    }
}

/// A motor with fins, a coupling, a spiral housing.
void add_pump(Works& works, dvec3 foot, Random& random) {
    const double s = random.uniform(0.8, 1.15);
    const dvec3 axle = foot + dvec3(0, 0.62 * s, 0);
    add_box(works[Paint::Concrete], foot - dvec3(1.2, 0, 0.5) * s,
            foot + dvec3(1.2, 0.25 / s, 0.5) * s);
    std::vector<dvec2> motor = {{0, -1.1 * s}, {0.25 * s, -1.1 * s}, {0.31 * s, -1.0 * s}};
    for (int fin = 0; fin < 16; ++fin) {
        const double x = s * (-0.98 + 0.052 * fin);
        for (const dvec2& p : {dvec2(0.27 * s, x), dvec2(0.33 * s, x + 0.004),
                               dvec2(0.33 * s, x + 0.016), dvec2(0.27 * s, x + 0.02)})
            motor.push_back(p);
    }
    for (const dvec2& p :
         {dvec2(0.31 * s, -0.12 * s), dvec2(0.06 * s, -0.08 * s), dvec2(0.06 * s, 0.25 * s),
          dvec2(0.2 * s, 0.28 * s), dvec2(0.2 * s, 0.4 * s), dvec2(0.06 * s, 0.42 * s),
          dvec2(0.06 * s, 0.6 * s), dvec2(0.0, 0.6 * s)})
        motor.push_back(p);
    add_turned(works[Paint::Machine], axle, kAlong, motor, 28);
    std::vector<dvec3> spiral;
    for (int i = 0; i <= 24; ++i) {
        const dvec2 c = circle(i / 24.0 - 0.25);
        spiral.push_back(axle +
                         s * dvec3(0.75, (0.22 + 0.004 * i) * c.y, (0.22 + 0.004 * i) * c.x));
    }
    add_sweep(works[Paint::Machine], spiral, 0.17 * s, 18);
    const dvec3 out[] = {axle + s * dvec3(0.75, 0.2, 0.2),
                         axle + s * dvec3(0.75, 1.6, 0.2),
                         axle + s * dvec3(0.75, 1.6, -1.2),
                         {axle.x + 0.75 * s, foot.y + kStorey - 0.6, axle.z - 1.2 * s}};
    add_pipe(works, Paint::Water, out, 0.11 * s, true);
    const dvec3 in[] = {axle + s * dvec3(0.8, 0, 0),
                        axle + s * dvec3(1.7, 0, 0),
                        {axle.x + 1.7 * s, foot.y, axle.z}};
    add_pipe(works, Paint::Water, in, 0.11 * s, false);
}

/// A row of valved branches between two headers.
void add_manifold(Works& works, dvec3 foot, Random& random) {
    const Paint paint = random.chance(0.5) ? Paint::Gas : Paint::Oil;
    constexpr int kBranches = 7;
    for (const double y : {0.55, 2.7}) {
        const dvec3 header[] = {foot + dvec3(-2, y, 0), foot + dvec3(2, y, 0)};
        add_pipe(works, paint, header, 0.14, false);
    }
    for (int i = 0; i < kBranches; ++i) {
        const dvec3 at = foot + dvec3(-1.7 + 3.4 * i / (kBranches - 1), 0, 0);
        add_rod(works[paint], at + dvec3(0, 0.55, 0), at + dvec3(0, 2.7, 0), 0.06, 16);
        add_valve(works, paint, at + dvec3(0, 1.35 + 0.35 * (i % 2), 0), kUp, kAcross, 0.06);
        const dvec2 gauge[] = {{0, 0.0}, {0.09, 0.0}, {0.09, 0.05}, {0, 0.05}};
        add_turned(works[Paint::Window], at + dvec3(0, 2.3, 0.1), kAcross, gauge, 18);
    }
}

/// A wall of bent tubes between headers, the inside of a boiler.
void add_tube_wall(Works& works, dvec3 foot, Random& random) {
    const double sway = random.uniform(0.4, 0.8);
    for (int layer = 0; layer < 2; ++layer)
        for (int tube = 0; tube < 24; ++tube) {
            const dvec3 at = foot + dvec3(-2.07 + 0.18 * tube, 0.25, 0.5 * layer - 0.2);
            const dvec3 line[] = {at,
                                  at + dvec3(0, 0.7, 0),
                                  at + dvec3(0, 0.7, sway),
                                  at + dvec3(0, 2.4, sway),
                                  at + dvec3(0, 2.4, 0),
                                  at + dvec3(0, 3.6, 0)};
            add_sweep(works[Paint::Brass], bent_line(line, 0.16), 0.055, 8);
        }
    for (int layer = 0; layer < 2; ++layer)
        for (const double y : {0.25, 3.85}) {
            const dvec3 at = foot + dvec3(0, y, 0.5 * layer - 0.2);
            add_rod(works[Paint::Lagging], at - dvec3(2.4, 0, 0), at + dvec3(2.4, 0, 0), 0.17, 24);
            add_flange(works, Paint::Lagging, at + dvec3(2.35, 0, 0), kAlong, 0.17);
        }
}

void add_cabinets(Works& works, dvec3 foot, Random& random) {
    for (int i = 0; i < 6; ++i) {
        const dvec3 lo = foot + dvec3(-2.2 + 0.75 * i, 0, -0.3), hi = lo + dvec3(0.72, 2.05, 0.6);
        add_box(works[Paint::Machine], lo, hi);
        add_box(works[Paint::Sheet], {lo.x + 0.04, lo.y + 0.1, hi.z},
                {hi.x - 0.04, hi.y - 0.05, hi.z + 0.02});
        for (int slot = 0; slot < 14; ++slot)
            add_box(works[Paint::Cable], {lo.x + 0.12, lo.y + 0.2 + 0.035 * slot, hi.z + 0.02},
                    {hi.x - 0.12, lo.y + 0.215 + 0.035 * slot, hi.z + 0.028});
        const dvec2 knob[] = {{0.022, 0}, {0.022, 0.02}, {0.014, 0.035}, {0, 0.035}};
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 5; ++column)
                add_turned(works[random.chance(0.3) ? Paint::Fire : Paint::Brass],
                           {lo.x + 0.14 + 0.1 * column, lo.y + 1.2 + 0.14 * row, hi.z + 0.02},
                           kAcross, knob, 10);
        add_rod(works[Paint::Steel], {hi.x - 0.09, lo.y + 0.95, hi.z + 0.05},
                {hi.x - 0.09, lo.y + 1.12, hi.z + 0.05}, 0.012, 8);
        for (int cable = 0; cable < 4; ++cable) {
            const dvec3 up[] = {{lo.x + 0.15 + 0.12 * cable, hi.y - 0.05, lo.z + 0.2},
                                {lo.x + 0.15 + 0.12 * cable, hi.y + 0.9, lo.z + 0.2},
                                {lo.x + 0.15 + 0.12 * cable, hi.y + 0.9, lo.z - 0.6}};
            add_sweep(works[Paint::Cable], bent_line(up, 0.25), 0.022, 8);
        }
    }
}

void add_drums(Works& works, dvec3 foot, Random& random) {
    const dvec2 drum[] = {{0, 0},       {0.28, 0},    {0.29, 0.02}, {0.29, 0.28}, {0.305, 0.3},
                          {0.29, 0.32}, {0.29, 0.58}, {0.305, 0.6}, {0.29, 0.62}, {0.29, 0.86},
                          {0.3, 0.88},  {0.28, 0.88}, {0.27, 0.85}, {0, 0.85}};
    for (int i = 0; i < 14; ++i) {
        const dvec3 at = foot + dvec3(-2.0 + 0.66 * (i % 7) + random.uniform(-0.04, 0.04), 0.12,
                                      -0.4 + 0.7 * (i / 7));
        add_turned(works[random.chance(0.5) ? Paint::Oil : Paint::Water], at, kUp, drum, 28);
        for (int slat = 0; slat < 5; ++slat)
            add_box(works[Paint::Brass], at + dvec3(-0.33, -0.12, -0.32 + 0.15 * slat),
                    at + dvec3(0.33, -0.01, -0.22 + 0.15 * slat));
    }
}

void add_duct(Works& works, dvec3 foot, Random& random) {
    const double y = foot.y + random.uniform(1.6, 2.2), half = random.uniform(0.5, 0.8);
    add_box(works[Paint::Lagging], {foot.x - 2.9, y - half, foot.z - half},
            {foot.x + 2.9, y + half, foot.z + half});
    for (int rib = 0; rib <= 12; ++rib) {
        const double x = foot.x - 2.85 + 0.475 * rib;
        add_box(works[Paint::Steel], {x - 0.02, y - half - 0.06, foot.z - half - 0.06},
                {x + 0.02, y + half + 0.06, foot.z + half + 0.06});
    }
    for (const double x : {-2.0, 2.0})
        add_box(works[Paint::Steel], {foot.x + x - 0.1, foot.y, foot.z - 0.1},
                {foot.x + x + 0.1, y - half, foot.z + 0.1});
    add_pump(works, {foot.x, foot.y, foot.z - 1.7}, random);
}

} // namespace

void add_machines(Works& works, const Bay& bay, Random& random) {
    const dvec3 back = bay.middle() - dvec3(0, 0, 1.5), front = bay.middle() + dvec3(0, 0, 1.0);
    switch (random.below(8)) {
    case 0:
        return add_tank(works, bay.middle(), random);
    case 1:
        add_exchanger(works, back, random);
        return add_exchanger(works, front, random);
    case 2:
        add_pump(works, back, random);
        return add_pump(works, front, random);
    case 3:
        add_manifold(works, back, random);
        return add_drums(works, front, random);
    case 4:
        return add_tube_wall(works, back, random);
    case 5:
        add_cabinets(works, back, random);
        return add_manifold(works, front, random);
    case 6:
        add_duct(works, front, random);
        return add_cabinets(works, back, random);
    default:
        add_tank(works, back - dvec3(0.8, 0, 0), random);
        return add_manifold(works, front, random);
    }
}

} // namespace ovc::powerplant
