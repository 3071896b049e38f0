// SPDX-License-Identifier: Apache-2.0
// Several files as one scene.
#pragma once

#include "core/scene.h"
#include "core/system/log.h"

#include <string>
#include <vector>

namespace ovc {

struct NamedScene {
    std::string name; // as messages have it
    Scene scene;
};

/// All meshes, one scene's after the other's, and all lights. Camera, size, depth, background and
/// gamma are those of the first scene that states one; of the others' the log gets a warning. What
/// was built of a scene alone is of no use. scenes: at least one.
Scene join(std::vector<NamedScene> scenes, const LogSink& log);

} // namespace ovc
