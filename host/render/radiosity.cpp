// SPDX-License-Identifier: Apache-2.0
// A grid of camera rays finds the points. From each of them rays go out evenly by the cosine, once
// for each bounce; those of a bounce find the light of the bounces before it.
#include "host/render/radiosity.h"

#include "core/system/parallel.h"
#include "host/shade/path_sampler.h"
#include "host/shade/shading.h"
#include "host/shade/whitted.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

constexpr uint32_t kMaxColumns = 80; // of the grid, and of its rows
constexpr size_t kPointsAtOnce = 256;
/// So many rays leave a point. Each asks at most kLightsARay lights, others than the ray before.
constexpr size_t kMaxRays = 96, kRaysTimesLights = 512, kLightsARay = 8;
constexpr uint64_t kSeed = 33;

/// Returns a direction around the normal, more often where the cosine is larger.
/// Malley's method: Pharr, Jakob and Humphreys 2016, section 13.6.3.
dvec3 around(const dvec3& normal, const dvec2& u) {
    const dvec3 other = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 a = glm::normalize(glm::cross(normal, other)), b = glm::cross(normal, a);
    const double r = std::sqrt(u.x), angle = 2 * std::numbers::pi * u.y;
    return r * std::cos(angle) * a + r * std::sin(angle) * b +
           std::sqrt(std::max(0.0, 1 - u.x)) * normal;
}

class Gathering {
public:
    Gathering(const Scene& scene, const vec3& up, const Sight& sight, Backend& backend,
              const GatherOptions& options)
        : scene_(scene),
          up_(up),
          sight_(sight),
          backend_(backend),
          options_(options),
          light_stride_((scene.lights.size() + kLightsARay - 1) / kLightsARay),
          rays_a_point_(std::min(
              kRaysTimesLights / (std::min(scene.lights.size(), kLightsARay) + 1), kMaxRays)) {}

    Result<Done> find_points(const Pinhole& pinhole) {
        RayList<Path> rays;
        const uint32_t step =
            std::max(1u, std::max(pinhole.width(), pinhole.height()) / kMaxColumns);
        for (uint32_t y = step / 2; y < pinhole.height(); y += step)
            for (uint32_t x = step / 2; x < pinhole.width(); x += step)
                rays.push(pinhole.ray(x, y), TriangleId(), {});
        std::vector<Hit> hits(rays.size());
        if (const Result<Done> done = intersect(rays, hits); !done)
            return done;
        for (size_t i = 0; i < rays.size(); ++i)
            if (hits[i].is_hit()) {
                const SurfacePoint s = surface_point(scene_, rays.rays[i], hits[i]);
                if (!s.material->finish)
                    continue;
                points_.push_back({s.position, s.geometric_normal});
                starts_.push_back(hits[i].id);
            }
        return Done{};
    }

    /// Finds the light at the points, with that of the bounces before; null: there are none.
    Result<Done> gather(const BouncedLight* before) {
        // Media count for nothing as in povray, where a scene does not say `media on` in its
        // radiosity.
        const Whitted integrator(scene_, up_,
                                 {.max_depth = options_.max_depth,
                                  .shadows = options_.shadows,
                                  .media = false,
                                  .bounced = before,
                                  .light_stride = uint32_t(std::max<size_t>(light_stride_, 1))});
        for (size_t first = 0; first < points_.size(); first += kPointsAtOnce) {
            const size_t count = std::min(kPointsAtOnce, points_.size() - first);
            if (const Result<Done> done = gather(integrator, first, count); !done)
                return done;
        }
        return Done{};
    }

    const std::vector<BouncedLight::Record>& points() const { return points_; }

private:
    Result<Done> gather(const Whitted& integrator, size_t first, size_t count) {
        Film film(uint32_t(count), 1, uint32_t(rays_a_point_));
        Shading shading(integrator, film);
        Spawned waiting;
        for (size_t p = 0; p < count; ++p)
            add_rays(first + p, uint32_t(p), waiting.paths);
        std::vector<Hit> hits;
        while (!waiting.paths.empty()) {
            RayList<Path> now;
            waiting.paths.move_tail(0, now);
            hits.resize(now.size());
            if (const Result<Done> done = intersect(now, hits); !done)
                return done;
            for (size_t at = 0; at < now.size(); at += shading.max_answers()) {
                shading.shade(now, hits, at, std::min(shading.max_answers(), now.size() - at),
                              waiting);
                if (const Result<Done> done = trace_shadows(integrator, shading, waiting.shadows);
                    !done)
                    return done;
            }
        }
        const Image image = film.image();
        for (size_t p = 0; p < count; ++p)
            points_[first + p].light = vec3(image.pixels[p]);
        return Done{};
    }

    void add_rays(size_t number, uint32_t pixel, RayList<Path>& to) const {
        const BouncedLight::Record& point = points_[number];
        for (uint32_t i = 0; i < rays_a_point_; ++i) {
            const dvec2 u = PathSampler(kSeed, uint32_t(number), i).pair(0);
            Ray ray;
            ray.org = point.at;
            ray.dir = around(point.normal, u);
            to.push(ray, starts_[number],
                    {.pixel = pixel,
                     .sample = i,
                     .depth = 0,
                     .kind = RayKind::Bounce,
                     .reflected = true,
                     .scattered = false,
                     .weight = vec3(1),
                     .density = 0});
        }
    }

    Result<Done> trace_shadows(const Whitted& integrator, Shading& shading,
                               RayList<Shadow>& shadows) {
        while (!shadows.empty()) {
            Exclusions without(shadows.skip);
            without.sieves = sight_.of(shadows.purposes, masks_);
            if (integrator.light_may_pass()) {
                std::vector<Hit> hits(shadows.size());
                if (const Result<Done> done = backend_.intersect(shadows.rays, without, hits);
                    !done)
                    return done;
                shading.pass(shadows, hits);
                continue;
            }
            std::vector<uint8_t> occluded(shadows.size());
            if (const Result<Done> done = backend_.occluded(shadows.rays, without, occluded); !done)
                return done;
            shading.arrive(shadows.purposes, occluded);
            shadows.resize(0);
        }
        return Done{};
    }

    Result<Done> intersect(const RayList<Path>& rays, std::vector<Hit>& hits) {
        Exclusions without(rays.skip);
        without.sieves = sight_.of(rays.purposes, masks_);
        return backend_.intersect(rays.rays, without, hits);
    }

    const Scene& scene_;
    const vec3 up_;
    const Sight& sight_;
    Backend& backend_;
    const GatherOptions options_;
    const size_t light_stride_;
    const size_t rays_a_point_;
    std::vector<BouncedLight::Record> points_;
    std::vector<TriangleId> starts_; // the triangles that they lie on
    std::vector<uint32_t> masks_;
};

} // namespace

Result<std::shared_ptr<const BouncedLight>>
gather_bounced_light(const Scene& scene, const Pinhole& pinhole, const Sight& sight,
                     Backend& backend, const GatherOptions& options) {
    std::shared_ptr<const BouncedLight> light;
    if (!scene.radiosity)
        return light;
    Gathering gathering(scene, vec3(pinhole.up()), sight, backend, options);
    if (const Result<Done> done = gathering.find_points(pinhole); !done)
        return done.error();
    for (uint32_t bounce = 0; bounce < scene.radiosity->bounces; ++bounce) {
        if (const Result<Done> done = gathering.gather(light.get()); !done)
            return done.error();
        light = std::make_shared<const BouncedLight>(gathering.points());
    }
    return light;
}

} // namespace ovc
