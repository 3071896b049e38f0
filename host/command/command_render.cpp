// SPDX-License-Identifier: Apache-2.0
// overcast render: a scene in, pictures and statistics out. Here are its options, and their checks;
// host/job/render_job.cpp does the work.
#include "host/arguments/backend_arguments.h"
#include "host/arguments/film_arguments.h"
#include "host/arguments/log_arguments.h"
#include "host/arguments/memory_size.h"
#include "host/arguments/pov_words.h"
#include "host/camera/camera.h"
#include "host/camera/camera_path_file.h"
#include "host/command/command.h"
#include "host/job/render_job.h"
#include "host/ranks/join_ranks.h"
#include "host/render/frames.h"
#include "host/terminal/interrupt.h"
#include "testscenes/catalog.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace ovc {

namespace fs = std::filesystem;

static constexpr const char* kRenderExamples = R"(Examples:
  overcast render dragon.ply
      writes out.png, 512x512; camera and light are placed by themselves
  overcast render scan.ply floor.obj --up z
      two files as one scene, whose z axis is up
  overcast render dragon.ply -o d.png -o d.exr --size 1920x1080 --gpu-memory 12M
      two files, and no more than 12 MiB of GPU memory
  overcast render kitchen.obj --camera 3,1.6,4,0,1,0,60 --light 0,2.4,0 --light 2,2.4,2
      from a point of view, 60 degrees wide, with two lights
  overcast render plants --stats plants.json --quiet
      a generated scene, with statistics for a program
  overcast render dragons-10 --frames 0:99 -o dragons-####.png
      100 frames along the scene's camera path, built once: dragons-0000.png to dragons-0099.png
  overcast render dragon.ply --camera-path walk.csv --frames 0:90:10 -o walk-###.png
      every tenth frame of a path of your own (docs/guide/scenes.md)
  overcast render clock.pov --frames 1:25 -o clock-##.png
      25 frames of what moves in the scene; what stays is not built anew
  overcast render dragons-5 --model dragon.ply
      the scene with your model in the place of the generated one
  overcast render plants.pbrt --cache ~/.cache/overcast -o plants.png
      the second time it starts at once
  overcast render cornell-box.pbrt --integrator path --samples 256 -o box.exr
      all light there is, from surface to surface; more samples, less noise (docs/guide/path.md)
  overcast render dragon.ply +W640 +H480 +Od.png
      POV-Ray's words are understood

Interrupted with Ctrl-C, it keeps what it has, the picture so far as NAME.unfinished.png, and exits with 2;
the same command with --continue goes on from there.)";

/// In the order of RenderMode.
static constexpr std::string_view kModes[] = {"auto", "batched", "mixed"};
/// In the order of IntegratorKind.
static constexpr std::string_view kIntegrators[] = {"whitted", "path"};
static constexpr std::string_view kAxes[] = {"x", "y", "z"};

/// The options as the user wrote them.
struct RenderWords {
    SceneArguments scene;
    std::vector<std::string> outputs;
    std::string size;
    std::string crop;
    std::string camera;
    std::string up;
    std::string frames;
    std::string camera_path;
    std::vector<std::string> lights;
    FilmArguments film;
    std::string threads;
    std::string save_every;
    bool go_on = false;
    std::string max_depth;
    std::string integrator = "whitted";
    std::string mode = "auto";
    std::string aov;
    bool no_shadows = false;
    bool no_cutouts = false;
    bool working_set = false;
    BackendArguments backend;
    std::string texture_memory;
    std::string cache;
    std::string stats;
    std::string progress;
    LogArguments log{LogLevel::Info};

    void add_to(CLI::App& app);

private:
    void add_picture_to(CLI::App& app);
    void add_view_to(CLI::App& app);
    void add_light_to(CLI::App& app);
    void add_run_to(CLI::App& app);
};

/// Rays a batch where standard error is a terminal: less than a second's work for the slowest
/// device known, llvmpipe on two cores, so that Ctrl-C is obeyed in time. Elsewhere batches are
/// larger: the time is the same within the noise, but small batches move up to 1.6 times the bytes
/// where the budget is tight.
static constexpr size_t kWatchedBatchRays = size_t(1) << 18;

void RenderWords::add_picture_to(CLI::App& app) {
    app.add_option("-o,--output,--outfile", outputs,
                   "The picture: .png (sRGB) or .exr (linear); may be repeated; #### becomes the "
                   "frame's number; default: out.png, of frames out-####.png")
        ->allow_extra_args(false)
        ->type_name("FILE");
    app.add_option("--size", size,
                   "Pixels, at most 65535 a side; default: what the file asks for, else 512x512")
        ->type_name("WxH");
    app.add_option(
           "--crop", crop,
           "Only a part of the picture: its size, and how far it is from the left and upper "
           "edge")
        ->type_name("WxH+X+Y");
}

void RenderWords::add_view_to(CLI::App& app) {
    app.add_option(
           "--camera", camera,
           "Eye, target and angle of view in degrees along the shorter side (40); not with "
           "--frames or --camera-path; default: the scene's, else the whole scene is framed")
        ->type_name("EX,EY,EZ,TX,TY,TZ[,FOV]");
    app.add_option("--up", up,
                   "The axis that is up, of --camera and of a scene without a camera; default: y; "
                   "many scans and CAD models have z")
        ->type_name(choice_names(kAxes));
    app.add_option("--frames", frames,
                   "Frames of the camera path, or of what moves in the scene: POV-Ray's clock runs "
                   "from 0 in frame A to 1 in frame B; default: one picture, with --camera-path "
                   "all frames")
        ->type_name("A:B[:STEP]");
    app.add_option(
           "--camera-path", camera_path,
           "A path in a file, JSON or CSV, instead of the scene's own (docs/guide/scenes.md)")
        ->type_name("FILE");
    app.add_option("--light", lights, "A point light instead of the scene's; may be repeated")
        ->allow_extra_args(false)
        ->type_name("X,Y,Z");
}

void RenderWords::add_light_to(CLI::App& app) {
    app.add_option("--integrator", integrator,
                   "whitted (mirrors, glass, and the light of lamps) or path (path tracing: light "
                   "from everywhere, with the noise of --samples; docs/guide/path.md)")
        ->type_name(choice_names(kIntegrators));
    app.add_option("--max-depth,--max-trace-level", max_depth,
                   "Reflections and refractions in a row at most, up to 1000; default: what the "
                   "file asks for, else 5. Path tracing: surfaces in a row, 16")
        ->type_name("N");
    app.add_option(
           "--mode", mode,
           "auto, batched (a call of the backend for all rays of a kind and depth) or mixed "
           "(what answers spawn joins the rays under way: fewer passes where memory is "
           "short); the picture is the same")
        ->type_name(choice_names(kModes));
    app.add_option("--aov", aov,
                   "Layers of the .exr files, of what the camera's rays hit, separated by commas: "
                   "depth, normal, albedo (the color of surfaces, for denoisers), id (mesh and "
                   "triangle), leaf (of level 1), passes (that the "
                   "ray took part in), flagged (1 where the kernel was not certain)")
        ->type_name("NAMES");
    app.add_flag("--no-shadows", no_shadows, "Lights shine through everything");
    app.add_option("--texture-memory", texture_memory,
                   "For texels of the scene's pictures, at least 10M; default: 256M "
                   "(docs/guide/textures.md)")
        ->type_name("SIZE");
    app.add_flag("--no-cutouts", no_cutouts, "Surfaces have no holes, whatever their pictures say");
}

void RenderWords::add_run_to(CLI::App& app) {
    app.add_option("--cache", cache,
                   "Keep the scene and what is built of it in this folder, and start from there "
                   "next time; what is stale or damaged is made anew (docs/guide/cache.md)")
        ->type_name("DIR");
    app.add_flag("--continue", go_on,
                 "Go on from what an interrupted run has left: the pixels in NAME.unfinished.film, "
                 "the frames that are there");
    app.add_option("--save-every", save_every,
                   "Under mpirun, the first rank keeps NAME.unfinished.film about so often, in "
                   "case that it ends by force; default: 30")
        ->type_name("SECONDS");
    app.add_option("--threads,--nthreads", threads,
                   "Cores to use at most, of the software renderer too; default: all")
        ->type_name("N");
    app.add_option("--stats", stats, "Write statistics as JSON (docs/reference/stats.md)")
        ->type_name("FILE.json");
    app.add_option("--progress", progress,
                   "Write how it goes as JSON, a line for each event, to a file, a pipe or - for "
                   "standard output, which then has nothing else (docs/guide/film.md)")
        ->type_name("FILE");
    app.add_flag("--working-set", working_set,
                 "The statistics tell which pages each frame's rays go through; takes up to half "
                 "as long again");
}

void RenderWords::add_to(CLI::App& app) {
    scene.add_to(app);
    add_picture_to(app);
    add_view_to(app);
    film.add_to(app);
    add_light_to(app);
    add_run_to(app);
    log.add_to(app, /* with_quiet= */ true);
    backend.add_to(app);
}

/// Parses a crop such as "320x240+100+50".
static Result<Crop> parse_crop(std::string_view option, std::string_view text) {
    const size_t left = std::min(text.find('+'), text.size());
    const size_t top = std::min(text.find('+', left + 1), text.size());
    if (top == text.size())
        return Error{fmt::format("{} needs WIDTHxHEIGHT+X+Y, such as 320x240+100+50, not '{}'",
                                 option, text)};
    const Result<ImageSize> size = parse_size(option, text.substr(0, left));
    if (!size)
        return size.error();
    const Result<uint64_t> x = parse_count(fmt::format("X in {}", option),
                                           text.substr(left + 1, top - left - 1), 0, 65534);
    if (!x)
        return x.error();
    const Result<uint64_t> y =
        parse_count(fmt::format("Y in {}", option), text.substr(top + 1), 0, 65534);
    if (!y)
        return y.error();
    return Crop{uint32_t(*x), uint32_t(*y), *size};
}

/// A camera path, and its name in error messages.
struct NamedPath {
    CameraPath cameras;
    std::string name;
};

/// Returns a path without cameras where the scene may move before its own.
static Result<NamedPath> choose_path(const RenderWords& words) {
    const std::string scene = words.scene.name();
    const bool from_file = !words.camera_path.empty();
    if (!from_file && words.scene.may_move())
        return NamedPath{{}, "a scene that moves"};
    if (!from_file && !is_test_scene(scene))
        return Error{fmt::format("--frames: '{}' has no camera path, and nothing in it moves; "
                                 "--camera-path gives it one",
                                 scene)};
    Result<CameraPath> path =
        from_file ? load_camera_path(words.camera_path) : test_scene_path(scene);
    if (!path)
        return path.error();
    return NamedPath{std::move(*path), from_file ? "'" + words.camera_path + "'" : scene};
}

/// Returns the shots that --frames and --camera-path ask for; none for a single picture.
static Result<std::vector<Shot>> understand_frames(const RenderWords& words) {
    std::vector<Shot> shots;
    if (words.frames.empty() && words.camera_path.empty())
        return shots;
    const bool has_cameras = !words.camera_path.empty() || !words.scene.may_move();
    // CLI11's excludes() would list the two in the help in an order that changes from run to run.
    if (has_cameras && !words.camera.empty())
        return Error{fmt::format("--camera and {} cannot be given together",
                                 words.frames.empty() ? "--camera-path" : "--frames")};
    const Result<NamedPath> path = choose_path(words);
    if (!path)
        return path.error();
    const uint32_t frames = has_cameras ? uint32_t(path->cameras.size()) : kMaxFrames;
    FrameRange range{0, frames - 1, 1};
    if (!words.frames.empty()) {
        const Result<FrameRange> asked = parse_frames(words.frames, frames, path->name);
        if (!asked)
            return asked.error();
        range = *asked;
    }
    for (uint32_t i = 0; i < range.count(); ++i) {
        const uint32_t frame = range.first + i * range.step;
        shots.push_back({frame, has_cameras ? std::optional(path->cameras[frame]) : std::nullopt,
                         Moment::of_frame(frame, range.first, range.last)});
    }
    return shots;
}

/// Refuses to write a file that is also read, or two files by one name.
static Result<Done> check_files(const RenderWords& words, const RenderJob& job,
                                std::optional<uint32_t> frame) {
    std::vector<NamedFile> files = job.scene.files();
    if (!words.camera_path.empty())
        files.push_back({"camera path", words.camera_path});
    for (const std::string& output : job.outputs)
        files.push_back({"output", frame ? frame_file(output, *frame) : output});
    if (!job.stats.empty())
        files.push_back({"statistics", job.stats});
    if (!job.progress.empty() && job.progress != "-")
        files.push_back({"progress", job.progress});
    return check_distinct(files);
}

static Result<Done> check_outputs(const RenderWords& words, const RenderJob& job) {
    for (const std::string& output : job.outputs) {
        if (job.shots.size() > 1 && !has_frame_number(output))
            return Error{fmt::format("the output file '{}' has no place for the number of each of "
                                     "{} frames, such as the #### in out-####.png",
                                     output, job.shots.size())};
        const std::string first =
            job.shots.empty() ? output : frame_file(output, job.shots[0].frame);
        if (const Result<Done> fine = check_image_output(first); !fine)
            return fine.error();
    }
    if (!job.stats.empty())
        if (const Result<Done> fine = check_writable("statistics", job.stats); !fine)
            return fine.error();
    if (job.shots.empty())
        return check_files(words, job, std::nullopt);
    for (const Shot& shot : job.shots)
        if (const Result<Done> fine = check_files(words, job, shot.frame); !fine)
            return fine.error();
    return Done{};
}

static Result<Done> understand_view(const RenderWords& words, RenderJob& job) {
    OptionReader options;
    options.read("--size", words.size, job.size, parse_size);
    options.read("--crop", words.crop, job.crop, parse_crop);
    options.read("--camera", words.camera, job.camera, parse_camera);
    options.choice("--up", words.up, kAxes, job.up);
    if (!options.done())
        return options.done();
    if (job.up && !job.shots.empty() && job.shots[0].camera)
        return Error{"--up and a camera path cannot be given together: its cameras say what is up"};
    for (const std::string& light : words.lights) {
        const Result<dvec3> position = parse_position("--light", light);
        if (!position)
            return position.error();
        job.lights.push_back({*position, kDefaultLightColor});
    }
    return Done{};
}

static Result<Done> understand_saving(const RenderWords& words, RenderJob& job) {
    OptionReader options;
    options.real("--save-every", words.save_every, 0, 1e6, job.render.keep_seconds);
    return options.done() ? check_ranks("--save-every", words.save_every) : options.done();
}

static Result<Done> understand_shading(const RenderWords& words, RenderJob& job) {
    OptionReader options;
    options.count("--threads", words.threads, 1, kMaxThreads, job.threads);
    options.count("--max-depth", words.max_depth, 0, kMaxDepth, job.max_depth);
    options.choice("--mode", words.mode, kModes, job.render.mode);
    options.choice("--integrator", words.integrator, kIntegrators, job.render.integrator);
    options.read("--texture-memory", words.texture_memory, job.texture_memory, parse_bytes);
    if (!options.done())
        return options.done();
    job.render.shadows = !words.no_shadows;
    job.render.cutouts = !words.no_cutouts;
    if (isatty(STDERR_FILENO))
        job.render.batch_rays = kWatchedBatchRays;
    return words.film.resolve(job);
}

static Result<Done> understand_aovs(const RenderWords& words, RenderJob& job) {
    if (words.aov.empty())
        return Done{};
    const Result<Aovs> aovs = parse_aovs(words.aov);
    if (!aovs)
        return aovs.error();
    job.aovs = *aovs;
    for (const std::string& output : job.outputs)
        if (takes_layers(output))
            return Done{};
    return Error{"--aov needs an output that holds layers: -o FILE.exr"};
}

/// Turns the words into a job. It finds every error that can be found before the scene is read; of
/// the inputs it reads a camera path alone.
static Result<RenderJob> understand(const RenderWords& words) {
    RenderJob job;
    job.scene = words.scene;
    job.cache = words.cache;
    job.stats = words.stats;
    job.progress = words.progress;
    job.quiet = words.log.quiet() || words.progress == "-";
    const Result<LogLevel> level = words.log.resolve();
    if (!level)
        return level.error();
    job.log_level = *level;
    job.go_on = words.go_on;
    if (const Result<Done> fine = words.scene.check(); !fine)
        return fine.error();
    if (std::error_code ec; fs::exists(words.cache, ec) && !fs::is_directory(words.cache, ec))
        return Error{fmt::format("--cache: '{}' is no folder", words.cache)};
    Result<std::vector<Shot>> shots = understand_frames(words);
    if (!shots)
        return shots.error();
    job.shots = std::move(*shots);
    if (!job.shots.empty())
        job.scene.moment = job.shots[0].moment;
    job.outputs = words.outputs;
    if (job.outputs.empty())
        job.outputs = {job.shots.empty() ? "out.png" : "out-####.png"};
    if (const Result<Done> fine = check_outputs(words, job); !fine)
        return fine.error();
    if (const Result<Done> fine = understand_view(words, job); !fine)
        return fine.error();
    if (const Result<Done> fine = understand_shading(words, job); !fine)
        return fine.error();
    if (const Result<Done> fine = understand_aovs(words, job); !fine)
        return fine.error();
    const Result<BackendOptions> backend = words.backend.resolve();
    if (!backend)
        return backend.error();
    job.backend = *backend;
    job.scene.host_bytes = job.backend.host_bytes;
    if (const Result<Done> fine = understand_saving(words, job); !fine)
        return fine.error();
    if (words.working_set && job.stats.empty())
        return Error{"--working-set is told in the statistics: --stats FILE.json"};
    if (words.working_set && structure_of(job.backend.kind) != OVC_STRUCTURE_TWO_LEVEL)
        return Error{"--working-set can be told by --backend two-level alone"};
    job.backend.tell_active = words.working_set;
    return job;
}

/// Makes this process one of several where mpirun has started them. The first one speaks for all.
static Result<Done> join_ranks(RenderJob& job) {
    if (const Result<Done> done = join_ranks("render", job.backend, job.scene); !done)
        return done;
    job.render.ranks = Ranks::of_run();
    if (job.render.ranks && !job.render.ranks->is_first()) {
        job.quiet = true;
        job.log_level = LogLevel::Error;
    }
    return Done{};
}

namespace {

class Render final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Renders a picture of a scene: shadows, mirrors and glass, or all light "
                        "there is by path tracing.");
        words_.add_to(app);
        app.footer(kRenderExamples);
    }

    Result<Arguments> in_our_words(const Arguments& arguments) override {
        command_line_ = fmt::format("overcast render {}", fmt::join(arguments, " "));
        const bool quiet = std::any_of(arguments.begin(), arguments.end(), [](const auto& word) {
            return word == "--quiet" || word == "-q";
        });
        return translate_pov_words(arguments,
                                   standard_error_log(quiet ? LogLevel::Warning : LogLevel::Info));
    }

    Result<int> run() override {
        Result<RenderJob> job = understand(words_);
        if (!job)
            return job.error();
        job->command_line = command_line_;
        if (const Result<Done> done = join_ranks(*job); !done)
            return done.error();
        return render(*job);
    }

private:
    RenderWords words_;
    std::string command_line_;
};

} // namespace

std::unique_ptr<Subcommand> make_render() {
    return std::make_unique<Render>();
}

} // namespace ovc
