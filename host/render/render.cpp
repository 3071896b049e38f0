// SPDX-License-Identifier: Apache-2.0
// Chooses the integrator and the form of rendering, runs them, and measures the times.
#include "host/render/render.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/camera/camera_rays.h"
#include "host/ranks/shared_film.h"
#include "host/render/progressive.h"
#include "host/render/radiosity.h"
#include "host/render/render_batched.h"
#include "host/render/render_mixed.h"
#include "host/shade/path_tracer.h"
#include "host/shade/whitted.h"
#include "host/terminal/process_cost.h"

#include <algorithm>
#include <cassert>
#include <memory>

namespace ovc {

static constexpr size_t kPixelGrain = 4096; // pixels a task

/// Makes another seed, whose random numbers have nothing to do with those of the first.
static constexpr uint64_t kOtherRandomNumbers = 0x9e3779b97f4a7c15u;

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

/// part: that the film is. seed: of path tracing, instead of that of the options. bounced: null, or
/// outlives the integrator.
static std::unique_ptr<Integrator> make_integrator(const Scene& scene, const Camera& camera,
                                                   const RenderOptions& options,
                                                   const PicturePart& part, uint64_t seed,
                                                   const BouncedLight* bounced) {
    const vec3 up(glm::normalize(camera.up));
    if (options.integrator == IntegratorKind::Path)
        return std::make_unique<PathTracer>(scene, up,
                                            PathTracerOptions{.max_depth = options.max_depth,
                                                              .shadows = options.shadows,
                                                              .cutouts = options.cutouts,
                                                              .seed = seed,
                                                              .part = part,
                                                              .clamp = options.clamp});
    return std::make_unique<Whitted>(scene, up,
                                     WhittedOptions{.max_depth = options.max_depth,
                                                    .shadows = options.shadows,
                                                    .eye = camera.eye,
                                                    .bounced = bounced});
}

namespace {

/// Traces the camera rays of one picture, onto its film or others.
class Tracing {
public:
    Tracing(const Scene& scene, const Camera& camera, Backend& backend,
            const RenderOptions& options, const Film& film)
        : scene_(scene),
          camera_(camera),
          backend_(backend),
          options_(options),
          pinhole_(camera, options.part.value_or(whole(film)), &scene),
          sight_(scene, options.cutouts),
          sampling_{.filter = options.filter, .seed = options.seed} {}

    const Pinhole& pinhole() const { return pinhole_; }

    /// Comes before all else.
    Result<Done> prepare() {
        // Path tracing finds this light by itself. Ranks whose pieces of the picture ask together
        // cannot ask for it alone.
        if (options_.integrator == IntegratorKind::Whitted && !options_.ranks) {
            auto bounced = gather_bounced_light(scene_, pinhole_, sight_, backend_,
                                                {options_.max_depth, options_.shadows});
            if (!bounced)
                return bounced.error();
            bounced_ = std::move(*bounced);
        }
        integrator_ = make_integrator(scene_, camera_, options_, pinhole_.part(), options_.seed,
                                      bounced_.get());
        return Done{};
    }

    /// Renders rays through pixels, or through the points if there are any. Ranks share out the
    /// pixels of a film; else all of them are this process's.
    Result<RenderReport> render(Film& film, SharedFilmOptions shared, const RenderObserver& observe,
                                std::span<const dvec2> points = {}) {
        if (!options_.ranks)
            return trace(*integrator_,
                         points.empty() ? CameraRays(pinhole_, film, sampling_)
                                        : CameraRays(pinhole_, film, points),
                         observe, film);
        shared.rays_per_sample = // a guess
            options_.integrator == IntegratorKind::Path ? std::clamp(options_.max_depth, 1u, 8u)
                                                        : 1;
        shared.first_ranks = [&](std::span<const uint32_t> pixels) {
            return first_ranks(pixels, points);
        };
        const RenderPart part = [&](const RenderObserver& watch, std::vector<uint32_t> pixels) {
            return trace(*integrator_,
                         CameraRays(pinhole_, film.samples(), std::move(pixels), points, sampling_),
                         watch, film);
        };
        return render_shared(*options_.ranks, film, shared, part, observe);
    }

    /// Returns what is done where no rank has a ray to trace any more.
    std::function<void()> after_last_ray() const {
        return options_.purges ? std::function<void()>([this] { backend_.purge(); }) : nullptr;
    }

    /// Renders a pass of progressive rendering.
    Result<RenderReport> render(const Pass& pass, const RenderObserver& observe, Film& film) {
        CameraSampling sampling = sampling_;
        sampling.random_places = true;
        sampling.first_sample = pass.first_sample;
        if (pass.for_estimate) {
            sampling.seed ^= kOtherRandomNumbers;
            if (!for_estimate_)
                for_estimate_ = make_integrator(scene_, camera_, options_, pinhole_.part(),
                                                sampling.seed, bounced_.get());
        }
        return trace(pass.for_estimate ? *for_estimate_ : *integrator_,
                     CameraRays(pinhole_, pass.samples, pass.pixels, {}, sampling), observe, film);
    }

private:
    static PicturePart whole(const Film& film) {
        const ImageSize size{film.width(), film.height()};
        return {size, 0, 0, size};
    }

    Result<RenderReport> trace(const Integrator& integrator, const CameraRays& rays,
                               const RenderObserver& observe, Film& film) {
        const RenderTask task{integrator, rays, sight_, observe, film};
        // Where rays visit other ranks, a batch would wait at its end for its last answers.
        const bool as_stream = options_.mode == RenderMode::Mixed ||
                               (options_.ranks && backend_.statistics().ranks > 1);
        return as_stream ? render_mixed(task, backend_)
                         : render_batched(task, backend_, options_.batch_rays);
    }

    std::vector<uint32_t> first_ranks(std::span<const uint32_t> pixels,
                                      std::span<const dvec2> points) const {
        std::vector<Ray> rays;
        for (const uint32_t pixel : pixels)
            rays.push_back(points.empty()
                               ? pinhole_.ray(pixel % pinhole_.width(), pixel / pinhole_.width())
                               : ray_through(pinhole_, points[pixel]));
        return backend_.first_ranks(rays);
    }

    const Scene& scene_;
    const Camera& camera_;
    Backend& backend_;
    const RenderOptions& options_;
    const Pinhole pinhole_;
    const Sight sight_;
    const CameraSampling sampling_;
    std::shared_ptr<const BouncedLight> bounced_; // null: nothing asks for it
    std::unique_ptr<Integrator> integrator_;
    std::unique_ptr<Integrator> for_estimate_; // with other random numbers
};

/// The passes of adaptive antialiasing.
class AdaptivePasses : public SampleTracer {
public:
    AdaptivePasses(Tracing& tracing, const RenderObserver& observe)
        : tracing_(tracing),
          pixels_(uint64_t(tracing.pinhole().width()) * tracing.pinhole().height()),
          observe_(observe) {}

    /// Fills the film, unless it was stopped.
    Result<RenderReport> run(const Antialias& how, double gamma, Film& film) {
        report_.complete = antialias(how, gamma, *this, film);
        if (error_)
            return *error_;
        return report_;
    }

private:
    bool trace_middles(Film& film) override { return pass(film, {}); }

    bool trace_points(std::span<const dvec2> points, std::span<vec3> light) override {
        if (points.empty())
            return true;
        Film film(uint32_t(light.size()), 1, uint32_t(points.size() / light.size()));
        const bool goes_on = pass(film, points);
        parallel_for(light.size(), kPixelGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                light[i] = vec3(film.mean(uint32_t(i)));
        });
        return goes_on;
    }

    bool pass(Film& film, std::span<const dvec2> points) {
        const RenderReport before = report_;
        // Points count as pixels here, since most pictures take little more than one a pixel.
        const RenderObserver observe = [&](const RenderReport& now) {
            RenderReport all = before;
            all += now;
            all.pixels_done = std::min(all.pixels_done, pixels_);
            return !observe_ || observe_(all);
        };
        const Result<RenderReport> done = tracing_.render(film, {.to_all = true}, observe, points);
        if (!done) {
            error_ = done.error();
            return false;
        }
        report_ += *done;
        return done->complete;
    }

    Tracing& tracing_;
    const uint64_t pixels_;
    const RenderObserver& observe_;
    std::optional<Error> error_;
    RenderReport report_;
};

} // namespace

static Result<RenderReport> render_by(Tracing& tracing, const RenderOptions& options, double gamma,
                                      const RenderObserver& observe, Film& film) {
    if (options.progressive)
        return render_progressively(
            *options.progressive, gamma,
            [&](const Pass& pass, const RenderObserver& watch, Film& to) {
                return tracing.render(pass, watch, to);
            },
            observe, film);
    if (!options.antialias || film.pixels_done() > 0)
        return tracing.render(film,
                              {.traced = tracing.after_last_ray(),
                               .keep = options.keep,
                               .keep_seconds = options.keep_seconds},
                              observe);
    return AdaptivePasses(tracing, observe).run(*options.antialias, gamma, film);
}

Result<RenderReport> render_picture(const Scene& scene, const Camera& camera, Backend& backend,
                                    const RenderOptions& options, const RenderObserver& observe,
                                    Film& film) {
    const Stopwatch watch;
    const double cpu_before = process_cpu_seconds();
    Tracing tracing(scene, camera, backend, options, film);
    if (const Result<Done> prepared = tracing.prepare(); !prepared)
        return prepared.error();
    Result<RenderReport> report = render_by(tracing, options, scene.gamma, observe, film);
    if (!report)
        return report;
    report->pixels_done = film.pixels_done();
    report->seconds = watch.seconds();
    report->seconds_cpu = process_cpu_seconds() - cpu_before;
    return report;
}

} // namespace ovc
