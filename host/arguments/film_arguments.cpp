// SPDX-License-Identifier: Apache-2.0
// --samples, --antialias, --filter, --clamp, --lens-radius, --exposure, --tone-map, and the options
// that go with them.
#include "host/arguments/film_arguments.h"

#include "host/arguments/arguments.h"
#include "host/camera/camera.h"
#include "host/job/render_job.h"
#include "host/ranks/ranks.h"

#include <fmt/format.h>

namespace ovc {

/// In the order of Antialias::Method.
static constexpr std::string_view kAntialiasMethods[] = {"1", "2"};
/// In the order of FilterOptions::Kind.
static constexpr std::string_view kFilters[] = {"box", "gaussian", "blackman-harris"};
/// In the order of ToneMap.
static constexpr std::string_view kToneMaps[] = {"none", "filmic", "aces"};
static constexpr std::string_view kPngBits[] = {"8", "16"};
static constexpr double kMaxFilterRadius = 16;
static constexpr double kMaxStops = 100;

void FilmArguments::add_samples_to(CLI::App& app) {
    app.add_option(
           "--samples,--spp", samples_,
           "Rays a pixel, up to 65536: more of them smooth edges; the same ones every time; "
           "default: what the file asks for, else 1, through its middle")
        ->type_name("N");
    app.add_option(
           "--antialias", antialias_,
           "One ray a pixel, and more only where colors differ by this, red, green and blue "
           "together: 0 to 3, POV-Ray's default is 0.3; instead of --samples")
        ->type_name("X");
    app.add_option(
           "--antialias-method", antialias_method_,
           "1: pixels that differ from a neighbour get rays on a grid; 2: pixels that differ "
           "at their corners are quartered again and again; default: 1")
        ->type_name(choice_names(kAntialiasMethods));
    app.add_option(
           "--antialias-depth", antialias_depth_,
           "Of method 1: N x N rays more; of method 2: 2^(N-1) parts a side at most; 1 to 9, "
           "default: 3")
        ->type_name("N");
    app.add_option("--jitter", jitter_,
                   "How far rays of --antialias may lie off their grid, by chance that is the same "
                   "every time: 0 to 1; default: 1")
        ->type_name("X");
    app.add_option("--seed", seed_,
                   "Of path tracing and of a lens: other numbers make other noise, the same the "
                   "same picture; default: 0")
        ->type_name("N");
    app.add_option("--filter", filter_,
                   "How --samples of a pixel are weighed: box (all alike, within the pixel), or "
                   "more in its middle than far away; default: box (docs/guide/film.md)")
        ->type_name(choice_names(kFilters));
    app.add_option("--filter-radius", filter_radius_,
                   "How far the filter reaches, in pixels across and down; default: of box 0.5, of "
                   "others 1.5")
        ->type_name("X");
    app.add_option("--clamp", clamp_,
                   "Path tracing: light that comes by way of other surfaces counts at most so much "
                   "at once, where 1 is white: fewer bright dots, and a little less light; 10 is "
                   "mild, 1 is strong; default: no limit")
        ->type_name("X");
}

void FilmArguments::add_passes_to(CLI::App& app) {
    app.add_option("--time", time_,
                   "Pass after pass, for so long and at least one: the noisiest blocks of pixels "
                   "get the most samples, --samples at most; NAME.unfinished.png shows the picture "
                   "so far (docs/guide/film.md); 90, 90s, 1.5m, 2h")
        ->type_name("SECONDS");
    app.add_option("--noise", noise_,
                   "Pass after pass, until the error of each block of pixels is estimated to be "
                   "this, of displayed colors from 0 to 1: 0.02 is a draft, 0.005 is clean; with "
                   "--time, whichever comes first")
        ->type_name("X");
}

void FilmArguments::add_lens_to(CLI::App& app) {
    app.add_option("--lens-radius", lens_radius_,
                   "Depth of field: the radius of the camera's lens, in the scene's units; needs "
                   "--samples; 0: everything is sharp; default: what the file asks for")
        ->type_name("X");
    app.add_option("--focus", focus_,
                   "The distance at which --lens-radius is sharp; default: the camera's target")
        ->type_name("X");
}

void FilmArguments::add_tones_to(CLI::App& app) {
    app.add_option("--exposure", exposure_,
                   "Stops, each of which doubles the picture's light, or auto, which makes its "
                   "average a middle grey; default: the light as it is")
        ->type_name("auto|EV");
    app.add_option("--tone-map", tone_map_,
                   "Fits bright light into .png files: none (cut off at white), filmic (Hable's "
                   "curve) or aces (Narkowicz's); .exr files keep linear light; default: none")
        ->type_name(choice_names(kToneMaps));
    app.add_flag("--denoise", denoise_,
                 "The finished picture goes through Intel's Open Image Denoise, if that is "
                 "installed (docs/guide/film.md)");
    app.add_flag("--view", view_,
                 "A window shows the picture, with --time or --noise while it is made; it stays "
                 "until it is closed; needs GLFW (Debian: libglfw3)");
    app.add_option("--png-bits", png_bits_, "Bits a channel of .png files; default: 8")
        ->type_name(choice_names(kPngBits));
}

void FilmArguments::add_to(CLI::App& app) {
    add_samples_to(app);
    add_passes_to(app);
    add_lens_to(app);
    add_tones_to(app);
}

Result<Done> FilmArguments::resolve_antialias(RenderJob& job) const {
    Antialias how;
    size_t method = size_t(how.method) - 1;
    OptionReader options;
    options.choice("--antialias-method", antialias_method_, kAntialiasMethods, method);
    options.count("--antialias-depth", antialias_depth_, 1, kMaxAntialiasDepth, how.depth);
    options.real("--jitter", jitter_, 0, 1, how.jitter);
    // POV-Ray's files, too, may have the others without it.
    if (!options.done() || antialias_.empty())
        return options.done();
    if (!samples_.empty())
        return Error{"--samples and --antialias cannot be given together"};
    options.real("--antialias", antialias_, 0, 3, how.threshold);
    how.method = Antialias::Method(method + 1);
    job.render.antialias = how;
    return options.done();
}

Result<Done> FilmArguments::resolve_samples(RenderJob& job) const {
    OptionReader options;
    options.count("--samples", samples_, 1, kMaxSamples, job.samples);
    options.count("--seed", seed_, 0, ~uint64_t(0), job.render.seed);
    options.real("--clamp", clamp_, 1e-6, 1e6, job.render.clamp);
    if (options.done() && !clamp_.empty() && job.render.integrator != IntegratorKind::Path)
        return Error{"--clamp is for --integrator path alone: whitted has no bright dots"};
    return options.done();
}

/// Parses a time such as "90", "90s", "1.5m" or "2h", in seconds.
static Result<double> parse_time(std::string_view option, std::string_view text) {
    const char unit = text.empty() ? '\0' : text.back();
    const double factor = unit == 'm' ? 60 : unit == 'h' ? 3600 : 1;
    const bool has_unit = unit == 's' || unit == 'm' || unit == 'h';
    const Result<double> number =
        parse_real(option, text.substr(0, text.size() - has_unit), 0.001, 1e6);
    if (!number)
        return Error{
            fmt::format("{} needs a time, such as 30s, 1.5m or 2h, not '{}'", option, text)};
    return *number * factor;
}

Result<Done> FilmArguments::resolve_passes(RenderJob& job) const {
    if (time_.empty() && noise_.empty())
        return Done{};
    const char* const option = time_.empty() ? "--noise" : "--time";
    Progressive progressive;
    OptionReader options;
    options.read("--time", time_, progressive.seconds, parse_time);
    options.real("--noise", noise_, 1e-5, 1, progressive.noise);
    if (!options.done())
        return options.done();
    if (job.render.antialias)
        return Error{fmt::format("{} and --antialias cannot be given together", option)};
    if (job.go_on && job.shots.empty()) // of a sequence, the frames that are there stay
        return Error{fmt::format("--continue cannot go on with a picture of {}: without it, the "
                                 "picture is begun anew",
                                 option)};
    if (Ranks::are_there())
        return Error{fmt::format("{} is for one process; under mpirun, give --samples", option)};
    progressive.max_samples = job.samples.value_or(kMaxSamples);
    job.samples = 1; // of the film
    job.render.progressive = progressive;
    return Done{};
}

/// Returns whether pixels get several samples, whose places a filter or a lens can spread.
static bool has_samples(const RenderJob& job) {
    return job.samples.value_or(1) > 1 || job.render.progressive;
}

Result<Done> FilmArguments::resolve_filter(RenderJob& job) const {
    if (filter_.empty() && filter_radius_.empty())
        return Done{};
    FilterOptions filter;
    OptionReader options;
    options.choice("--filter", filter_, kFilters, filter.kind);
    filter.radius = default_radius(filter.kind);
    options.real("--filter-radius", filter_radius_, 0.01, kMaxFilterRadius, filter.radius);
    if (!options.done())
        return options.done();
    if (filter != FilterOptions{} && !has_samples(job))
        return Error{"--filter needs --samples of at least 2: it weighs the rays of a pixel"};
    job.render.filter = filter;
    return Done{};
}

Result<Done> FilmArguments::resolve_lens(RenderJob& job) const {
    if (lens_radius_.empty())
        return focus_.empty() ? Result<Done>(Done{}) : Error{"--focus needs --lens-radius"};
    OptionReader options;
    options.real("--lens-radius", lens_radius_, 0, kFarthest, job.lens_radius);
    options.real("--focus", focus_, 1e-30, kFarthest, job.focus);
    if (options.done() && job.lens_radius > 0 && !has_samples(job))
        return Error{"--lens-radius needs --samples of at least 2: one ray sees no blur"};
    return options.done();
}

Result<Done> FilmArguments::resolve_tones(RenderJob& job) const {
    if (exposure_ == "auto") {
        job.development.exposure = Exposure{.is_automatic = true};
    } else if (!exposure_.empty()) {
        const Result<double> stops = parse_real("--exposure", exposure_, -kMaxStops, kMaxStops);
        if (!stops)
            return Error{stops.error().message + ", or auto"};
        job.development.exposure = Exposure{.stops = *stops};
    }
    if (denoise_) {
        const Result<const Denoiser*> denoiser = Denoiser::load();
        if (!denoiser)
            return denoiser.error();
        job.denoiser = *denoiser;
    }
    if (view_ && Ranks::are_there())
        return Error{"--view is for one process, and not for mpirun"};
    job.view = view_;
    if (job.render.progressive)
        job.render.progressive->exposure = job.development.exposure;
    size_t bits = 0;
    OptionReader options;
    options.choice("--tone-map", tone_map_, kToneMaps, job.development.tone_map);
    options.choice("--png-bits", png_bits_, kPngBits, bits);
    job.png_bits = bits == 0 ? 8 : 16;
    return options.done();
}

Result<Done> FilmArguments::resolve(RenderJob& job) const {
    for (const auto part : {&FilmArguments::resolve_antialias, &FilmArguments::resolve_samples,
                            &FilmArguments::resolve_passes, &FilmArguments::resolve_filter,
                            &FilmArguments::resolve_lens, &FilmArguments::resolve_tones})
        if (const Result<Done> fine = (this->*part)(job); !fine)
            return fine;
    return Done{};
}

} // namespace ovc
