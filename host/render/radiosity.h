// SPDX-License-Identifier: Apache-2.0
// Gathers the light that goes from surface to surface before a picture is rendered, for scenes
// that ask for it (Scene::radiosity).
#pragma once

#include "core/result.h"
#include "host/backend/backend.h"
#include "host/camera/camera.h"
#include "host/render/sight.h"
#include "host/shade/lights/bounced_light.h"

#include <memory>

namespace ovc {

struct GatherOptions {
    uint32_t max_depth = 16; // reflections and refractions in a row
    bool shadows = true;
};

/// Returns the light at surfaces that the camera sees; null where the scene does not ask for it. It
/// is the same for the same arguments. An Error is the backend's.
Result<std::shared_ptr<const BouncedLight>>
gather_bounced_light(const Scene& scene, const Pinhole& pinhole, const Sight& sight,
                     Backend& backend, const GatherOptions& options);

} // namespace ovc
