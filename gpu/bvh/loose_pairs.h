// SPDX-License-Identifier: Apache-2.0
// Loose pairs: two triangles that share no side, in one unit. Six corners do not fit there as
// floats; counted in steps of 2^-23, which is as near as the kernel's error bound asks for, they do
// (shaders/layout.h, docs/design/numerics.md).
#pragma once

#include "gpu/bvh/bvh.h"
#include "gpu/bvh/pairs.h"
#include "shaders/layout.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Where most triangles found no partner across a side; else loose pairs save less than they cost
/// the kernel.
bool worth_loosening(size_t pairs, size_t triangles);

/// Two pairs of one triangle each, by their numbers.
using LoosePair = std::array<uint32_t, 2>;

/// Makes one leaf of two that hold a triangle each and have the same parent, or one the other's
/// grandparent, where the box of both costs little more than two boxes do: its item is
/// pairs.size() + i for the loose pair i. nodes: of the BVH over `pairs`. Triangles that reach
/// beyond the frame's [-1, 1] stay alone, and so do pairs.
std::vector<LoosePair> join_loose(std::vector<BvhNode>& nodes, std::span<const TrianglePair> pairs);

/// A corner in steps of OVC_LOOSE_STEP. In a page with loose pairs all corners are: triangles that
/// share one see it in the same place, whatever unit they lie in.
vec3 in_steps(const vec3& corner);

/// Writes the unit of two triangles, each alone in its pair.
void put_loose(const TrianglePair& first, const TrianglePair& second,
               std::span<uvec4, OVC_UNIT_TEXELS> unit);

} // namespace ovc
