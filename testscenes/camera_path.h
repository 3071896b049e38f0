// SPDX-License-Identifier: Apache-2.0
// CameraPath has a camera for each frame.
#pragma once

#include "core/scene.h"

#include <vector>

namespace ovc {

using CameraPath = std::vector<Camera>;

} // namespace ovc
