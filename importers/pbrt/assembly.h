// SPDX-License-Identifier: Apache-2.0
// Assembly: a world of shapes and instances becomes the soup.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/census.h"

namespace ovc::pbrt {

/// Adds the world's triangles to `scene`: first those of its own shapes, then instance by instance.
/// Neighbouring shapes of one material become one mesh while they are small. Peak memory: what the
/// soup takes, and the shapes; the world's own shapes are freed as they are taken.
///
/// An object that is placed more than once and is no small tile keeps its corners once, and its
/// instances are placed (census.h).
///
/// Corners of the rest: one origin serves the world's own shapes and objects that are placed once,
/// so that what shares corners keeps sharing them; but one that lies farther from it than kFar
/// times its own extent has an origin of its own, and its corners are rounded to a lattice that is
/// finer than single precision would be there and the same for all of like size, so that those
/// which touch still do.
void assemble(World world, const Census& census, Scene& scene);

/// See above.
inline constexpr double kFar = 16;

} // namespace ovc::pbrt
