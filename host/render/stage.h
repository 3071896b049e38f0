// SPDX-License-Identifier: Apache-2.0
// Stage: the scene and the backend of a picture, which go on from moment to moment.
#pragma once

#include "host/backend/backend.h"
#include "host/job/render_job.h"

#include <memory>
#include <optional>
#include <vector>

namespace ovc {

struct SoupDifference;

class Stage {
public:
    /// The scene is that of the job's first moment, with its pictures, and the backend is built of
    /// it; the scene, its pictures and the job outlive this. options: for building anew.
    Stage(const RenderJob& job, Scene& scene, ScenePictures& pictures,
          std::unique_ptr<Backend> backend, const BackendOptions& options);

    Backend& backend() { return *backend_; }
    /// Returns what the backend tells, and what those before it have counted besides.
    ovc_statistics statistics() const;
    /// Returns the lights as the user or the scene has them.
    const std::vector<Light>& lights() const { return lights_; }

    /// Goes on to this moment, where something in the scene moves. What is the same in both moments
    /// is not built anew, except for meshes behind one that has become another.
    Result<Done> go_to(const Moment& moment);

private:
    std::vector<Light> lights_now() const;
    void take_all_but_soup(Scene next, bool borrows);
    Result<Done> update(const SoupDifference& changes);
    Result<Done> build_anew();

    SceneArguments arguments_;
    const std::optional<ImageSize> size_;
    Scene& scene_;
    ScenePictures& pictures_;
    std::unique_ptr<Backend> backend_;
    const BackendOptions options_;
    const std::vector<Light>& given_lights_;
    std::vector<Light> lights_;
    ovc_statistics gone_{}; // counted by structures that are no more
};

} // namespace ovc
