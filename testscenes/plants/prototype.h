// SPDX-License-Identifier: Apache-2.0
// A prototype is one plant (or rock) of a species, rooted at (0, 0, 0) and growing along +y. It is
// placed many times.
#pragma once

#include "testscenes/corners.h"
#include "testscenes/random.h"

#include <array>
#include <cstdint>

namespace ovc::plants {

/// The parts of a plant that differ in colour. Only the tinted part varies among plants of a
/// species.
enum class Part : uint8_t { Tinted, Wood, Accent };
inline constexpr size_t kParts = 3;

struct Prototype {
    std::array<Corners, kParts> parts;

    Corners& operator[](Part part) { return parts[size_t(part)]; }
    const Corners& operator[](Part part) const { return parts[size_t(part)]; }
};

/// Makes a prototype. With `detail` 1 it is for the nearest plants. Less detail makes it coarser at
/// the same size.
using Maker = Prototype (*)(Random random, double detail);

// tree.cpp
Prototype make_oak(Random random, double detail);
Prototype make_birch(Random random, double detail);
Prototype make_willow(Random random, double detail);
Prototype make_bush(Random random, double detail);
// conifer.cpp
Prototype make_spruce(Random random, double detail);
// herb.cpp
Prototype make_grass(Random random, double detail);
Prototype make_reed(Random random, double detail);
Prototype make_flower(Random random, double detail);
Prototype make_daisy(Random random, double detail);
Prototype make_lily(Random random, double detail);
// rock.cpp
Prototype make_rock(Random random, double detail);

/// Adds a leaf of two triangles, folded along its middle. It goes from `base` along `along`, which
/// is as long as the leaf. `normal` points up from its upper side.
void add_leaf(Corners& out, dvec3 base, dvec3 along, dvec3 normal, double width);

/// Returns how many of `count` at full detail remain, at least `min_count`.
uint32_t scaled(double count, double detail, uint32_t min_count);

} // namespace ovc::plants
