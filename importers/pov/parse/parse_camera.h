// SPDX-License-Identifier: Apache-2.0
// camera { }: its vectors as POV-Ray makes them: whatever the order they are named in, look_at
// turns them, then the angle sets the direction's length, then transformations move all.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

struct CameraValue {
    dvec3 location{0};
    dvec3 direction{0, 0, 1};
    dvec3 up{0, 1, 0};
    dvec3 right{1.33, 0, 0}; // povray's, though its pictures are 4 : 3
    dvec3 sky{0, 1, 0};
    std::optional<double> distance; // to what it looks at; without look_at that is <0, 0, 1>
    bool window_given = false;      // right or up
    bool orthographic = false;
    ImageWindow::Bend bend = ImageWindow::Bend::Flat;
    double vertical_angle = 0;
    double angle = 0; // of the field of view, degrees; 0: not said
};

/// From the { on.
std::shared_ptr<const CameraValue> parse_camera(Reader& reader);

Camera camera_of(const CameraValue& camera);

} // namespace ovc::pov
