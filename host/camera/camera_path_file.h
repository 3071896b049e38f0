// SPDX-License-Identifier: Apache-2.0
// Camera paths in files: one camera a frame, as JSON or as lines of numbers
// (docs/reference/formats.md).
#pragma once

#include "core/result.h"
#include "testscenes/camera_path.h"

#include <filesystem>

namespace ovc {

/// The maximum of frames and of bytes in a file.
inline constexpr uint32_t kMaxFrames = 1'000'000;
inline constexpr uint64_t kMaxPathBytes = uint64_t(64) << 20;

/// Reads a path of at least one frame. Where the file leaves out up or the angle of view, it is the
/// default Camera's. Error: one sentence with the file, the line or the frame.
Result<CameraPath> load_camera_path(const std::filesystem::path& file);

} // namespace ovc
