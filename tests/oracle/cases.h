// SPDX-License-Identifier: Apache-2.0
// Meshes and rays that are hard to get right, for the oracle's test.
#pragma once

#include "tests/oracle/exact_oracle.h"

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace ovc::oracle {

class Random {
public:
    explicit Random(uint64_t seed) : engine_(seed) {}

    uint64_t below(uint64_t n) { return engine_() % n; }
    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (double(engine_() >> 11) * 0x1p-53);
    }
    Corner point(double size = 1) {
        return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)};
    }
    /// Returns a point whose coordinates have few bits, so that exact coincidences happen.
    Corner lattice() {
        return {double(int(below(17)) - 8) / 4, double(int(below(17)) - 8) / 4,
                double(int(below(17)) - 8) / 4};
    }

private:
    std::mt19937_64 engine_;
};

/// A mesh with three corners for each triangle, and the transforms of its instances.
struct Mesh {
    std::vector<Corner> corners;
    /// The ABI gets floats, which hold the corners exactly.
    bool in_floats = false;
    std::vector<std::array<double, 12>> instances; // further instances beside the mesh itself
};

struct Case {
    const char* name;
    std::vector<Mesh> (*meshes)(Random&);
    /// Returns a ray at the triangles, which are where their instances are.
    ovc_ray (*ray)(Random&, std::span<const Triangle>);
};

std::span<const Case> cases();

} // namespace ovc::oracle
