// SPDX-License-Identifier: Apache-2.0
// save_streamed_levels() lets the plugin build a scene whose triangles lie on a disk, and
// plan_streamed_levels() plan it.
#pragma once

#include "core/result.h"
#include "core/vec.h"
#include "host/backend/backend.h"
#include "importers/file/step_file.h"
#include "importers/scratch/scratch_file.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// Triangles that are read in parts.
struct StreamedTriangles {
    struct Mesh {
        dvec3 origin{0};
        uint64_t triangles = 0;
    };
    std::vector<Mesh> meshes;
    /// Fills `corners` with a mesh's from its triangle `first` on. Returns false where the disk
    /// fails. Any number of threads may call it.
    std::function<bool(uint32_t mesh, uint64_t first, std::span<vec3> corners)> read;
    std::function<std::optional<Error>()> error; // the first failure
};

/// The files that the build keeps, so that a later one goes on.
struct KeptLevels {
    StepFile& steps;
    size_t first; // of the steps that are the plugin's
    /// Reads what an earlier build passed to the sink.
    std::function<bool(uint64_t offset, std::span<std::byte> to)> read_written;
    std::function<bool()> flush; // all that the sink got
};

/// Writes to the sink what Backend::save() would of two-level over the triangles. host_bytes: that
/// the plugin may take. kept: null keeps nothing; else the scratch file is the earlier build's.
/// Error: those of the plugin, a disk that fails, or another backend was asked for.
Result<Done> save_streamed_levels(const StreamedTriangles& triangles, uint64_t host_bytes,
                                  ScratchFile& scratch, const BackendOptions& options,
                                  const LogSink& log, const ByteSink& sink,
                                  const KeptLevels* kept = nullptr);

/// Returns what save_streamed_levels() would write, and what tracing that takes within host_bytes.
/// Error: as above.
Result<ovc_plan> plan_streamed_levels(const StreamedTriangles& triangles, uint64_t host_bytes,
                                      const BackendOptions& options, const LogSink& log);

} // namespace ovc
