// SPDX-License-Identifier: Apache-2.0
// The plan of the plant: a hall of storeys, each of bays, and the things in them. Units are metres.
// The hall's corner is at (0, 0, 0), x runs along it, and y is up.
#pragma once

#include "testscenes/powerplant/parts.h"
#include "testscenes/random.h"

#include <cstdint>

namespace ovc::powerplant {

inline constexpr double kBay = 6;    // along x and z
inline constexpr double kStorey = 5; // from floor to floor

struct Plan {
    uint32_t bays_x, bays_z, storeys;

    double length() const { return kBay * bays_x; }
    double depth() const { return kBay * bays_z; }
    double height() const { return kStorey * storeys; }
    /// The aisle is the row of bays kept free to walk along. The shaft is the bay that is open
    /// through all storeys.
    uint32_t aisle() const { return bays_z / 2; }
    uint32_t shaft() const { return bays_x / 2; }
    /// The walls that divide a storey into three rooms stand before these columns of bays.
    uint32_t first_wall() const { return bays_x / 3; }
    uint32_t second_wall() const { return bays_x - bays_x / 3; }
};

/// Returns a plan for about so many triangles.
Plan plan_for(uint64_t triangles);

struct Bay {
    uint32_t x, storey, z;

    dvec3 corner() const { return {kBay * x, kStorey * storey, kBay * z}; }
    dvec3 middle() const { return corner() + dvec3(0.5 * kBay, 0, 0.5 * kBay); }
};

// structure.cpp: columns, beams, floor, walls, lamps, stairs
void add_structure(Works& works, const Plan& plan, const Bay& bay);
// services.cpp: pipes and trays under the ceiling, along a whole row of bays, and between storeys
void add_pipe_rack(Works& works, const Plan& plan, uint32_t storey, uint32_t row);
void add_cable_trays(Works& works, const Bay& bay, Random& random);
void add_risers(Works& works, const Bay& bay, Random& random);
// machines.cpp: the machines of a bay
void add_machines(Works& works, const Bay& bay, Random& random);
// yard.cpp: everything outside of the hall
void add_yard(Works& works, const Plan& plan);
/// Adds a heap of coal of exactly so many triangles, which are even and at least kMinHeap.
inline constexpr uint64_t kMinHeap = 2000;
void add_coal_heap(Works& works, const Plan& plan, uint64_t triangles);

} // namespace ovc::powerplant
