// SPDX-License-Identifier: Apache-2.0
// Reads shapes: each function reads one kind, from behind the { up to the modifiers, and returns it
// ready to be cut into triangles.
#pragma once

#include "importers/pov/object.h"
#include "importers/pov/values/expression.h"

namespace ovc::pov {

// shape_round.cpp
Shape parse_sphere(Reader& reader);
Shape parse_cylinder(Reader& reader);
Shape parse_cone(Reader& reader);
Shape parse_torus(Reader& reader);
Shape parse_disc(Reader& reader);
Shape parse_superellipsoid(Reader& reader);

// shape_flat.cpp
Shape parse_box(Reader& reader);
Shape parse_triangle(Reader& reader);
Shape parse_smooth_triangle(Reader& reader);
Shape parse_polygon(Reader& reader);

// shape_sweep.cpp
Shape parse_prism(Reader& reader);
Shape parse_lathe(Reader& reader);
Shape parse_sor(Reader& reader);
Shape parse_ovus(Reader& reader);

// shape_height_field.cpp
Shape parse_height_field(Reader& reader);

// shape_text.cpp
Shape parse_text_shape(Reader& reader);

// shape_julia.cpp
Shape parse_julia_fractal(Reader& reader);

// shape_sphere_sweep.cpp
Shape parse_sphere_sweep(Reader& reader);

// shape_parametric.cpp
Shape parse_parametric(Reader& reader);

/// A box, or a ball, which has a formula (Shape::exact), that bounds a surface; and a box around
/// it.
struct Container {
    Shape shape;
    Box box;
};

/// Reads one from behind contained_by (shape_implicit.cpp).
Container parse_container(Reader& reader);

// shape_patch.cpp
Shape parse_bicubic_patch(Reader& reader);

/// Returns the step of this kind that wraps a plane around the axis of y.
inline TextureStep wrapped_around_y(TextureStep::Kind kind, double major_radius = 0) {
    return {kind, {dvec4(2, 0, major_radius, 0), dvec4(0), dvec4(0)}};
}

/// Reads how many points a shape has, from `min` to 10 million, which bounds the memory it takes.
int parse_count(Reader& reader, int min);

} // namespace ovc::pov
