// SPDX-License-Identifier: Apache-2.0
// AOVs: what the camera's rays hit, as further channels of an OpenEXR file.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/output/output.h"

#include <string_view>
#include <vector>

namespace ovc {

/// Which of them are wanted.
struct Aovs {
    bool depth = false;   // depth.Z: t of the pixel's ray, which is the distance along the view;
                          // infinity where nothing is hit
    bool normal = false;  // normal.X, .Y, .Z: of unit length in the world, towards the eye; 0
    bool id = false;      // id.mesh, id.prim: whole numbers; 0xffffffff
    bool leaf = false;    // leaf: of level 1, in which the hit lies; 0xffffffff
    bool passes = false;  // passes: that the pixel's ray took part in
    bool flagged = false; // flagged: 1 where the kernel was not certain of the answer; else 0

    bool any() const { return depth || normal || id || leaf || passes || flagged; }
};

/// "depth,normal,id,leaf,passes,flagged". Error: an unknown name, or one twice.
Result<Aovs> parse_aovs(std::string_view text);

/// One ray through the middle of each pixel, apart from those of the picture. Error: leaf or passes
/// of a backend that has none.
Result<std::vector<Layer>> trace_aovs(const Scene& scene, const Pinhole& camera, Backend& backend,
                                      const Aovs& aovs);

} // namespace ovc
