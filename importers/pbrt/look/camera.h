// SPDX-License-Identifier: Apache-2.0
// Camera and film: the view that a PBRT file describes.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/interpret/parameters.h"
#include "importers/pbrt/interpret/transform.h"

namespace ovc::pbrt {

/// What Film says.
struct Film {
    ImageSize size{640, 480};
    bool has_size = false; // the file gave one
    float exposure = 1;    // what light is multiplied by
};

Film read_film(const Parameters& parameters);

/// What Camera says, to be made a camera once the film is known.
struct CameraRequest {
    std::string type;
    Parameters parameters;
    dmat4 world_to_camera;
    Place place;
};

/// Nothing where the file's transform makes no view, which has been said then.
std::optional<Camera> make_camera(const CameraRequest& request, const Film& film,
                                  Diagnostics& diagnostics);

} // namespace ovc::pbrt
