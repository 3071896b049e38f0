// SPDX-License-Identifier: Apache-2.0
// Reads the scene anew for each moment, and tells the backend what has moved since the one before.
#include "host/render/stage.h"

#include "host/output/stats.h"
#include "host/scene/moved_meshes.h"

#include <utility>

namespace ovc {

Stage::Stage(const RenderJob& job, Scene& scene, std::unique_ptr<Backend> backend,
             const BackendOptions& options)
    : arguments_(job.scene),
      size_(job.size),
      scene_(scene),
      backend_(std::move(backend)),
      options_(options),
      given_lights_(job.lights),
      lights_(lights_now()) {}

std::vector<Light> Stage::lights_now() const {
    return given_lights_.empty() ? scene_.lights : given_lights_;
}

Result<Done> Stage::go_to(const Moment& moment) {
    if (!scene_.moves || moment == arguments_.moment)
        return Done{};
    arguments_.moment = moment;
    // What there is to say of the scene was said of its first moment.
    Result<Scene> next = open_scene(arguments_, LogSink(), size_);
    if (!next)
        return next.error();
    const auto moved = moved_meshes(scene_.soup, next->soup);
    if (moved) {
        move_meshes(scene_.soup, next->soup, *moved);
        next->soup = std::move(scene_.soup);   // which the backend uses where it lies
        next->files = std::move(scene_.files); // which it may borrow from
        next->saved = {};
    } else {
        gone_ = statistics();
        backend_.reset(); // before its soup
    }
    next->moves = true;
    scene_ = std::move(*next);
    lights_ = lights_now();
    return moved ? update(*moved) : build_anew();
}

ovc_statistics Stage::statistics() const {
    return counted_besides(gone_, backend_->statistics());
}

/// The library may find that building anew costs less than an update. It then counts from 0.
Result<Done> Stage::update(const std::vector<MovedMesh>& moved) {
    if (moved.empty())
        return Done{};
    const ovc_statistics before = backend_->statistics();
    const Result<bool> updated = backend_->update(scene_.soup, moved);
    if (!updated)
        return updated.error();
    if (*updated && backend_->statistics().updates > before.updates)
        return Done{};
    gone_ = counted_besides(gone_, before);
    return *updated ? Result<Done>(Done{}) : build_anew();
}

Result<Done> Stage::build_anew() {
    backend_.reset();
    Result<std::unique_ptr<Backend>> made = make_backend(scene_.soup, options_, LogSink());
    if (!made)
        return made.error();
    backend_ = std::move(*made);
    return Done{};
}

} // namespace ovc
