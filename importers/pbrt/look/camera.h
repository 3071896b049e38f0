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
    vec3 exposure{1};                // the factor on all light
};

/// Fails on a size, or a part of the picture, that is none. v4 has a size where the file says none.
Film read_film(const Parameters& parameters, bool is_v4, Diagnostics& diagnostics);

/// The arguments of the Camera directive, kept until the film is known.
struct CameraRequest {
    std::string type;
    Parameters parameters;
    dmat4 world_to_camera;
    Place place;
};

/// Returns how long the shutter is open, which in v4 multiplies the light on the film.
double time_of_exposure(const CameraRequest& request, Diagnostics& diagnostics);

/// Fails on an angle of view that makes no picture; returns false then.
bool check_camera(const CameraRequest& request, Diagnostics& diagnostics);

/// Returns the camera; warns and returns nothing if the file's transform makes no view.
std::optional<Camera> make_camera(const CameraRequest& request, const Film& film,
                                  Diagnostics& diagnostics);

} // namespace ovc::pbrt
