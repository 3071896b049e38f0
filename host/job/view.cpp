// SPDX-License-Identifier: Apache-2.0
// Goes on with the film of an earlier run, traces what lacks, and keeps it where that ends early.
#include "host/job/view.h"

#include "core/file/value_bytes.h"
#include "core/system/stopwatch.h"
#include "host/camera/camera.h"
#include "host/film/unfinished.h"
#include "host/job/ending.h"
#include "host/ranks/shared_film.h"
#include "host/render/frames.h"
#include "host/render/render.h"
#include "host/shade/path_tracer.h"
#include "host/terminal/message.h"
#include "host/terminal/progress.h"
#include "host/terminal/version.h"
#include "importers/scene_file/scene_fields.h"
#include "importers/scene_file/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace ovc {

namespace fs = std::filesystem;

/// Returns how many camera rays each pixel gets, or at least gets.
static uint32_t samples_of(const RenderJob& job, const Scene& scene) {
    // The file's samples are for its own camera, whose lens or faces need them.
    const bool own_camera = !job.camera && job.lens_radius.value_or(1) > 0;
    const uint32_t asked_for =
        own_camera && !job.render.progressive ? scene.samples.value_or(1) : 1;
    return job.samples.value_or(std::clamp(asked_for, 1u, kMaxSamples));
}

static RenderOptions render_options(const RenderJob& job, const PicturePart& part,
                                    const Scene& scene, const LogSink& log) {
    RenderOptions options = job.render;
    options.part = part;
    if (options.antialias && samples_of(job, scene) > 1) {
        say(log, LogLevel::Info,
            fmt::format("{}: its camera takes {} rays a pixel, in place of --antialias",
                        job.scene.name(), samples_of(job, scene)));
        options.antialias.reset();
    }
    // A file's depth is meant for mirrors and glass; path tracing follows light for longer.
    const uint32_t otherwise = options.integrator == IntegratorKind::Path
                                   ? PathTracerOptions{}.max_depth
                                   : scene.max_depth.value_or(options.max_depth);
    options.max_depth = job.max_depth.value_or(otherwise);
    options.max_depth = std::min(options.max_depth, kMaxDepth);
    return options;
}

std::vector<std::string> outputs_of(const RenderJob& job, uint32_t frame) {
    std::vector<std::string> outputs = job.outputs;
    if (!job.shots.empty())
        for (std::string& output : outputs)
            output = frame_file(output, frame);
    return outputs;
}

namespace {

class Rendering {
public:
    explicit Rendering(const SceneOfViews& of)
        : job_(of.job),
          log_(of.log),
          watchers_(of.watchers),
          options_(render_options(of.job, of.part, of.scene, of.log)),
          samples_(samples_of(of.job, of.scene)),
          scene_(of.scene),
          lights_(of.stage.lights()),
          stage_(of.stage),
          backend_(of.stage.backend()),
          interrupt_(of.interrupt) {}

    Result<Done> run(const View& view, const FrameStats& begun, RenderStats& stats) {
        const Result<FrameStats> frame = render_one(view, begun);
        if (!frame)
            return frame.error();
        stats.report.complete = frame->report.complete;
        stats.report.failed = frame->report.failed;
        if (!frame->report.complete && is_sequence())
            return Done{};
        stats.add(*frame);
        if (is_sequence() && !job_.quiet) {
            fmt::print("{}\n", frame_summary(*frame));
            std::fflush(stdout);
        }
        return Done{};
    }

private:
    bool is_sequence() const { return !job_.shots.empty(); }

    Result<FrameStats> render_one(const View& shot, const FrameStats& begun) {
        const Stopwatch watch;
        FrameStats frame = begun;
        frame.frame = shot.frame;
        scene_.lights = placed_lights(scene_, lights_, shot.camera);
        Film film(options_.part->size.width, options_.part->size.height, samples_);
        if (const Result<Done> done = go_on_with(shot, film); !done)
            return done.error();
        if (job_.render.ranks)
            if (const Result<Done> done = begin_with_ranks(*job_.render.ranks, shot, film); !done)
                return done.error();
        if (const Result<RenderReport> report = trace(shot, film); report)
            frame.report = *report;
        else
            return report.error();
        frame.tracing = counted_between(begun.tracing, stage_.statistics());
        frame.active = backend_.take_active();
        frame.host_peak_bytes = host_peak_bytes();
        frame.seconds = watch.seconds(); // for the notes in its files
        const Stopwatch output;
        const Result<Done> saved = !is_first_rank(job_)    ? Done{}
                                   : frame.report.complete ? save_finished(shot, film, frame)
                                                           : save_unfinished(shot, film, frame);
        if (!saved)
            return saved.error();
        frame.seconds_output = output.seconds();
        frame.seconds = watch.seconds();
        frame.host_peak_bytes = host_peak_bytes();
        return frame;
    }

    std::vector<std::string> outputs_of(const View& shot) const {
        return ovc::outputs_of(job_, shot.frame);
    }
    std::string film_of(const View& shot) const { return unfinished_film(outputs_of(shot)[0]); }

    Result<Done> go_on_with(const View& shot, Film& film) const {
        if (!job_.go_on || !is_first_rank(job_) || !fs::exists(film_of(shot)))
            return Done{};
        const Result<Done> loaded = load_film(film_of(shot), checksum_of_picture(shot), film);
        if (loaded)
            say(log_, LogLevel::Info,
                fmt::format("going on with {}: {} of {} pixels are there", film_of(shot),
                            film.pixels_done(), uint64_t(film.width()) * film.height()));
        return loaded;
    }

    /// Gives all ranks the film of the first one. They would mix up pictures that differ.
    Result<Done> begin_with_ranks(const Ranks& ranks, const View& shot, Film& film) const {
        ByteWriter picture = view_of(shot);
        picture(film.width(), film.height(), film.samples(), scene_.soup.triangle_count(),
                scene_.soup.chunks.size(), scene_.lights, scene_.materials);
        const Result<Done> agreed = ranks.agree("picture", picture.bytes());
        return agreed ? spread_film(ranks, film) : agreed;
    }

    /// Returns what the pixels depend on besides the scene and the picture's size.
    ByteWriter view_of(const View& shot) const {
        ByteWriter view;
        view(shot.camera, *options_.part, options_.integrator, options_.max_depth, options_.shadows,
             options_.cutouts, options_.seed, job_.backend.precision);
        if (const std::optional<Antialias>& how = options_.antialias)
            view(how->method, how->threshold, how->depth, how->jitter);
        if (options_.filter != FilterOptions{} || options_.clamp > 0)
            view(options_.filter.kind, options_.filter.radius, options_.clamp);
        return view;
    }

    /// Returns a checksum of everything that the pixels depend on, without the picture's size:
    /// save_film() adds that.
    uint64_t checksum_of_picture(const View& shot) const {
        Checksum sum;
        sum.add(view_of(shot).bytes());
        sum.add_value(checksum_of(scene_));
        return sum.value();
    }

    /// Returns what was made of the scene; an error where shading missed corners that the backend
    /// did not.
    template <class T>
    Result<T> checked(Result<T> made) const {
        return scene_.on_disk ? scene_.on_disk->checked(std::move(made)) : std::move(made);
    }

    Result<RenderReport> trace(const View& shot, Film& film) {
        const uint64_t pixels = uint64_t(film.width()) * film.height();
        Progress progress(backend_, is_sequence() ? fmt::format("frame {}: ", shot.frame) : "",
                          pixels, film.pixels_done(),
                          /* shown= */ !job_.quiet);
        const auto observe = [&](const RenderReport& report) {
            progress.update(report);
            watchers_.lines.progress(shot.frame, double(report.pixels_done) / double(pixels),
                                     report);
            return !interrupt_.interrupted();
        };
        RenderOptions options = options_;
        // The first of several ranks gets the whole film, and makes an image of it, where the
        // others have a part.
        options.purges = !is_sequence() && !job_.aovs.any();
        options.keep = [&](const Film& so_far) {
            return save_film(so_far, checksum_of_picture(shot), film_of(shot));
        };
        if (options.progressive && !is_sequence())
            options.progressive->show = [&](const Film& so_far) { show(shot, so_far); };
        return checked(render_picture(scene_, shot.camera, backend_, options, observe, film));
    }

    /// Writes the picture so far beside the outputs. Where that fails the rendering goes on, and
    /// whoever waits for the outputs themselves is told of them.
    void show(const View& shot, const Film& so_far) {
        std::vector<std::string> files = outputs_of(shot);
        for (std::string& file : files)
            file = unfinished_picture(file);
        const DevelopedImage developed = develop(light_of(so_far, scene_.gamma), job_.development);
        if (watchers_.window)
            watchers_.window->show(image_of(for_display(developed, job_.development)));
        if (save_picture(developed, files, job_.development, {.png_bits = job_.png_bits}))
            tell_of(shot, files, /* finished= */ false);
    }

    void tell_of(const View& shot, const std::vector<std::string>& files, bool finished) {
        for (const std::string& file : files)
            watchers_.lines.picture(shot.frame, file, finished);
    }

    Result<Done> save_finished(const View& shot, const Film& film, const FrameStats& frame) {
        const std::vector<std::string> outputs = outputs_of(shot);
        if (const Result<Done> saved = save_all(outputs, shot, film, frame); !saved)
            return kept(saved.error(), shot, film);
        std::error_code ignored; // most often there is no such file
        fs::remove(film_of(shot), ignored);
        for (const std::string& output : outputs)
            fs::remove(unfinished_picture(output), ignored);
        tell_of(shot, outputs, /* finished= */ true);
        return Done{};
    }

    /// Saves the film where an output cannot be written, so that the picture is not lost.
    Error kept(Error error, const View& shot, const Film& film) {
        if (options_.progressive) // a film does not say how many samples its pixels have had
            return error;
        if (save_film(film, checksum_of_picture(shot), film_of(shot)))
            error.message += fmt::format("; the picture is kept in {}, and --continue writes it "
                                         "without rendering it again",
                                         film_of(shot));
        return error;
    }

    /// Saves the film and the picture so far beside the outputs, which may be finished pictures of
    /// an earlier run. A sequence gets no picture, for it would only be one of many.
    Result<Done> save_unfinished(const View& shot, const Film& film, const FrameStats& frame) {
        if (film.pixels_done() == 0)
            return Done{};
        std::vector<std::string> outputs = outputs_of(shot);
        const Result<Done> saved = options_.progressive
                                       ? Done{}
                                       : save_film(film, checksum_of_picture(shot), film_of(shot));
        if (!saved || is_sequence())
            return saved;
        for (std::string& output : outputs)
            output = unfinished_picture(output);
        return save_all(outputs, shot, film, frame);
    }

    /// Returns notes for .exr files on how the picture was made.
    std::vector<FileNote> notes_of(const FrameStats& frame) const {
        return {{"overcast:version", version_text()},
                {"overcast:scene", job_.scene.name()},
                {"overcast:options", job_.command_line},
                {"overcast:renderer", backend_.renderer()},
                {"overcast:statistics", frame_json(frame)}};
    }

    /// Returns the number of samples whose mean the picture shows, as far as layers need it.
    uint32_t samples_of_layers() const {
        return options_.progressive || options_.antialias ? kMaxSamples : samples_;
    }

    Result<std::vector<Layer>> traced_layers(const View& shot, const Aovs& aovs) {
        return checked(trace_aovs(scene_, Pinhole(shot.camera, *options_.part, &scene_),
                                  Sight(scene_, options_.cutouts), backend_, aovs,
                                  samples_of_layers(),
                                  {.filter = options_.filter, .seed = options_.seed}));
    }

    Result<Done> denoise(Image& light, const View& shot) {
        const auto features = traced_layers(shot, {.normal = true, .albedo = true});
        return features ? job_.denoiser->denoise(light, *features) : Result<Done>(features.error());
    }

    Result<Done> save_all(const std::vector<std::string>& outputs, const View& shot,
                          const Film& film, const FrameStats& frame) {
        Image denoised; // where anything is
        PixelSource light = light_of(film, scene_.gamma);
        if (job_.denoiser && frame.report.complete) {
            denoised = image_of(light);
            if (const Result<Done> done = denoise(denoised, shot); !done)
                return done;
            light = PixelSource(denoised);
        }
        const DevelopedImage developed = develop(std::move(light), job_.development);
        FileContents contents;
        contents.png_bits = job_.png_bits;
        contents.notes = notes_of(frame);
        if (job_.aovs.any()) {
            Result<std::vector<Layer>> traced = traced_layers(shot, job_.aovs);
            if (!traced)
                return traced.error();
            contents.layers = std::move(*traced);
        }
        if (const std::optional<Sampled>& found = frame.report.sampled)
            say(log_, LogLevel::Info,
                fmt::format("{:.1f} samples a pixel, {} to {}; noise of the noisiest block: {}",
                            found->mean, found->min, found->max,
                            std::isfinite(found->noise) ? fmt::format("{:.2g}", found->noise)
                                                        : "not known after one pass"));
        if (developed.stops && job_.development.exposure->is_automatic)
            say(log_, LogLevel::Info,
                fmt::format("--exposure auto: {:+.2f} stops", *developed.stops));
        if (watchers_.window)
            watchers_.window->show(image_of(for_display(developed, job_.development)));
        return save_picture(developed, outputs, job_.development, std::move(contents));
    }

    const RenderJob& job_;
    const LogSink& log_;
    Watchers& watchers_;
    const RenderOptions options_;
    const uint32_t samples_; // camera rays a pixel
    Scene& scene_;
    const std::vector<Light>& lights_; // as the scene or the user has them
    Stage& stage_;
    Backend& backend_;
    const InterruptGuard& interrupt_;
};

} // namespace

Result<Done> render_view(const SceneOfViews& of, const View& view, const FrameStats& begun,
                         RenderStats& stats) {
    return Rendering(of).run(view, begun, stats);
}

} // namespace ovc
