// SPDX-License-Identifier: Apache-2.0
// Reads the scene anew for each moment, and tells the backend what has moved since the one before.
#include "host/render/stage.h"

#include "host/output/stats.h"
#include "host/scene/soup_difference.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace ovc {

Stage::Stage(const RenderJob& job, Scene& scene, ScenePictures& pictures,
             std::unique_ptr<Backend> backend, const BackendOptions& options)
    : arguments_(job.scene),
      size_(job.size),
      scene_(scene),
      pictures_(pictures),
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
    // Messages about the scene were said of its first moment.
    Result<Scene> next = open_scene(arguments_, LogSink(), size_);
    if (!next)
        return next.error();
    const SoupDifference changes = difference(scene_.soup, next->soup);
    // A backend has the corners of meshes that are gone until it is up to date.
    const std::vector<Chunk> gone = take_over(scene_.soup, std::exchange(next->soup, {}), changes);
    take_all_but_soup(std::move(*next), changes.added > 0);
    if (const Result<Done> opened = pictures_.open(scene_); !opened)
        return opened;
    return changes.any() ? update(changes) : Result<Done>(Done{});
}

/// borrows: some of the soup borrows from files of `next`.
void Stage::take_all_but_soup(Scene next, bool borrows) {
    if (!borrows)
        next.files.clear();
    std::ranges::move(scene_.files, std::back_inserter(next.files));
    next.saved = {};
    next.soup = std::move(scene_.soup); // which the backend uses where it lies
    next.moves = true;
    scene_ = std::move(next);
    lights_ = lights_now();
}

ovc_statistics Stage::statistics() const {
    return counted_besides(gone_, backend_->statistics());
}

/// The library may find that building anew costs less than an update. It then counts from 0.
Result<Done> Stage::update(const SoupDifference& changes) {
    const ovc_statistics before = backend_->statistics();
    const Result<bool> updated = backend_->update(scene_.soup, changes);
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
