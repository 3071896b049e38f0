// SPDX-License-Identifier: Apache-2.0
// Joins several files to one scene.
#pragma once

#include "core/scene.h"
#include "core/system/log.h"

#include <string>
#include <vector>

namespace ovc {

struct NamedScene {
    std::string name; // in messages
    Scene scene;
};

/// Returns a scene with all meshes, one scene's after the other's, and all lights. Camera, size,
/// depth, background and gamma are those of the first scene that states one; the log gets a warning
/// for each other. Of several scenes it drops what was built of one alone (Scene::saved). scenes:
/// at least one.
Scene join(std::vector<NamedScene> scenes, const LogSink& log);

} // namespace ovc
