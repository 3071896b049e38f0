// SPDX-License-Identifier: Apache-2.0
// Far triangles: a few that reach through much of the scene, which the kernel tests in doubles
// (shaders/far.glsl).
#pragma once

#include "core/box.h"
#include "core/numbering.h"
#include "core/soup.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc {

/// A soup and the numbers of its triangles.
struct NumberedSoup {
    const Soup& soup;
    const Numbering& numbers;
};

/// Some of the far triangles of a scene.
struct FarRange {
    uint32_t first = 0;
    uint32_t count = 0;
};

/// A triangle in the frame of its leaf. Bounds hold for its exact corners; error bound:
/// docs/design/numerics.md, "Far triangles".
struct FarTriangle {
    /// The weight of a corner at a point p of the plane is dot(to_weight, p) - shift.
    struct Corner {
        dvec3 to_weight{0};
        double shift = 0;

        double weight_at(const dvec3& p) const { return glm::dot(to_weight, p) - shift; }
    };

    dvec3 normal{0};
    double lo = 0; // of the products of the corners with the normal
    double hi = 0;
    std::array<Corner, 3> corners;
    double error = 0; // of a weight
    uint32_t number = 0;

    /// Returns the numbers as the kernel reads them (shaders/layout.h).
    std::array<double, 18> numbers() const;
};
inline constexpr uint64_t kFarTriangleBytes = OVC_FAR_TRIANGLE_TEXELS * sizeof(uvec4);

/// Returns the triangles of a leaf as far triangles; none where they are many, the leaf is small in
/// the scene, or a triangle is too thin for the bounds. scene: the bounds of the whole scene.
std::vector<FarTriangle> far_triangles_of(const NumberedSoup& numbered, const Leaf& leaf,
                                          const Box& scene);

} // namespace ovc
