// SPDX-License-Identifier: Apache-2.0
// The camera and the film are the view that a PBRT file describes.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/interpret/parameters.h"
#include "importers/pbrt/interpret/transform.h"

namespace ovc::pbrt {

/// The arguments of the Film directive.
struct Film {
    ImageSize size{640, 480};
    bool has_size = false;           // whether the file gave it
    std::optional<PicturePart> part; // that is rendered; none: all
    float exposure = 1;              // the factor on all light
};

/// Fails on a size, or a part of the picture, that is none.
Film read_film(const Parameters& parameters, Diagnostics& diagnostics);

/// The arguments of the Camera directive, kept until the film is known.
struct CameraRequest {
    std::string type;
    Parameters parameters;
    dmat4 world_to_camera;
    Place place;
};

/// Fails on an angle of view that makes no picture; returns false then.
bool check_camera(const CameraRequest& request, Diagnostics& diagnostics);

/// Returns the camera; warns and returns nothing if the file's transform makes no view.
std::optional<Camera> make_camera(const CameraRequest& request, const Film& film,
                                  Diagnostics& diagnostics);

} // namespace ovc::pbrt
