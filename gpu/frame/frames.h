// SPDX-License-Identifier: Apache-2.0
// Decides which triangles a frame suits. The kernel computes in float32, and the smaller triangles
// are in the frame, the more rays it leaves in doubt.
#pragma once

#include "core/soup.h"
#include "kdtree/partition.h"

#include <span>

namespace ovc {

/// Returns roughly the share of rays that float32 would leave in doubt in the frame, of those that
/// hit the triangles. It is the share of the area, in small neighbourhoods all over the scene, that
/// lies within the error bound of the triangles' sides (docs/design/numerics.md). Looks at a
/// sample.
double doubtful_share(const Soup& soup, std::span<const TriangleId> triangles, const Frame& frame);

/// Up to this doubtful share one frame suits all leaves of a scene.
inline constexpr double kMaxDoubtful = 1.0 / 8;

/// Up to this share it suits leaves that could have several frames. A ray that changes frames takes
/// longer, but so does one in doubt.
inline constexpr double kMaxDoubtfulOfPart = 0.03;

/// Returns whether the frame of a scene in `bounds` suits all its leaves.
bool one_frame_suits(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// Gives leaves that lie together a shared frame where it suits them: those of the largest subtrees
/// of level 1 that one frame suits.
void share_frames(const Soup& soup, Level1& level1);

} // namespace ovc
