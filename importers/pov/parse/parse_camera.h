// SPDX-License-Identifier: Apache-2.0
// Reads camera { }. As in POV-Ray, whatever the order of its parts, look_at turns the vectors
// first, then the angle sets the direction's length, then transformations move them all.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

struct CameraValue {
    dvec3 location{0};
    dvec3 direction{0, 0, 1};
    dvec3 up{0, 1, 0};
    dvec3 right{1.33, 0, 0}; // povray's default, though its pictures are 4 : 3
    dvec3 sky{0, 1, 0};
    std::optional<double> distance; // from the location to look_at, or to <0, 0, 1> without it
    bool window_given = false;      // whether the scene gives right or up
    bool orthographic = false;
    ImageWindow::Bend bend = ImageWindow::Bend::Flat;
    double vertical_angle = 0;
    double angle = 0; // of the field of view, in degrees; 0 where the scene gives none
};

/// Reads a camera from its { on.
std::shared_ptr<const CameraValue> parse_camera(Reader& reader);

/// Returns the camera as hosts get it: as POV-Ray's window, and as eye, target and field of view.
Camera camera_of(const CameraValue& camera);

} // namespace ovc::pov
