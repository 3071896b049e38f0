// SPDX-License-Identifier: Apache-2.0
// overcast render: a scene in, pictures and statistics out.
#include "host/arguments.h"
#include "host/backend_arguments.h"
#include "host/camera.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/memory_size.h"
#include "host/output.h"
#include "host/progress.h"
#include "host/scene_source.h"
#include "host/scene_summary.h"
#include "host/stats.h"
#include "host/stopwatch.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace ovc {

static constexpr const char* kExamples = R"(Examples:
  overcast render dragon.ply
      writes out.png, 512x512; camera and light are placed by themselves
  overcast render dragon.ply -o d.png -o d.exr --size 1920x1080 --gpu-memory 12M
      two files, and no more than 12 MiB of GPU memory
  overcast render kitchen.obj --camera 3,1.6,4,0,1,0,60 --light 0,2.4,0 --light 2,2.4,2
      from a point of view, 60 degrees wide, with two lights
  overcast render plants --stats plants.json --quiet
      a generated scene, with statistics for a program
  overcast render dragon.ply +W640 +H480 +Od.png
      POV-Ray's words are understood

Interrupted with Ctrl-C, it saves what it has and exits with 2.)";

/// The words as given.
struct RenderWords {
    std::string scene;
    std::vector<std::string> outputs;
    std::string size = "512x512";
    std::string camera;
    std::vector<std::string> lights;
    std::string max_depth = "5";
    bool no_shadows = false;
    BackendArguments backend;
    std::string stats;
    bool quiet = false;

    void add_to(CLI::App& app);
};

/// Rays a batch while somebody watches: less than a second's work for the slowest device known,
/// llvmpipe on two cores, so that Ctrl-C is obeyed in time. Elsewhere batches are larger: time is
/// the same within the noise, but where the budget is tight these move up to 1.6 times the bytes.
static constexpr size_t kWatchedBatchRays = size_t(1) << 18;

/// What they mean.
struct RenderJob {
    std::string scene;
    std::vector<std::string> outputs;
    ImageSize size;
    std::optional<Camera> camera;
    std::vector<PointLight> lights;
    WhittedOptions whitted;
    BackendOptions backend;
    std::string stats;
    bool quiet = false;
};

void RenderWords::add_to(CLI::App& app) {
    app.add_option("SCENE", scene,
                   "A file (.ply .obj, also .gz, or what Assimp reads) or a test scene's name")
        ->required();
    app.add_option("-o,--output,--outfile", outputs,
                   "The picture: .png (sRGB) or .exr (linear); may be repeated; default: out.png")
        ->allow_extra_args(false)
        ->type_name("FILE");
    app.add_option("--size", size, "Pixels, at most 65535 a side; default: 512x512")
        ->type_name("WxH");
    app.add_option("--camera", camera,
                   "Eye, target and angle of view in degrees along the shorter side (40); default: "
                   "the scene's, else the whole scene is framed")
        ->type_name("EX,EY,EZ,TX,TY,TZ[,FOV]");
    app.add_option("--light", lights, "A point light instead of the scene's; may be repeated")
        ->allow_extra_args(false)
        ->type_name("X,Y,Z");
    app.add_option("--max-depth,--max-trace-level", max_depth,
                   "Reflections and refractions in a row at most, up to 1000; default: 5")
        ->type_name("N");
    app.add_flag("--no-shadows", no_shadows, "Lights shine through everything");
    app.add_option("--stats", stats, "Write statistics as JSON (docs/stats.md)")
        ->type_name("FILE.json");
    app.add_flag("--quiet", quiet, "Print nothing but warnings and errors");
    backend.add_to(app);
}

/// No file is written that is read or written besides.
static Result<Done> check_files(const RenderJob& job) {
    std::vector<NamedFile> files;
    if (!is_test_scene(job.scene))
        files.push_back({"input", job.scene});
    for (const std::string& output : job.outputs)
        files.push_back({"output", output});
    if (!job.stats.empty())
        files.push_back({"statistics", job.stats});
    return check_distinct(files);
}

/// Everything that can be wrong before anything is read.
static Result<RenderJob> understand(const RenderWords& words) {
    RenderJob job;
    job.scene = words.scene;
    job.outputs = words.outputs.empty() ? std::vector<std::string>{"out.png"} : words.outputs;
    job.stats = words.stats;
    job.quiet = words.quiet;
    for (const std::string& output : job.outputs)
        if (const Result<Done> fine = check_image_output(output); !fine)
            return fine.error();
    if (!job.stats.empty())
        if (const Result<Done> fine = check_writable("statistics", job.stats); !fine)
            return fine.error();
    if (const Result<Done> fine = check_files(job); !fine)
        return fine.error();
    const Result<ImageSize> size = parse_size(words.size);
    if (!size)
        return size.error();
    job.size = *size;
    if (!words.camera.empty()) {
        const Result<Camera> camera = parse_camera(words.camera);
        if (!camera)
            return camera.error();
        job.camera = *camera;
    }
    for (const std::string& light : words.lights) {
        const Result<dvec3> position = parse_position("--light", light);
        if (!position)
            return position.error();
        job.lights.push_back({*position, kDefaultLightColor});
    }
    const Result<uint64_t> depth = parse_count("--max-depth", words.max_depth, 0, 1000);
    if (!depth)
        return depth.error();
    job.whitted.max_depth = uint32_t(*depth);
    job.whitted.shadows = !words.no_shadows;
    if (isatty(STDERR_FILENO))
        job.whitted.batch_rays = kWatchedBatchRays;
    const Result<BackendOptions> backend = words.backend.resolve();
    if (!backend)
        return backend.error();
    job.backend = *backend;
    return job;
}

/// Gives the scene the camera and the lights that were asked for, or those it lacks. A file's
/// camera is not checked yet.
static Camera dress(Scene& scene, const RenderJob& job) {
    Camera camera;
    if (job.camera) {
        camera = *job.camera;
        if (scene.camera)
            camera.up = scene.camera->up;
    } else if (scene.camera) {
        camera = *scene.camera;
    } else {
        camera = framing_camera(hittable_bounds(scene.soup), job.size.width, job.size.height);
    }
    if (!job.lights.empty())
        scene.lights = job.lights;
    if (scene.lights.empty())
        scene.lights.push_back(shoulder_light(camera));
    return camera;
}

static Result<Done> save_all(const RenderJob& job, const Image& image, RenderStats& stats,
                             const Stopwatch& total) {
    const Stopwatch watch;
    for (const std::string& output : job.outputs)
        if (const Result<Done> saved = save_image(image, output); !saved)
            return saved;
    stats.seconds_output = watch.seconds();
    stats.seconds_total = total.seconds();
    return job.stats.empty() ? Result<Done>(Done{}) : save_text(stats_json(stats), job.stats);
}

static Result<int> render(const RenderJob& job) {
    const Stopwatch total;
    const LogSink log = standard_error_log(/* chatty= */ !job.quiet);
    RenderStats stats;
    Result<Scene> scene = open_scene(job.scene, log);
    if (!scene)
        return scene.error();
    stats.scene = job.scene;
    stats.width = job.size.width;
    stats.height = job.size.height;
    stats.seconds_import = total.seconds();

    const Camera camera = dress(*scene, job);
    if (const Result<Done> fine = check_camera(camera); !fine)
        return Error{fmt::format("{}: {}", job.scene, fine.error().message)};
    const Result<std::unique_ptr<Backend>> backend = make_backend(scene->soup, job.backend, log);
    if (!backend)
        return backend.error();

    Image image(job.size.width, job.size.height);
    const InterruptGuard interrupt;
    {
        Progress progress(**backend, image.pixels.size(), /* shown= */ !job.quiet);
        const auto observe = [&](const RenderReport& report) {
            progress.update(report);
            return !interrupt.interrupted();
        };
        const Result<RenderReport> report =
            render_batched(*scene, camera, **backend, job.whitted, observe, image);
        if (!report)
            return report.error();
        stats.report = *report;
    }
    stats.tracing = (*backend)->statistics();
    stats.renderer = (*backend)->renderer();
    if (const Result<Done> saved = save_all(job, image, stats, total); !saved)
        return saved.error();
    if (!job.quiet)
        fmt::print("{}  wrote      {}\n", stats_summary(stats), fmt::join(job.outputs, ", "));
    if (stats.report.complete)
        return kExitOk;
    fmt::print(stderr, "overcast: interrupted; what was rendered so far is saved\n");
    return kExitInterrupted;
}

Result<int> run_render(const Arguments& arguments) {
    CLI::App app{"Renders a picture of a scene with Whitted's model: shadows, mirrors and glass.",
                 "overcast render"};
    RenderWords words;
    words.add_to(app);
    app.footer(kExamples);
    const Result<Arguments> translated = translate_pov_words(arguments);
    if (!translated)
        return translated.error();
    const Result<Parsed> parsed = parse_arguments(app, *translated);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;
    const Result<RenderJob> job = understand(words);
    if (!job)
        return job.error();
    return render(*job);
}

} // namespace ovc
