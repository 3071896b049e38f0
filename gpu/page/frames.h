// SPDX-License-Identifier: Apache-2.0
// Which triangles a frame suits. The kernel counts in float32, and the smaller triangles are in the
// frame, the more rays it leaves in doubt.
#pragma once

#include "core/soup.h"
#include "kdtree/partition.h"

#include <span>

namespace ovc {

/// What of the rays that hit the triangles float32 would leave in doubt in the frame, roughly: the
/// share of the area, in small neighbourhoods all over the scene, that lies within the error bound
/// of the triangles' sides (docs/design/numerics.md). It looks at a sample.
double doubtful_share(const Soup& soup, std::span<const TriangleId> triangles, const Frame& frame);

/// Up to this share a frame suits all leaves of a scene.
inline constexpr double kMaxDoubtful = 1.0 / 8;

/// Up to this one it suits leaves that could have several: a ray that changes frames takes longer,
/// one in doubt as well.
inline constexpr double kMaxDoubtfulOfPart = 0.03;

/// Whether the frame of a scene in `bounds` suits all its leaves.
bool one_frame_suits(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// Gives leaves that lie together one frame, as many as it suits: subtrees of level 1, the largest
/// that do.
void share_frames(const Soup& soup, Level1& level1);

} // namespace ovc
