// SPDX-License-Identifier: Apache-2.0
// save_streamed_levels() lets the plugin build a scene whose triangles lie on a disk.
#pragma once

#include "core/scene.h"
#include "host/backend/backend.h"
#include "importers/file/triangle_store.h"

#include <filesystem>

namespace ovc {

/// Writes to the sink what Backend::save() would of two-level over the scene, whose meshes are
/// empty and whose triangles lie in the store. host_bytes: that the plugin may take. folder: of its
/// scratch file. Error: those of the plugin, a disk that fails, or another backend was asked for.
Result<Done> save_streamed_levels(const Scene& scene, const TriangleStore& store,
                                  uint64_t host_bytes, const std::filesystem::path& folder,
                                  const BackendOptions& options, const LogSink& log,
                                  const ByteSink& sink);

} // namespace ovc
