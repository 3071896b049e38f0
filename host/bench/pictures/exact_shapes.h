// SPDX-License-Identifier: Apache-2.0
// Exact shapes: spheres, cones and tori as formulas in double precision, and the same in POV-Ray's
// words, to tell how far triangles are from what they stand for.
#pragma once

#include "core/ray.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

struct ExactShape {
    std::string name;
    std::string words; // "sphere { <1,2,3>, 4"; looks and } follow
    double radius;     // of its widest circle
    /// From the point to the surface; below 0 inside.
    std::function<double(const dvec3&)> distance;
};

ExactShape exact_sphere(const dvec3& center, double radius);
/// Standing upright, with flat ends; the upper may be a point.
ExactShape exact_cone(const dvec3& base, double base_radius, double height, double top_radius);
/// Lying flat.
ExactShape exact_torus(const dvec3& center, double major, double minor);

/// A sphere, a cone and a torus side by side, and a light by which each throws its shadow on the
/// next.
std::vector<ExactShape> example_shapes();
/// The whole scene, for POV-Ray and for our reader of its scenes. Corners have the coordinates of
/// the shapes.
std::string povray_scene(std::span<const ExactShape> shapes);

/// t where the ray, from the outside, first meets one of them: to 1e-12 of the distance to the
/// surface. Infinity where none is met within `far` lengths of its direction.
double first_hit(std::span<const ExactShape> shapes, const Ray& ray, double far);
/// Of each of the rays.
std::vector<double> first_hits(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                               double far);

} // namespace ovc
