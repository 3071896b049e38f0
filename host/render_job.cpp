// SPDX-License-Identifier: Apache-2.0
// Rendering: the scene and the structure once, then picture after picture.
#include "host/render_job.h"

#include "core/stopwatch.h"
#include "host/camera.h"
#include "host/frames.h"
#include "host/interrupt.h"
#include "host/progress.h"
#include "host/render.h"
#include "host/scene_cache.h"
#include "host/scene_summary.h"
#include "host/stats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ovc {

/// The camera of a single picture: the one asked for, the scene's, or one that sees all of it.
static Camera still_camera(const Scene& scene, const RenderJob& job, const ImageSize& size) {
    if (job.camera) {
        Camera camera = *job.camera;
        if (scene.camera)
            camera.up = scene.camera->up;
        return camera;
    }
    if (scene.camera)
        return *scene.camera;
    return framing_camera(hittable_bounds(scene.soup), size.width, size.height);
}

static RenderOptions render_options(const RenderJob& job, const Scene& scene) {
    RenderOptions options = job.render;
    options.max_depth = job.max_depth.value_or(scene.max_depth.value_or(options.max_depth));
    options.max_depth = std::min(options.max_depth, kMostDepth);
    return options;
}

/// A run of pictures over one scene and one backend.
class Rendering {
public:
    Rendering(const RenderJob& job, const ImageSize& size, Scene& scene, Backend& backend)
        : job_(job),
          size_(size),
          options_(render_options(job, scene)),
          scene_(scene),
          lights_(job.lights.empty() ? scene.lights : job.lights),
          backend_(backend) {}

    /// Every picture in turn until one is interrupted. A single picture is saved as far as it
    /// came; of a sequence, only whole frames are.
    Result<Done> run(const std::vector<Shot>& shots, RenderStats& stats) {
        stats.report.complete = true;
        for (const Shot& shot : shots) {
            const Result<FrameStats> frame = render_one(shot);
            if (!frame)
                return frame.error();
            stats.report.complete = frame->report.complete;
            if (!frame->report.complete && is_sequence())
                return Done{};
            stats.add(*frame);
            if (is_sequence() && !job_.quiet) {
                fmt::print("{}\n", frame_summary(*frame));
                std::fflush(stdout);
            }
            if (!stats.report.complete)
                return Done{};
        }
        return Done{};
    }

    bool is_sequence() const { return !job_.shots.empty(); }

private:
    Result<FrameStats> render_one(const Shot& shot) {
        const Stopwatch watch;
        const ovc_statistics before = backend_.statistics();
        FrameStats frame;
        frame.frame = shot.frame;
        scene_.lights = placed_lights(lights_, shot.camera);
        Film film(size_.width, size_.height, job_.samples);
        if (const Result<RenderReport> report = trace(shot, film); report)
            frame.report = *report;
        else
            return report.error();
        Image image = film.image();
        if (scene_.gamma != 1)
            to_linear(image);
        frame.tracing = counted_between(before, backend_.statistics());
        frame.active = backend_.take_active();
        const Stopwatch output;
        if (frame.report.complete || !is_sequence())
            if (const Result<Done> saved = save_all(image, shot); !saved)
                return saved.error();
        frame.seconds_output = output.seconds();
        frame.seconds = watch.seconds();
        frame.host_peak_bytes = host_peak_bytes();
        return frame;
    }

    /// From the light of a scene with an assumed_gamma to what files hold.
    void to_linear(Image& image) const {
        for (vec4& pixel : image.pixels)
            for (int i = 0; i < 3; ++i)
                pixel[i] = std::pow(std::max(pixel[i], 0.0f), float(scene_.gamma));
    }

    Result<RenderReport> trace(const Shot& shot, Film& film) {
        Progress progress(backend_, is_sequence() ? fmt::format("frame {}: ", shot.frame) : "",
                          uint64_t(film.width()) * film.height(), /* shown= */ !job_.quiet);
        const auto observe = [&](const RenderReport& report) {
            progress.update(report);
            return !interrupt_.interrupted();
        };
        return render_picture(scene_, shot.camera, backend_, options_, observe, film);
    }

    Result<Done> save_all(const Image& image, const Shot& shot) {
        FileContents contents;
        contents.png_bits = job_.png_bits;
        if (job_.aovs.any()) {
            Result<std::vector<Layer>> traced =
                trace_aovs(scene_, shot.camera, backend_, job_.aovs, image.width, image.height);
            if (!traced)
                return traced.error();
            contents.layers = std::move(*traced);
        }
        for (const std::string& output : job_.outputs)
            if (const Result<Done> saved = save_image(
                    image, is_sequence() ? frame_file(output, shot.frame) : output, contents);
                !saved)
                return saved;
        return Done{};
    }

    const RenderJob& job_;
    const ImageSize size_;
    const RenderOptions options_;
    Scene& scene_;
    const std::vector<Light> lights_; // as the scene or the user has them
    Backend& backend_;
    const InterruptGuard interrupt_;
};

static void report(const RenderJob& job, const RenderStats& stats) {
    if (!job.quiet && !stats.frames.empty())
        fmt::print("{}  wrote      {}\n", stats_summary(stats), fmt::join(job.outputs, ", "));
    if (stats.report.complete)
        return;
    if (job.shots.empty())
        fmt::print(stderr, "overcast: interrupted; what was rendered so far is saved\n");
    else
        fmt::print(stderr,
                   "overcast: interrupted; {} of {} frames are saved, frame {} is the next to "
                   "render\n",
                   stats.frames.size(), job.shots.size(), job.shots[stats.frames.size()].frame);
}

Result<int> render(const RenderJob& job) {
    const Stopwatch total;
    const LogSink log = standard_error_log(/* chatty= */ !job.quiet);
    RenderStats stats;
    SceneCache cache(job.cache, job.scene, job.backend, job.size);
    Result<Scene> scene = cache.open(log);
    if (!scene)
        return scene.error();
    stats.scene = job.scene.scene;
    const ImageSize size = job.size.value_or(scene->size.value_or(ImageSize{}));
    stats.width = size.width;
    stats.height = size.height;
    stats.seconds_import = total.seconds();
    stats.scene_from_cache = cache.found();

    const std::vector<Shot> shots =
        job.shots.empty() ? std::vector<Shot>{{0, still_camera(*scene, job, size)}} : job.shots;
    for (const Shot& shot : shots) // a file's camera is not checked yet
        if (const Result<Done> fine = check_camera(shot.camera); !fine)
            return Error{fmt::format("{}: {}", job.scene.scene, fine.error().message)};
    BackendOptions options = job.backend;
    options.saved = scene->saved;
    options.watching = job.quiet ? BuildWatching::Silent : BuildWatching::Shown;
    const Result<std::unique_ptr<Backend>> backend = make_backend(scene->soup, options, log);
    if (!backend && backend.error().kind == ErrorKind::Cancelled) {
        fmt::print(stderr, "overcast: interrupted while building; nothing was rendered\n");
        return kExitInterrupted;
    }
    if (!backend)
        return backend.error();

    cache.keep(*scene, **backend, log);
    Result<Done> done = Rendering(job, size, *scene, **backend).run(shots, stats);
    if (!done)
        return done.error();
    stats.tracing = (*backend)->statistics();
    stats.renderer = (*backend)->renderer();
    stats.left_out =
        left_out_of(*scene, needs_of(*scene, {job.render.shadows,
                                              job.backend.precision == OVC_PRECISION_CERTIFIED,
                                              stats.tracing.leaves}));
    stats.seconds_total = total.seconds();
    if (!job.stats.empty())
        if (done = save_text(stats_json(stats), job.stats); !done)
            return done.error();
    report(job, stats);
    return stats.report.complete ? kExitOk : kExitInterrupted;
}

} // namespace ovc
