// SPDX-License-Identifier: Apache-2.0
// Checks that a device answers rays as double precision does, because a driver's compiler may be
// wrong where every limit that it reports is right (docs/guide/gpu.md).
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

struct CheckedScene {
    std::string name;
    uint64_t rays = 0;
    uint64_t wrong = 0; // answers unlike the reference's
};

/// Traces camera rays, shadow rays, scattered ones, and those that pass triangles' sides, of a
/// picture of 128 x 128 pixels, by both backends. They are over the scene's soup. Error: a
/// backend's.
Result<CheckedScene> check_answers(const Scene& scene, Backend& device, Backend& reference);

/// Does so on a device (BackendOptions::device), against the CPU KD-tree, in test scenes of one
/// frame, of triangles that reach far, and of instances: kernels differ in what they do there. It
/// takes some seconds, most of them to build KD-trees. Error: a scene cannot be built on the
/// device.
Result<std::vector<CheckedScene>> check_device(const std::string& device);

} // namespace ovc
