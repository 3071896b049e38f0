// SPDX-License-Identifier: Apache-2.0
// assemble() turns a world of shapes and instances into the soup.
#pragma once

#include "importers/pbrt/census.h"
#include "importers/pbrt/mesh_output.h"
#include "importers/pbrt/streamed_shapes.h"

namespace ovc::pbrt {

/// Adds the world's triangles to the output: first those of its own shapes, then instance by
/// instance. Neighbouring shapes of one material become one mesh while they are small. The peak
/// memory is that of the soup and the shapes; the world's own shapes are freed as they are taken.
///
/// An object that is placed more than once and is no small tile keeps its corners once, and its
/// instances are placed (census.h).
///
/// The corners of everything else are moved into the world. One origin serves the world's own
/// shapes and instances near it, so that shapes which share corners keep sharing them. An instance
/// that lies farther from it than kFar times its own extent has an origin of its own, and its
/// corners are rounded to a lattice that is finer than single precision would be there. Instances
/// of like size have the same lattice, so that those which touch still do.
///
/// `census` is that of `world`. `streamed` holds the world's own shapes where the output streams,
/// which objects that share their corners cannot; else it is null.
void assemble(World world, const Census& census, MeshOutput& output, StreamedShapes* streamed);

/// The distance, in extents, from which an instance has an origin of its own.
inline constexpr double kFar = 16;

} // namespace ovc::pbrt
