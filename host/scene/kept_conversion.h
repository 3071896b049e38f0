// SPDX-License-Identifier: Apache-2.0
// KeptConversion: three files beside an output, from which a conversion goes on that was ended.
#pragma once

#include "host/backend/backend.h"
#include "host/scene/scene_source.h"
#include "importers/file/step_file.h"
#include "importers/scene_file/scene_file.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ovc {

/// Of "out.ovc", "out.unfinished.ovc" is what is written so far, "out.unfinished.scratch" holds
/// triangles on their way to their leaves, and "out.unfinished.steps" tells which of that is done.
/// They stay until the conversion is finished.
class KeptConversion {
public:
    /// source, options: what the steps are of; those of others are forgotten. Error: the files
    /// cannot be written, or another process has them open.
    static Result<KeptConversion> open(const std::filesystem::path& output,
                                       const SceneArguments& source, const BackendOptions& options);

    /// Returns the name of the file that is written.
    const std::filesystem::path& unfinished() const { return unfinished_; }

    /// Takes the front that an earlier run has written. Returns why it cannot: nothing is there, or
    /// it is damaged, or a file that it was read from has changed. All is then begun anew.
    Result<Done> take_front();
    /// Writes the front.
    Result<Done> write_front(const Scene& scene, const TriangleStore& store,
                             const Provenance& from);
    bool has_front() const { return front_.has_value(); }
    /// Builds the levels behind the front, puts the file in its place, and removes the others.
    Result<Done> finish(BackendOptions options, const LogSink& log);
    /// Removes the files, where there is nothing to keep.
    void remove();

private:
    KeptConversion(std::filesystem::path output, std::filesystem::path unfinished,
                   std::filesystem::path scratch, StepFile steps)
        : output_(std::move(output)),
          unfinished_(std::move(unfinished)),
          scratch_(std::move(scratch)),
          steps_(std::move(steps)) {}

    Result<Done> take(Result<SceneFront> front);

    std::filesystem::path output_;
    std::filesystem::path unfinished_;
    std::filesystem::path scratch_;
    StepFile steps_; // the parts of the front, and then those of the plugin
    std::optional<SceneFront> front_;
};

} // namespace ovc
