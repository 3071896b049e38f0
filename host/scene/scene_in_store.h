// SPDX-License-Identifier: Apache-2.0
// SceneInStore: a scene whose triangles went to a scratch file as they were read.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "host/backend/streamed_levels.h"
#include "host/scene/scene_source.h"
#include "importers/scratch/triangle_store.h"

#include <cstdint>
#include <filesystem>

namespace ovc {

struct SceneInStore {
    Scene scene; // its meshes are empty, unless it is held
    TriangleStore store;

    /// Whether memory holds the scene: it has instances that share triangles, which fit.
    bool is_held() const { return scene.soup.triangle_count() > 0; }
    bool has_normals() const;
};

/// Error: they name several scenes, or one of a kind that does not stream.
Result<Done> check_streams(const SceneArguments& arguments);

/// Reads the one scene of the arguments within so many bytes of host memory. folder: for scratch
/// files. files: receives those that are read; or null. By default the scene may have as many
/// triangles as can be numbered. Error: besides those of reading, the disk fails.
Result<SceneInStore> stream_scene(const SceneArguments& source, uint64_t host_bytes,
                                  const std::filesystem::path& folder, const LogSink& log,
                                  FilesRead* files = nullptr);

/// Returns what the plugin reads of the store. Both outlive it.
StreamedTriangles triangles_in(const Scene& scene, const TriangleStore& store);

} // namespace ovc
