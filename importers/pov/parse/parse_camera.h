// SPDX-License-Identifier: Apache-2.0
// Reads camera { }. As in POV-Ray, whatever the order of its parts, look_at turns the vectors
// first, then the angle sets the direction's length, then transformations move them all.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a camera from its { on.
CameraValue parse_camera(Reader& reader);

/// Reads the block of a mesh_camera into the camera (mesh_camera.cpp).
void parse_mesh_camera(Reader& reader, CameraValue& camera);

/// Returns the camera as hosts get it: as POV-Ray's window, and as eye, target and field of view.
Camera camera_of(const CameraValue& camera);

} // namespace ovc::pov
