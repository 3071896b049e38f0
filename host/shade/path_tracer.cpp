// SPDX-License-Identifier: Apache-2.0
// At a surface a path sees the light that it emits, asks one light, and goes on in one direction.
#include "host/shade/path_tracer.h"

#include "host/shade/path_sampler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

/// From this depth on, paths that carry little end by chance, and the others carry more.
static constexpr uint32_t kRouletteFrom = 3;
static constexpr float kMinSurvival = 0.05f;
/// The spread of the cone of light that a surface scatters: further surfaces seen in it are
/// blurred.
static constexpr float kBounceSpread = 0.25f;

/// The purposes of the random numbers of a surface.
enum Purpose : uint32_t { kChoices, kLightPlace, kDirection, kRoulette, kPurposes };

/// A surface that a path has met.
struct PathTracer::Met {
    const Ray& ray;
    const Path& path;
    const Hit& hit;
    double distance; // back to where the direction was chosen
    SurfacePoint surface;
    Bsdf bsdf;
};

/// The rays that go on, by their way, so that neighbours go the same way.
struct PathTracer::Sides {
    RayList<Path> mirrored, through, bounced;
};

/// Returns the weight, by Veach's power heuristic, of light that was found with `density` and might
/// have been found with `other`.
static double share_of(double density, double other) {
    if (!(other > 0))
        return 1;
    const double ratio = other / density;
    return 1 / (1 + ratio * ratio);
}

/// Returns whether light passes the material; where it may not be bent, only if it passes straight.
static bool passes(const Material& material, bool may_be_bent) {
    if (material.optics)
        return material.optics->through != vec3(0) &&
               (may_be_bent || material.optics->boundary != Optics::Boundary::Dielectric);
    return material.transmission > 0 && (may_be_bent || material.ior == 1);
}

/// Returns the part that a hit meets of a mixture of materials that say how they treat light, by
/// chance; a path goes one way. Of others it returns the whole.
static SurfacePoint met_part(SurfacePoint surface, const Hit& hit) {
    if (surface.coats.empty() || !std::ranges::all_of(surface.coats, [](const Coat& coat) {
            return coat.surface.material->optics.has_value();
        }))
        return surface;
    // What chance_of() leaves undecided, because holes go by it.
    const float scaled = chance_of(hit) * 4096;
    float at = scaled - std::floor(scaled);
    size_t part = 0;
    while (part + 1 < surface.coats.size() && at >= surface.coats[part].weight.x)
        at -= surface.coats[part++].weight.x;
    return std::move(surface.coats[part].surface);
}

static bool light_passes(const Scene& scene, bool has_lights) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [&](const Material& m) { return passes(m, has_lights); });
}

PathTracer::PathTracer(const Scene& scene, const vec3& up, const PathTracerOptions& options)
    : scene_(scene),
      up_(up),
      options_(options),
      lights_(scene, up, options.cutouts),
      unexposed_(1 / scene.exposure),
      needs_cones_(needs_cones(scene)),
      light_may_pass_(light_passes(scene, lights_.has_lights())) {
    assert(options.max_depth <= UINT16_MAX); // Path::depth counts to it
}

void tell_what_paths_leave_out(const Scene& scene, std::string_view source, const LogSink& log) {
    std::vector<std::string> items;
    const auto add = [&](std::string_view what, size_t count) {
        if (count > 0)
            items.push_back(fmt::format("{} ({})", what, count));
    };
    const auto add_finishes = [&](std::string_view word, const auto& has) {
        add(word, size_t(std::ranges::count_if(scene.materials, [&](const Material& m) {
                return m.finish && !m.optics && has(*m.finish);
            })));
    };
    const Background& air = scene.background;
    add("fog", air.fogs.size());
    add("rainbow", air.rainbows.size());
    add("media",
        air.media.size() + size_t(std::ranges::count_if(scene.materials, [](const Material& m) {
            return !m.media.empty();
        })));
    add_finishes("irid", [](const Finish& f) { return f.irid > 0; });
    add_finishes("brilliance", [](const Finish& f) { return f.brilliance != 1 && f.diffuse > 0; });
    add_finishes("crand", [](const Finish& f) { return f.crand > 0; });
    add_finishes("diffuse from behind", [](const Finish& f) { return f.diffuse_back > 0; });
    if (!items.empty())
        say(log, LogLevel::Warning,
            fmt::format("{}: --integrator path leaves out {}", source, fmt::join(items, ", ")));
}

void PathTracer::shade(std::span<const Ray> rays, std::span<const Path> paths,
                       std::span<const Hit> hits, Film& film, Spawned& spawned) const {
    Sides sides;
    for (size_t i = 0; i < rays.size(); ++i)
        if (hits[i].is_hit())
            meet(rays[i], paths[i], hits[i], film, sides, spawned);
        else
            film.add(paths[i].pixel,
                     clamped(paths[i], paths[i].weight * unexposed_ * seen_sky(rays[i], paths[i])));
    for (const RayList<Path>* side : {&sides.mirrored, &sides.through, &sides.bounced})
        spawned.paths.append(*side);
}

void PathTracer::meet(const Ray& ray, Path path, const Hit& hit, Film& film, Sides& sides,
                      Spawned& spawned) const {
    const SurfacePoint surface =
        met_part(surface_point(scene_, ray, hit, needs_cones_ ? path.cone : Cone()), hit);
    const double distance = double(path.behind) + hit.t * glm::length(ray.dir);
    path.weight *= share_kept(ray, surface);
    const Met met{ray, path, hit, distance, surface, Bsdf(surface)};
    film.add(path.pixel, clamped(path, path.weight * unexposed_ * seen_emission(met)));
    if (path.depth >= options_.max_depth)
        return;
    const PathSampler random(options_.seed, options_.part.number_in_picture(path.pixel),
                             path.sample);
    const uint32_t first = path.depth * uint32_t(kPurposes);
    const dvec2 choices = random.pair(first + kChoices);
    if (met.bsdf.scatters())
        light_up(met, choices.x, random.pair(first + kLightPlace), film, spawned);
    const auto scattered = met.bsdf.sample(choices.y, random.pair(first + kDirection));
    if (!scattered)
        return;
    vec3 weight = path.weight * scattered->weight;
    // Glass has no roulette: weights there fall by the square of the index and rise again.
    if (path.depth >= kRouletteFrom && scattered->density > 0) {
        const float survival = std::clamp(max_component(weight), kMinSurvival, 1.0f);
        if (random.pair(first + kRoulette).x >= survival)
            return;
        weight /= survival;
    }
    if (weight != vec3(0))
        go_on(met, *scattered, weight, sides);
}

/// Returns the light without what is above PathTracerOptions::clamp, in its own color. Light that
/// comes to the first scattering surface, and what mirrors and glass show, has little noise and
/// stays as it is.
vec3 PathTracer::clamped(const Path& path, const vec3& light) const {
    const float brightest = max_component(light);
    return options_.clamp > 0 && path.scattered && brightest > options_.clamp
               ? light * (options_.clamp / brightest)
               : light;
}

/// Returns the share of the light of the sky that paths bring, the rest of which shadow rays do.
vec3 PathTracer::seen_sky(const Ray& ray, const Path& path) const {
    const vec3 sky = background_color(scene_, up_, ray.dir);
    if (!(path.density > 0) || options_.search == LightSearch::Paths)
        return sky;
    const double by_light = lights_.sky_density(glm::normalize(ray.dir));
    if (!(by_light > 0))
        return sky;
    if (options_.search == LightSearch::ShadowRays)
        return vec3(0);
    return sky * float(share_of(double(path.density), by_light));
}

vec3 PathTracer::seen_emission(const Met& met) const {
    const vec3 emission = met.bsdf.emission();
    if (emission == vec3(0) || !(met.path.density > 0))
        return emission;
    const double cosine = glm::dot(met.surface.view, met.surface.geometric_normal);
    const double by_light = lights_.density(met.hit.id, met.distance, cosine);
    if (!(by_light > 0) || options_.search == LightSearch::Paths)
        return emission;
    if (options_.search == LightSearch::ShadowRays)
        return vec3(0);
    return emission * float(share_of(double(met.path.density), by_light));
}

void PathTracer::light_up(const Met& met, double choice, const dvec2& u, Film& film,
                          Spawned& spawned) const {
    const std::optional<Arriving> from = lights_.sample(met.surface, choice, u);
    if (!from || (from->density > 0 && options_.search == LightSearch::Paths))
        return;
    const vec3 reflected = met.bsdf.evaluate(from->towards);
    if (reflected == vec3(0))
        return;
    const double share = from->density > 0 && options_.search == LightSearch::Both
                             ? share_of(from->density, met.bsdf.density(from->towards))
                             : 1;
    const vec3 arriving =
        clamped(met.path, met.path.weight * reflected * from->light * float(share) * unexposed_);
    const bool is_shadowless = from->number != kNone && scene_.lights[from->number].shadowless;
    if (options_.shadows && !is_shadowless)
        spawned.shadows.push(from->ray, met.hit.id, {met.path.pixel, from->number, 0, arriving});
    else
        film.add(met.path.pixel, arriving);
}

void PathTracer::go_on(const Met& met, const Scattered& scattered, const vec3& weight,
                       Sides& sides) const {
    const Path& from = met.path;
    Path path{from.pixel,
              from.sample,
              uint16_t(from.depth + 1),
              RayKind::Bounce,
              /* reflected= */ true,
              /* scattered= */ from.scattered || scattered.density > 0,
              weight,
              float(scattered.density)};
    path.cone = {from.cone.width_at(met.ray, met.hit.t), from.cone.spread};
    if (scattered.density > 0) {
        path.cone.spread = std::max(path.cone.spread, kBounceSpread);
        Ray ray;
        ray.org = glm::dot(scattered.direction, met.surface.geometric_normal) > 0
                      ? met.surface.position
                      : met.surface.beyond;
        ray.dir = scattered.direction;
        sides.bounced.push(ray, met.hit.id, path);
        return;
    }
    const std::optional<Ray> through =
        scattered.way == Scattering::Through ? refracted_ray(met.ray, met.surface) : std::nullopt;
    path.kind = through ? RayKind::Refraction : RayKind::Reflection;
    if (!through) { // mirrored, or reflected totally by a rounding
        sides.mirrored.push(mirror_ray(met.ray, met.surface), met.hit.id, path);
        return;
    }
    path.reflected = from.reflected;
    if (met.bsdf.is_straight()) { // the direction is still the one that was chosen
        path.density = from.density;
        path.behind = float(met.distance);
    }
    sides.through.push(*through, met.hit.id, path);
}

/// Light of emitters passes surfaces that do not bend it; behind glass, paths find it. Only shadow
/// rays find the light of points, so it passes glass straight, as in Whitted's model.
bool PathTracer::pass(const Hit& hit, Ray& ray, Shadow& shadow) const {
    const SurfacePoint surface = met_part(surface_point(scene_, ray, hit), hit);
    const bool is_light = shadow.light != kNone;
    const bool ends = !passes(*surface.material, is_light) || shadow.passed >= options_.max_depth;
    shadow.arriving *=
        ends ? vec3(0) : Bsdf(surface).through() * share_kept_in_shadow(ray, surface);
    ++shadow.passed;
    const dvec3 there = ray.dir;
    ray = is_light                   ? shadow_ray(scene_.lights[shadow.light], surface.beyond)
          : std::isfinite(ray.t_max) ? Ray{surface.beyond, 0, ray.at(1) - surface.beyond, ray.t_max}
                                     : Ray{surface.beyond, 0, ray.dir, ray.t_max};
    // A light that lies in the surface has been reached; going back to it might never end.
    return shadow.arriving != vec3(0) && glm::dot(ray.dir, there) > 0;
}

} // namespace ovc
