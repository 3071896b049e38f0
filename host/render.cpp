// SPDX-License-Identifier: Apache-2.0
// A picture: who shades, who traces, and what it took.
#include "host/render.h"

#include "core/stopwatch.h"
#include "host/camera_rays.h"
#include "host/path_tracer.h"
#include "host/render_batched.h"
#include "host/render_mixed.h"
#include "host/whitted.h"

#include <sys/resource.h>

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
    return *this;
}

/// Of all threads, in the program and in the system for it.
static double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

static std::unique_ptr<Integrator> make_integrator(const Scene& scene, const Camera& camera,
                                                   const RenderOptions& options) {
    const vec3 up(glm::normalize(camera.up));
    if (options.integrator == IntegratorKind::Path)
        return std::make_unique<PathTracer>(
            scene, up, PathTracerOptions{options.max_depth, options.shadows, options.seed});
    return std::make_unique<Whitted>(scene, up, options.max_depth, options.shadows);
}

Result<RenderReport> render_picture(const Scene& scene, const Camera& camera, Backend& backend,
                                    const RenderOptions& options, const RenderObserver& observe,
                                    Film& film) {
    const Stopwatch watch;
    const double cpu_before = cpu_seconds();
    const ImageSize whole{film.width(), film.height()};
    const Pinhole pinhole(camera, options.part.value_or(PicturePart{whole, 0, 0, whole}));
    const CameraRays rays(pinhole, film);
    const std::unique_ptr<Integrator> integrator = make_integrator(scene, camera, options);
    Result<RenderReport> report =
        options.mode == RenderMode::Mixed
            ? render_mixed(*integrator, scene.lights.size(), rays, backend, observe, film)
            : render_batched(*integrator, scene.lights.size(), rays, backend, options.batch_rays,
                             observe, film);
    if (!report)
        return report;
    report->pixels_done = film.pixels_done();
    report->seconds = watch.seconds();
    report->seconds_cpu = cpu_seconds() - cpu_before;
    return report;
}

} // namespace ovc
