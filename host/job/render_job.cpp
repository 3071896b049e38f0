// SPDX-License-Identifier: Apache-2.0
// Reads the scene and builds the structure once, then renders picture after picture.
#include "host/job/render_job.h"

#include "core/file/value_bytes.h"
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/printable.h"
#include "host/backend/device_opening.h"
#include "host/camera/camera.h"
#include "host/film/unfinished.h"
#include "host/job/ending.h"
#include "host/job/watchers.h"
#include "host/output/stats.h"
#include "host/ranks/shared_film.h"
#include "host/render/frames.h"
#include "host/render/render.h"
#include "host/render/stage.h"
#include "host/scene/scene_cache.h"
#include "host/scene/scene_summary.h"
#include "host/shade/path_tracer.h"
#include "host/shade/whitted.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"
#include "host/terminal/progress.h"
#include "host/terminal/version.h"
#include "importers/scene_fields.h"
#include "importers/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <span>

namespace ovc {

namespace fs = std::filesystem;

/// Returns the camera with the lens that the job asks for, or its own.
static Camera with_lens(Camera camera, const RenderJob& job) {
    if (job.lens_radius)
        camera.lens = *job.lens_radius > 0
                          ? std::optional(lens_of(camera, *job.lens_radius, job.focus))
                          : std::nullopt;
    return camera;
}

/// Returns the camera of a single picture: the one asked for, else the scene's, else one that
/// frames the whole scene.
static Camera still_camera(const Scene& scene, const RenderJob& job, const ImageSize& size) {
    if (job.camera) {
        Camera camera = *job.camera;
        if (job.up)
            camera.up = axis_vector(*job.up);
        else if (scene.camera)
            camera.up = scene.camera->up;
        return camera;
    }
    if (scene.camera)
        return *scene.camera;
    return framing_camera(hittable_bounds(scene.soup), size.width, size.height, job.up.value_or(1));
}

/// Returns how many camera rays each pixel gets, or at least gets.
static uint32_t samples_of(const RenderJob& job, const Scene& scene) {
    // Those of the file are for its own camera, whose lens or faces need them.
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

static std::vector<std::string> outputs_of(const RenderJob& job, uint32_t frame) {
    std::vector<std::string> outputs = job.outputs;
    if (!job.shots.empty())
        for (std::string& output : outputs)
            output = frame_file(output, frame);
    return outputs;
}

/// Returns whether the job continues an earlier run that has finished this picture.
static bool is_there(const RenderJob& job, uint32_t frame) {
    const std::vector<std::string> outputs = outputs_of(job, frame);
    return job.go_on && !fs::exists(unfinished_film(outputs[0])) &&
           std::all_of(outputs.begin(), outputs.end(),
                       [](const std::string& output) { return fs::exists(output); });
}

/// A picture's number, and the camera that takes it.
struct View {
    uint32_t frame = 0;
    Camera camera;
};

/// Pictures of one scene, by one backend.
class Rendering {
public:
    Rendering(const RenderJob& job, const PicturePart& part, Scene& scene, Stage& stage,
              const InterruptGuard& interrupt, const LogSink& log, Watchers& watchers)
        : job_(job),
          log_(log),
          watchers_(watchers),
          options_(render_options(job, part, scene, log)),
          samples_(samples_of(job, scene)),
          scene_(scene),
          lights_(stage.lights()),
          stage_(stage),
          backend_(stage.backend()),
          interrupt_(interrupt) {}

    /// Renders a picture. Where it is interrupted, its pixels are kept beside its outputs, and
    /// stats.report is not complete. begun: how long its scene took, and the stage's statistics
    /// before that.
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

    bool is_sequence() const { return !job_.shots.empty(); }

private:
    Result<FrameStats> render_one(const View& shot, const FrameStats& begun) {
        const Stopwatch watch;
        FrameStats frame = begun;
        frame.frame = shot.frame;
        scene_.lights = placed_lights(scene_, lights_, shot.camera);
        Film film(options_.part->size.width, options_.part->size.height, samples_);
        if (const Result<Done> done = go_on_with(shot, film); !done)
            return done.error();
        if (job_.render.ranks)
            if (const Result<Done> done = spread_film(*job_.render.ranks, film); !done)
                return done.error();
        if (const Result<RenderReport> report = trace(shot, film); report)
            frame.report = *report;
        else
            return report.error();
        frame.tracing = counted_between(begun.tracing, stage_.statistics());
        frame.active = backend_.take_active();
        // The first of several ranks has the whole film, and makes an image of it, where the others
        // have a part.
        if (job_.render.ranks && !is_sequence() && !job_.aovs.any())
            backend_.purge();
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

    /// Returns a checksum of everything that the pixels depend on, without the picture's size:
    /// save_film() adds that.
    uint64_t checksum_of_picture(const View& shot) const {
        ByteWriter view;
        view(shot.camera, *options_.part, options_.integrator, options_.max_depth, options_.shadows,
             options_.cutouts, options_.seed, job_.backend.precision);
        if (const std::optional<Antialias>& how = options_.antialias)
            view(how->method, how->threshold, how->depth, how->jitter);
        if (options_.filter != FilterOptions{} || options_.clamp > 0)
            view(options_.filter.kind, options_.filter.radius, options_.clamp);
        Checksum sum;
        sum.add(view.bytes());
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
            watchers_.window->show(for_display(developed, job_.development));
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
        Image light = light_of(film, scene_.gamma);
        if (job_.denoiser && frame.report.complete)
            if (const Result<Done> done = denoise(light, shot); !done)
                return done;
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
            watchers_.window->show(for_display(developed, job_.development));
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

/// Limits the threads of this process while the result lives; 0: no limit.
static std::optional<ThreadLimit> limit_threads(uint32_t threads) {
    if (threads == 0)
        return {};
    // Mesa's software renderer reads this when the device is opened.
    setenv("LP_NUM_THREADS", fmt::format("{}", threads).c_str(), /* overwrite= */ 1);
    return std::optional<ThreadLimit>(std::in_place, threads);
}

static Result<PicturePart> part_of(const ImageSize& picture, const std::optional<Crop>& crop) {
    if (!crop)
        return PicturePart{picture, 0, 0, picture};
    if (uint64_t(crop->left) + crop->size.width > picture.width ||
        uint64_t(crop->top) + crop->size.height > picture.height)
        return Error{fmt::format("--crop {}x{}+{}+{} does not lie within the picture of {}x{}",
                                 crop->size.width, crop->size.height, crop->left, crop->top,
                                 picture.width, picture.height)};
    return PicturePart{picture, crop->left, crop->top, crop->size};
}

/// Returns the frames of the job; a single picture is frame 0.
static std::vector<uint32_t> frames_of(const RenderJob& job) {
    std::vector<uint32_t> frames;
    for (const Shot& shot : job.shots)
        frames.push_back(shot.frame);
    return frames.empty() ? std::vector<uint32_t>{0} : frames;
}

/// Returns for each frame whether is_there(), as the first rank sees it.
static Result<RankBytes> frames_there(const RenderJob& job) {
    RankBytes there;
    for (const uint32_t frame : frames_of(job))
        there.push_back(std::byte(is_there(job, frame)));
    return job.render.ranks ? job.render.ranks->spread(there, goes_on_always)
                            : Result<RankBytes>(std::move(there));
}

/// Tells the user where --continue finds neither pixels nor frames of an earlier run.
static void tell_of_nothing_to_go_on_with(const RenderJob& job, const LogSink& log) {
    const auto is_begun = [&](uint32_t frame) {
        return is_there(job, frame) || fs::exists(unfinished_film(outputs_of(job, frame)[0]));
    };
    if (!job.go_on || std::ranges::any_of(frames_of(job), is_begun))
        return;
    const std::string& output = job.outputs[0];
    say(log, LogLevel::Info,
        job.shots.empty()
            ? fmt::format("--continue: there is no {} to go on with; the picture is begun",
                          unfinished_film(output))
            : fmt::format("--continue: there is no frame {} to go on with; all are rendered",
                          output));
}

static void tell_of_up_left_out(const RenderJob& job, const Scene& scene, const LogSink& log) {
    if (job.up && !job.camera && scene.camera)
        say(log, LogLevel::Warning,
            fmt::format("--up left out: {} has a camera of its own; --camera replaces it",
                        job.scene.name()));
}

/// Renders every shot in turn until one is interrupted.
static Result<Done> render_shots(const RenderJob& job, std::span<const std::byte> there,
                                 const PicturePart& part, Stage& stage, Scene& scene,
                                 const LogSink& log, Watchers& watchers, RenderStats& stats) {
    stats.report.complete = true;
    const InterruptGuard interrupt; // of all shots, or one between two of them would be forgotten
    const std::vector<Shot> shots =
        job.shots.empty() ? std::vector<Shot>{Shot{.camera = job.camera}} : job.shots;
    for (size_t i = 0; i < shots.size(); ++i) {
        const Shot& shot = shots[i];
        if (there[i] != std::byte(0)) {
            ++stats.frames_there;
            continue;
        }
        const Stopwatch watch;
        FrameStats begun;
        begun.tracing = stage.statistics();
        const Result<Done> moved = stage.go_to(shot.moment);
        stats.report.complete = moved || moved.error().kind != ErrorKind::Cancelled;
        if (!moved)
            return stats.report.complete ? moved : Result<Done>(Done{});
        const View view{shot.frame, with_lens(shot.camera && !job.shots.empty()
                                                  ? *shot.camera
                                                  : still_camera(scene, job, part.picture),
                                              job)};
        // Nobody has checked that of a file before.
        if (const Result<Done> fine = check_camera(view.camera); !fine)
            return Error{fmt::format("{}: {}", job.scene.name(), fine.error().message)};
        begun.seconds_scene = watch.seconds();
        const Result<Done> done =
            Rendering(job, part, scene, stage, interrupt, log, watchers).run(view, begun, stats);
        if (!done || !stats.report.complete)
            return done;
    }
    return Done{};
}

/// Refuses frames that would all be alike.
static Result<Done> check_frames(const RenderJob& job, const Scene& scene) {
    if (job.shots.size() < 2 || scene.moves || job.shots[0].camera)
        return Done{};
    return Error{fmt::format("--frames: nothing in '{}' moves, and it has no camera path; "
                             "--camera-path gives it one",
                             job.scene.name())};
}

static void add_what_backend_tells(const RenderJob& job, const Scene& scene, Stage& stage,
                                   RenderStats& stats) {
    stats.tracing = stage.statistics();
    stats.renderer = stage.backend().renderer();
    stats.left_out =
        left_out_of(scene, needs_of(scene, {job.render.shadows,
                                            job.backend.precision == OVC_PRECISION_CERTIFIED,
                                            stats.tracing.leaves}));
}

static BackendOptions options_for(const RenderJob& job, const Scene& scene) {
    BackendOptions options = job.backend;
    options.saved = scene.saved;
    options.on_disk = scene.on_disk.get();
    options.watching = job.quiet ? BuildWatching::Silent : BuildWatching::Shown;
    return options;
}

/// Returns rays of the first picture's camera, by which ranks share leaves out.
static std::vector<Ray> camera_sample(const RenderJob& job, const PicturePart& part,
                                      const Scene& scene) {
    constexpr uint32_t kSide = 64;
    std::vector<Ray> rays;
    if (!job.render.ranks)
        return rays;
    const Camera camera = !job.shots.empty() && job.shots[0].camera
                              ? *job.shots[0].camera
                              : still_camera(scene, job, part.picture);
    const Pinhole pinhole(camera, part, &scene);
    for (uint32_t i = 0; i < kSide * kSide; ++i)
        rays.push_back(pinhole.ray(i % kSide * part.size.width / kSide,
                                   i / kSide * part.size.height / kSide, dvec2(0.5)));
    return rays;
}

static int say_all_is_there(const RenderJob& job) {
    if (!job.quiet)
        fmt::print("all is there in {}; without --continue it is rendered anew\n",
                   printable(fmt::format("{}", fmt::join(job.outputs, ", "))));
    return kExitOk;
}

/// Ranks share a picture out, and none could gather its light alone.
static Result<Done> check_ranks(const RenderJob& job, const Scene& scene) {
    if (job.render.ranks && scene.radiosity && job.render.integrator == IntegratorKind::Whitted)
        return Error{fmt::format("{}: radiosity is for one process; leave out mpirun, or give "
                                 "--integrator path",
                                 job.scene.name())};
    return Done{};
}

static Result<Done> open_window(const RenderJob& job, const ImageSize& size, Watchers& watchers) {
    if (!job.view)
        return Done{};
    Result<std::unique_ptr<Window>> window =
        Window::open("overcast: " + job.scene.name(), size.width, size.height);
    if (!window)
        return window.error();
    watchers.window = std::move(*window);
    return Done{};
}

/// there: whether each frame is there already.
static Result<int> render_others(const RenderJob& job, const RankBytes& there, Watchers& watchers) {
    const Stopwatch total;
    const std::optional<ThreadLimit> threads = limit_threads(job.threads);
    const LogSink log = standard_error_log(job.log_level);
    tell_of_nothing_to_go_on_with(job, log);
    RenderStats stats;
    if (!job.view) // Mesa's 512 bits crash where a window is drawn
        prepare_process(job.backend);
    DeviceOpening opening(job.backend);
    SceneCache cache(job.cache, job.scene, job.backend, job.size);
    Result<Scene> scene = cache.open(log);
    if (!scene)
        return scene.error();
    ScenePictures pictures({job.texture_memory, job.scene.strict}, log);
    if (const Result<Done> opened = pictures.open(*scene); !opened)
        return opened.error();
    if (job.render.integrator == IntegratorKind::Whitted)
        tell_simplifications(*scene, job.lights.empty() ? scene->lights : job.lights,
                             job.scene.name(), log);
    stats.scene = job.scene.name();
    const ImageSize size = job.size.value_or(scene->size.value_or(ImageSize{}));
    const Result<PicturePart> part = part_of(size, job.crop);
    if (!part)
        return part.error();
    stats.width = part->size.width;
    stats.height = part->size.height;
    stats.seconds_import = total.seconds();
    if (const Result<Done> opened = open_window(job, part->size, watchers); !opened)
        return opened.error();
    stats.scene_from_cache = cache.found();

    tell_of_up_left_out(job, *scene, log);
    if (const Result<Done> fine = check_frames(job, *scene); !fine)
        return fine.error();
    if (const Result<Done> fine = check_ranks(job, *scene); !fine)
        return fine.error();
    BackendOptions options = options_for(job, *scene);
    const std::vector<Ray> sample = camera_sample(job, *part, *scene);
    options.sample = sample;
    Result<std::unique_ptr<Backend>> backend = make_backend(scene->soup, options, log, opening);
    if (!backend && backend.error().kind == ErrorKind::Cancelled) {
        print_message("interrupted while building; nothing was rendered");
        return kExitInterrupted;
    }
    if (!backend)
        return backend.error();

    if (!job.render.ranks)
        cache.keep(*scene, **backend, log);
    options.saved = {}; // of the first moment
    options.sample = {};
    Stage stage(job, *scene, pictures, std::move(*backend), options);
    Result<Done> done = render_shots(job, there, *part, stage, *scene, log, watchers, stats);
    if (!done)
        return done.error();
    if (done = pictures.check(*scene); !done)
        return done.error();
    add_what_backend_tells(job, *scene, stage, stats);
    return tell(job, total, scene->omissions, stats);
}

Result<int> render(const RenderJob& job) {
    const Result<RankBytes> there = frames_there(job);
    if (!there)
        return there.error();
    if (std::ranges::count(*there, std::byte(0)) == 0)
        return say_all_is_there(job);
    Result<ProgressLines> lines =
        ProgressLines::open(is_first_rank(job) ? job.progress : std::string());
    if (!lines)
        return lines.error();
    Watchers watchers{std::move(*lines), nullptr};
    const Result<int> code = render_others(job, *there, watchers);
    watchers.lines.end(code && *code == kExitOk);
    if (watchers.window && code && *code == kExitOk)
        watchers.window->wait([] { return true; }); // or Ctrl-C, which ends the program
    return code;
}

} // namespace ovc
