// SPDX-License-Identifier: Apache-2.0
// From objects to triangles, materials and lights.
#pragma once

#include "importers/importer.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// What a scene says besides its objects, and what its triangles are made with.
struct Look {
    Texture defaults;
    vec3 ambient_light{1};
    uint64_t max_triangles = kDefaultMostTriangles;
    std::optional<double> tolerance;       // as ImportOptions has it
    std::function<void(const Note&)> tell; // of what is to be seen; none: nobody asks
    std::optional<dvec3> eye;              // planes reach as far as it can see them
};

/// Adds the objects to `scene`: a mesh for each material, one for each plane, and their lights.
/// Throws ParseError for an object that cannot be cut.
void flatten(const std::vector<ObjectPtr>& objects, const Look& look, Scene& scene);

/// Where no tolerance is asked for, a circle has at most this many straight pieces, fewer where a
/// scene would come to more than kMaxRoundTriangles triangles; at least 8.
inline constexpr int kMaxSegments = 96;
inline constexpr double kMaxRoundTriangles = 3e6;

/// A plane reaches this many times as far as the scene and its distance from it: the horizon is low
/// by the camera's height over that, in radians.
inline constexpr double kPlaneReach = 1e4;

} // namespace ovc::pov
