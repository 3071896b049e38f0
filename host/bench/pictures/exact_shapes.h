// SPDX-License-Identifier: Apache-2.0
// Exact shapes: spheres, cones and tori as formulas in double precision, and the same in POV-Ray's
// language. They tell how far triangles are from the shapes that they approximate.
#pragma once

#include "core/ray.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

struct ExactShape {
    std::string name;
    std::string words; // "sphere { <1,2,3>, 4"; the material and } follow
    double radius;     // of its widest circle
    /// Returns the distance from the point to the surface; below 0 inside.
    std::function<double(const dvec3&)> distance;
};

ExactShape exact_sphere(const dvec3& center, double radius);
/// Returns an upright cone with flat ends. height and base_radius are above 0 (asserted);
/// top_radius 0 makes the upper end a point.
ExactShape exact_cone(const dvec3& base, double base_radius, double height, double top_radius);
/// Returns a torus that lies flat.
ExactShape exact_torus(const dvec3& center, double major, double minor);

/// Returns a sphere, a cone and a torus side by side.
std::vector<ExactShape> example_shapes();
/// Returns the whole scene, for POV-Ray and for our reader of its scenes, with a light by which
/// each of example_shapes() throws its shadow on the next. Our reader keeps the coordinates.
std::string povray_scene(std::span<const ExactShape> shapes);

/// Returns t of the first point on the ray within 1e-12 of a surface, or infinity where there is
/// none up to t = far. The ray starts outside the shapes.
double first_hit(std::span<const ExactShape> shapes, const Ray& ray, double far);
/// Returns first_hit() of each ray.
std::vector<double> first_hits(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                               double far);

} // namespace ovc
