// SPDX-License-Identifier: Apache-2.0
// Reads the scene and builds the structure once, then renders picture after picture.
#include "host/job/render_job.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/printable.h"
#include "host/backend/device_opening.h"
#include "host/camera/camera.h"
#include "host/film/unfinished.h"
#include "host/job/ending.h"
#include "host/job/view.h"
#include "host/job/watchers.h"
#include "host/output/stats.h"
#include "host/ranks/ranks.h"
#include "host/render/stage.h"
#include "host/scene/scene_cache.h"
#include "host/scene/scene_summary.h"
#include "host/shade/path_tracer.h"
#include "host/shade/whitted.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
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

/// Returns whether the job continues an earlier run that has finished this picture.
static bool is_there(const RenderJob& job, uint32_t frame) {
    const std::vector<std::string> outputs = outputs_of(job, frame);
    return job.go_on && !fs::exists(unfinished_film(outputs[0])) &&
           std::all_of(outputs.begin(), outputs.end(),
                       [](const std::string& output) { return fs::exists(output); });
}

/// Limits the threads of this process while the result lives; 0: no limit.
static std::optional<ThreadLimit> limit_threads(uint32_t threads) {
    if (threads == 0)
        return {};
    // Mesa's software renderer reads this when the device is opened.
    setenv("LP_NUM_THREADS", fmt::format("{}", threads).c_str(), /* overwrite= */ 1);
    return std::optional<ThreadLimit>(std::in_place, threads);
}

/// Returns the part that has about the same place in a picture of another size.
static PicturePart in_picture(const PicturePart& part, const ImageSize& picture) {
    const auto side = [](uint32_t first, uint32_t count, uint32_t of, uint32_t all) {
        const auto moved = [&](uint32_t place) {
            return uint32_t((uint64_t(place) * all + of / 2) / of);
        };
        const uint32_t begin = std::min(moved(first), all - 1);
        return std::pair(begin, std::max(moved(first + count), begin + 1) - begin);
    };
    const auto [left, width] = side(part.left, part.size.width, part.picture.width, picture.width);
    const auto [top, height] =
        side(part.top, part.size.height, part.picture.height, picture.height);
    return {picture, left, top, {width, height}};
}

static Result<PicturePart> part_of(const RenderJob& job, const Scene& scene) {
    const ImageSize picture = job.size.value_or(scene.size.value_or(ImageSize{}));
    const std::optional<Crop>& crop = job.crop;
    if (!crop)
        return scene.part ? in_picture(*scene.part, picture) : PicturePart{picture, 0, 0, picture};
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
    const std::vector<uint32_t> frames = frames_of(job);
    RankBytes there;
    for (const uint32_t frame : frames)
        there.push_back(std::byte(is_there(job, frame)));
    const Ranks* const ranks = job.render.ranks;
    if (!ranks)
        return there;
    if (const Result<Done> agreed =
            ranks->agree("list of frames", std::as_bytes(std::span(frames)));
        !agreed)
        return agreed.error();
    return ranks->spread(there, goes_on_always);
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

static void tell_of_integrator(const RenderJob& job, const Scene& scene, const LogSink& log) {
    if (job.render.integrator == IntegratorKind::Path)
        tell_what_paths_leave_out(scene, job.scene.name(), log);
    else
        tell_simplifications(scene, job.lights.empty() ? scene.lights : job.lights,
                             job.scene.name(), log);
}

static void tell_of_up_left_out(const RenderJob& job, const Scene& scene, const LogSink& log) {
    if (job.up && !job.camera && scene.camera)
        say(log, LogLevel::Warning,
            fmt::format("--up left out: {} has a camera of its own; --camera replaces it",
                        job.scene.name()));
}

/// The first rank traces layers through the leaves of all ranks when these are done with a frame:
/// they wait for it before anything moves.
static Result<Done> wait_for_layers(const RenderJob& job) {
    if (!job.render.ranks || !(job.aovs.any() || job.denoiser))
        return Done{};
    const auto told = job.render.ranks->spread({}, goes_on_always);
    return told ? Result<Done>(Done{}) : told.error();
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
        if (const Result<Done> ready = wait_for_layers(job); !ready)
            return ready;
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
            render_view({job, part, scene, stage, interrupt, log, watchers}, view, begun, stats);
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

static void prepare_process(const RenderJob& job) {
    if (job.view)
        prepare_process(OVC_KERNEL_FRAGMENT); // llvmpipe's 512 bits crash where a window is drawn
    else
        prepare_process(job.backend);
}

/// there: whether each frame is there already.
static Result<int> render_others(const RenderJob& job, const RankBytes& there, Watchers& watchers) {
    const Stopwatch total;
    const std::optional<ThreadLimit> threads = limit_threads(job.threads);
    const LogSink log = standard_error_log(job.log_level);
    tell_of_nothing_to_go_on_with(job, log);
    RenderStats stats;
    prepare_process(job);
    DeviceOpening opening(job.backend);
    SceneCache cache(job.cache, job.scene, job.backend, job.size);
    Result<Scene> scene = cache.open(log);
    if (!scene)
        return scene.error();
    ScenePictures pictures({job.texture_memory, job.scene.strict}, log);
    if (const Result<Done> opened = pictures.open(*scene); !opened)
        return opened.error();
    tell_of_integrator(job, *scene, log);
    stats.scene = job.scene.name();
    const Result<PicturePart> part = part_of(job, *scene);
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
    if (done)
        done = pictures.check(*scene);
    Ranks::fail_all_unless(done);
    if (!done)
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
    const bool complete = code && *code == kExitOk;
    const Result<Done> told = watchers.lines.end(complete);
    if (watchers.window && complete)
        watchers.window->wait([] { return true; }); // or Ctrl-C, which ends the program
    return complete && !told ? Result<int>(told.error()) : code;
}

} // namespace ovc
