// SPDX-License-Identifier: Apache-2.0
// Measures all kernel variants on a device with the rays of test scenes, and keeps the fastest.
#pragma once

#include "core/result.h"

#include <functional>
#include <string>

namespace ovc {

/// Has the plugin measure nearest hits of coherent and of scattered rays, and occlusion, in a scene
/// of one frame, one of few and one of many; it keeps what it finds for the device. tell: receives
/// a line for each scene, and the plugin's sentences for each variant and each choice. It takes a
/// minute on a software renderer. Error: a device that cannot be opened, or the plugin's.
Result<Done> tune_device(const std::string& device,
                         const std::function<void(const std::string&)>& tell);

} // namespace ovc
