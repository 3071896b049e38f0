// SPDX-License-Identifier: Apache-2.0
// A ray taken into a leaf's frame: in double up to where it enters the leaf's box, then rounded to
// float.
#pragma once

#include "core/triangle.h"
#include "gpu/tracer.h"
#include "kdtree/partition.h"

namespace ovc {

/// The record of no ray: the kernel passes over it.
LocalRay no_ray();

/// The ray in the leaf's frame, from where it enters the leaf's box to where it leaves it or ends;
/// no_ray() where it does not enter. decidable = false, and no_ray(), where double precision cannot
/// say where it enters to within 1/64 of a float rounding (docs/numerics.md): then the arbiter
/// must answer.
LocalRay rebase(const Leaf& leaf, const PreparedRay& p, bool& decidable);

/// The host's t of what the kernel found at t_local on the ray that rebase() made of p.
double world_t(const Leaf& leaf, const PreparedRay& p, float t_local);

} // namespace ovc
