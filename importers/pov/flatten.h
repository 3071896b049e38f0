// SPDX-License-Identifier: Apache-2.0
// Turns a scene's objects into triangles, materials and lights.
#pragma once

#include "importers/importer.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// The settings of a scene and of the import that its triangles and materials depend on.
struct Look {
    vec3 ambient_light{1};
    vec3 irid_wavelengths{Finish{}.irid_wavelengths};
    NoiseKind irid_noise = Finish{}.irid_noise;
    bool before_3_7 = false; // the scene's version is below 3.7
    bool has_media = false;  // or fog or rainbows, for which it counts which objects are hollow
    uint64_t max_triangles = kDefaultMaxTriangles;
    std::optional<double> tolerance;       // as in ImportOptions
    std::function<void(const Note&)> tell; // gets the notes of all objects drawn; may be empty
    std::optional<dvec3> eye;              // planes reach as far as the camera can see them
};

/// An object that the scene draws, and the texture that its parts without one have: what #default
/// says at the object's end, wherever its parts were declared.
struct DrawnObject {
    ObjectPtr object;
    TexturePtr defaults;
};

/// Adds the objects to `scene`: a mesh for each material, one for each plane, and their lights.
/// Throws ParseError for an object that cannot be cut and for too many objects or triangles.
void flatten(const std::vector<DrawnObject>& objects, const Look& look, Scene& scene);

/// Without a tolerance a circle has this many straight pieces, but fewer, down to 8, where the
/// scene's round shapes would have more than kMaxRoundTriangles triangles.
inline constexpr int kMaxSegments = 96;
inline constexpr double kMaxRoundTriangles = 3e6;
/// But a scene whose round shapes are few has this many, so that edges lie where they should; fewer
/// where polygons are as large as the circles and there are no other curves.
inline constexpr int kFineSegments = 192;
inline constexpr int kFineSegmentsOfCircles = 120;
inline constexpr double kMaxFineTriangles = 150'000;

/// A plane reaches this many times as far as the scene, or as its distance from the scene if that
/// is larger. The horizon is too low by the camera's height over that reach, in radians.
inline constexpr double kPlaneReach = 1e4;

} // namespace ovc::pov
