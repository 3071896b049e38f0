// SPDX-License-Identifier: Apache-2.0
// Chooses the integrator and the form of rendering, runs them, and measures the times.
#include "host/render/render.h"

#include "core/system/stopwatch.h"
#include "host/camera/camera_rays.h"
#include "host/ranks/shared_film.h"
#include "host/render/radiosity.h"
#include "host/render/render_batched.h"
#include "host/render/render_mixed.h"
#include "host/shade/path_tracer.h"
#include "host/shade/whitted.h"

#include <sys/resource.h>

#include <algorithm>
#include <cassert>
#include <memory>

namespace ovc {

void RayCounts::count(RayKind kind) {
    switch (kind) {
    case RayKind::Camera:
        ++primary;
        break;
    case RayKind::Reflection:
        ++reflection;
        break;
    case RayKind::Refraction:
        ++refraction;
        break;
    case RayKind::Bounce:
        ++bounce;
        break;
    }
}

RayCounts& RayCounts::operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflection += other.reflection;
    refraction += other.refraction;
    bounce += other.bounce;
    return *this;
}

RenderReport& RenderReport::operator+=(const RenderReport& other) {
    rays += other.rays;
    seconds += other.seconds;
    seconds_trace += other.seconds_trace;
    seconds_shade += other.seconds_shade;
    seconds_cpu += other.seconds_cpu;
    pixels_done += other.pixels_done;
    failed = failed || other.failed;
    return *this;
}

/// Returns the CPU time of all threads, in user and in system mode.
static double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

static std::unique_ptr<Integrator> make_integrator(const Scene& scene, const Camera& camera,
                                                   const RenderOptions& options,
                                                   const BouncedLight* bounced) {
    const vec3 up(glm::normalize(camera.up));
    if (options.integrator == IntegratorKind::Path)
        return std::make_unique<PathTracer>(
            scene, up, PathTracerOptions{options.max_depth, options.shadows, options.seed});
    return std::make_unique<Whitted>(scene, up, options.max_depth, options.shadows, bounced);
}

namespace {

/// The passes of adaptive antialiasing. Each renders onto a film of its own, with a pixel for each
/// point.
class AdaptivePasses {
public:
    /// trace: renders rays through the points onto a film that has a pixel for each.
    using Trace = std::function<Result<RenderReport>(std::span<const dvec2> points,
                                                     const RenderObserver&, Film&)>;

    AdaptivePasses(const Pinhole& pinhole, const RenderObserver& observe, Trace trace)
        : pixels_(uint64_t(pinhole.width()) * pinhole.height()),
          observe_(observe),
          trace_(std::move(trace)) {}

    /// Fills the film, unless it was stopped. The film has one sample a pixel.
    Result<RenderReport> run(const Antialias& how, double gamma, Film& film) {
        assert(film.samples() == 1);
        const ImageSize size{film.width(), film.height()};
        const auto colors = antialiased(
            size, how, gamma, [&](auto points, auto light) { return pass(points, light); });
        if (error_)
            return *error_;
        for (uint32_t pixel = 0; colors && pixel < colors->size(); ++pixel) {
            film.add(pixel, (*colors)[pixel]);
            film.close(pixel);
        }
        report_.complete = colors.has_value();
        return report_;
    }

private:
    bool pass(std::span<const dvec2> points, std::span<vec3> light) {
        Film film(uint32_t(points.size()), 1);
        const RenderReport before = report_;
        // Points count as pixels here, since most pictures take little more than one a pixel.
        const RenderObserver observe = [&](const RenderReport& now) {
            RenderReport all = before;
            all += now;
            all.pixels_done = std::min(all.pixels_done, pixels_);
            return !observe_ || observe_(all);
        };
        const Result<RenderReport> done = trace_(points, observe, film);
        if (!done) {
            error_ = done.error();
            return false;
        }
        report_ += *done;
        const Image image = film.image();
        for (size_t i = 0; i < light.size(); ++i)
            light[i] = vec3(image.pixels[i]);
        return done->complete;
    }

    const uint64_t pixels_;
    const RenderObserver& observe_;
    const Trace trace_;
    std::optional<Error> error_;
    RenderReport report_;
};

} // namespace

Result<RenderReport> render_picture(const Scene& scene, const Camera& camera, Backend& backend,
                                    const RenderOptions& options, const RenderObserver& observe,
                                    Film& film) {
    const Stopwatch watch;
    const double cpu_before = cpu_seconds();
    const ImageSize whole{film.width(), film.height()};
    const Pinhole pinhole(camera, options.part.value_or(PicturePart{whole, 0, 0, whole}), &scene);
    const Sight sight(scene, options.cutouts);
    // Path tracing finds this light by itself. Ranks whose pieces of the picture ask together
    // cannot ask for it alone.
    const bool gathers = options.integrator == IntegratorKind::Whitted && !options.ranks;
    Result<std::shared_ptr<const BouncedLight>> bounced = std::shared_ptr<const BouncedLight>();
    if (gathers)
        bounced = gather_bounced_light(scene, pinhole, sight, backend,
                                       {options.max_depth, options.shadows});
    if (!bounced)
        return bounced.error();
    const std::unique_ptr<Integrator> integrator =
        make_integrator(scene, camera, options, bounced->get());
    const size_t lights = scene.lights.size();
    const bool waits_for_ranks = options.ranks && backend.statistics().ranks > 1;
    const auto trace = [&](const CameraRays& rays, const RenderObserver& watch_it, Film& to) {
        return options.mode == RenderMode::Mixed
                   ? render_mixed(*integrator, lights, rays, sight, backend, watch_it, to)
                   : render_batched(*integrator, lights, rays, sight, backend, options.batch_rays,
                                    watch_it, to, waits_for_ranks);
    };
    // Ranks share out the pixels of a film; else all of them are this process's.
    const uint32_t rays_per_sample = // a guess
        options.integrator == IntegratorKind::Path ? std::clamp(options.max_depth, 1u, 8u) : 1;
    const auto first_ranks = [&](std::span<const dvec2> points) {
        return [&backend, &pinhole, points](std::span<const uint32_t> pixels) {
            std::vector<Ray> rays;
            for (const uint32_t pixel : pixels)
                rays.push_back(points.empty()
                                   ? pinhole.ray(pixel % pinhole.width(), pixel / pinhole.width())
                                   : ray_through(pinhole, points[pixel]));
            return backend.first_ranks(rays);
        };
    };
    const auto render = [&](Film& to, SharedFilmOptions shared, const RenderObserver& watch_it,
                            std::span<const dvec2> points) {
        if (!options.ranks)
            return trace(points.empty() ? CameraRays(pinhole, to) : CameraRays(pinhole, to, points),
                         watch_it, to);
        shared.rays_per_sample = rays_per_sample;
        shared.first_ranks = first_ranks(points);
        const RenderPart part = [&](const RenderObserver& watch_part,
                                    std::vector<uint32_t> pixels) {
            return trace(CameraRays(pinhole, to.samples(), std::move(pixels), points), watch_part,
                         to);
        };
        return render_shared(*options.ranks, to, shared, part, watch_it);
    };
    const auto render_points = [&](std::span<const dvec2> points, const RenderObserver& watch_it,
                                   Film& to) {
        return points.empty() ? RenderReport{.complete = true}
                              : render(to, {.to_all = true}, watch_it, points);
    };
    const bool is_adaptive = options.antialias && film.pixels_done() == 0;
    Result<RenderReport> report =
        is_adaptive ? AdaptivePasses(pinhole, observe, render_points)
                          .run(*options.antialias, scene.gamma, film)
                    : render(film, {.keep = options.keep, .keep_seconds = options.keep_seconds},
                             observe, {});
    if (!report)
        return report;
    report->pixels_done = film.pixels_done();
    report->seconds = watch.seconds();
    report->seconds_cpu = cpu_seconds() - cpu_before;
    return report;
}

} // namespace ovc
