// SPDX-License-Identifier: Apache-2.0
// Loose pairs: two triangles that share no side, in one unit. Six corners do not fit there as
// floats, but they do in steps of 2^-23, which is as precise as the kernel's error bound needs
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

/// Whether loose pairs are worth it: if most triangles found no partner across a side. Otherwise
/// they save less than they cost the kernel.
bool worth_loosening(size_t pairs, size_t triangles);

/// Two pairs of one triangle each, by their numbers.
using LoosePair = std::array<uint32_t, 2>;

/// Joins leaves that hold a triangle each, two into one, if the box of both costs little more than
/// two boxes do, and returns the loose pairs. Two such leaves have the same parent, or the parent
/// of one is the grandparent of the other. The item of the joint leaf is pairs.size() + i for the
/// loose pair i. nodes: of the BVH over `pairs`. Triangles that reach beyond the frame's [-1, 1]
/// stay alone, and so do pairs.
std::vector<LoosePair> join_loose(std::vector<BvhNode>& nodes, std::span<const TrianglePair> pairs);

/// Rounds a corner to steps of OVC_LOOSE_STEP. A page with loose pairs rounds all its corners, so
/// that triangles that share one agree on its place, in whatever unit they lie.
vec3 in_steps(const vec3& corner);

/// Writes the unit of two triangles, each alone in its pair.
void put_loose(const TrianglePair& first, const TrianglePair& second,
               std::span<uvec4, OVC_UNIT_TEXELS> unit);

} // namespace ovc
