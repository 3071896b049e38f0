// SPDX-License-Identifier: Apache-2.0
// BouncedLight keeps the diffuse light that arrives at some points of the surfaces, and guesses
// from these what arrives between them.
// Based on: Ward, Rubinstein and Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection".
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

class BouncedLight {
public:
    struct Record {
        dvec3 at;
        dvec3 normal;  // unit length, on the side that the light arrives at
        vec3 light{0}; // the mean of the light that arrives, weighted by the cosine to the normal
    };

    explicit BouncedLight(std::vector<Record> records);

    /// Returns the light that arrives around `normal`, of unit length: the mean of that at near
    /// records that face about the same way, or of all records where none does. 0 without records.
    vec3 at(const dvec3& place, const dvec3& normal) const;

private:
    void build(size_t first, size_t last);

    std::vector<Record> records_; // a balanced tree: the middle of a range divides it
    std::vector<uint8_t> axes_;   // by which a record divides its range
    vec3 mean_{0};
};

} // namespace ovc
