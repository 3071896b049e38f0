// SPDX-License-Identifier: Apache-2.0
// AOVs tell about the hits of the camera's rays, as further channels of an OpenEXR file.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/camera/camera_rays.h"
#include "host/output/output.h"
#include "host/render/sight.h"

#include <string_view>
#include <vector>

namespace ovc {

/// The AOVs that the user wants, each with its channels and its value for a ray that hits nothing.
struct Aovs {
    bool depth = false;   // depth.Z: t of the pixel's ray, which is the distance along the view;
                          // a miss has infinity
    bool normal = false;  // normal.X, .Y, .Z: unit length, in the world, towards the eye; a miss: 0
    bool albedo = false;  // albedo.R, .G, .B: Bsdf::albedo(); a miss: 1
    bool id = false;      // id.mesh, id.prim: whole numbers; a miss has 0xffffffff
    bool leaf = false;    // leaf: the level-1 leaf of the hit; a miss has 0xffffffff
    bool passes = false;  // passes: the number of passes that the ray took part in
    bool flagged = false; // flagged: 1 where the kernel was not certain of the answer, else 0

    bool any() const { return depth || normal || albedo || id || leaf || passes || flagged; }
};

/// Parses "depth,normal,albedo,id,leaf,passes,flagged" or some of these. Error: an unknown name, or
/// one given twice.
Result<Aovs> parse_aovs(std::string_view text);

/// Returns the layers, each with a word for each pixel. It traces one ray through the middle of
/// each pixel, apart from those of the picture.
///
/// samples: of the picture. Where a pixel has several, normal and albedo are means over some of
/// them, as a denoiser wants them: their edges are as smooth as those of the picture, and a mean of
/// normals is shorter than 1 there. sampling: of the picture's camera rays. Error: leaf, passes or
/// flagged of a backend that has none.
Result<std::vector<Layer>> trace_aovs(const Scene& scene, const Pinhole& camera, const Sight& sight,
                                      Backend& backend, const Aovs& aovs, uint32_t samples = 1,
                                      const CameraSampling& sampling = {});

} // namespace ovc
