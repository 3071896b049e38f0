// SPDX-License-Identifier: Apache-2.0
// At a surface Whitted's integrator adds its own color, asks every light, and may follow two rays.
#include "host/shade/whitted.h"

#include "host/shade/lights/bounced_light.h"
#include "host/shade/lights/thrown_light.h"
#include "host/shade/surface/fog.h"
#include "importers/file/picture_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace ovc {

/// A surface that a path has met, and the pixel's share of its own color.
struct Whitted::Met {
    Met(const Scene& scene, const Ray& ray, const Path& path, const Hit& hit, const Cone& cone)
        : surface(surface_point(scene, ray, hit, cone)),
          id(hit.id),
          pixel(path.pixel),
          sample(path.sample),
          weight(path.weight) {}

    SurfacePoint surface;
    TriangleId id;
    uint32_t pixel;
    uint32_t sample;
    vec3 weight;
};

/// A shadow ray ends behind a pane where it would bring less light than this to its pixel.
static constexpr float kMinShadow = 1 / 4096.0f;

/// Returns the share of a shadow ray's light that passes the surface. With conserve_energy, light
/// that POV-Ray's glass reflects is missing behind it, but does not darken its shadow.
static vec3 light_through(const SurfacePoint& surface) {
    if (!surface.material->finish)
        return branches(surface, /* total= */ false).through;
    const float caustics = surface.material->caustics;
    if (caustics == 0)
        return surface.through;
    const double cosine = std::abs(glm::dot(surface.view, surface.normal));
    // Measured: povray's light below tilted panes has this exponent for any ior.
    return surface.through * float(1 + std::pow(cosine, 45 * double(caustics)));
}

/// Returns whether the ray reaches the surface from inside of a solid that lets light through.
/// Light inside of others comes from the camera's being there, as in a room.
static bool is_inside(const Scene& scene, const Ray& ray, const Hit& hit) {
    const uint32_t material = scene.meshes[hit.id.mesh].material;
    if (material >= scene.materials.size() || scene.materials[material].transmission == 0)
        return false;
    const Triangle t = scene.soup.triangle(hit.id);
    return glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), ray.dir) > 0;
}

/// Returns whether the path is in a solid that keeps out fog and media, its own included.
static bool is_in_solid(const Scene& scene, const Path& path) {
    return std::ranges::any_of(path.within.all(), [&](uint32_t material) {
        return material < scene.materials.size() && !scene.materials[material].hollow;
    });
}

static std::vector<const Medium*> pointers_to(const std::vector<Medium>& media) {
    std::vector<const Medium*> all;
    for (const Medium& medium : media)
        all.push_back(&medium);
    return all;
}

/// Returns the share of a shadow ray's light that the media of a solid leave on its way out.
static vec3 share_of_media(const Scene& scene, const Ray& ray, const Hit& hit) {
    if (!is_inside(scene, ray, hit))
        return vec3(1);
    const std::vector<const Medium*> media =
        pointers_to(scene.materials[scene.meshes[hit.id.mesh].material].media);
    return media.empty() ? vec3(1) : share_through_media(scene.textures, media, ray, hit.t);
}

/// Returns the share of light from everywhere that the surface's finishes scatter.
static vec3 reflected_by_finish(const SurfacePoint& surface) {
    vec3 sum(0);
    for (const Coat& coat : surface.coats)
        sum += coat.weight * reflected_by_finish(coat.surface);
    if (surface.coats.empty() && surface.material->finish)
        sum = surface.opacity * surface.material->finish->diffuse * surface.color;
    return sum;
}

static bool lets_light_through(const SurfacePoint& surface) {
    return surface.material->finish ? surface.through != vec3(0)
                                    : surface.material->transmission > 0;
}

/// Returns false where no mirrored or refracted ray leaves the surface.
static bool sends_rays_on(const SurfacePoint& surface) {
    if (lets_light_through(surface) || !surface.coats.empty())
        return true;
    const std::optional<Finish>& finish = surface.material->finish;
    return finish ? finish->reflection != vec3(0) || finish->grazing_reflection != vec3(0)
                  : surface.material->mirror != 0;
}

static bool has_fog(const Background& background) {
    return !background.fogs.empty() || !background.rainbows.empty();
}

static bool lets_light_through(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return m.transmission > 0; });
}

/// Returns how often the line along `way` through the point crosses the mesh with the point on the
/// inside, less how often with it on the outside: twice for each time that the mesh is around it.
static int sides_around(const Soup& soup, uint32_t mesh, const dvec3& point, const dvec3& way) {
    int sides = 0;
    for (uint32_t prim = 0; prim < soup.chunks[mesh].size(); ++prim) {
        const Triangle t = soup.triangle({mesh, prim});
        const dvec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
        const double u = glm::dot(way, glm::cross(b, c)), v = glm::dot(way, glm::cross(c, a)),
                     w = glm::dot(way, glm::cross(a, b));
        const double volume = glm::dot(a, glm::cross(b, c)); // above 0: the point is on the inside
        if ((u >= 0 && v >= 0 && w >= 0) != (u <= 0 && v <= 0 && w <= 0) && volume != 0)
            sides += volume > 0 ? 1 : -1;
    }
    return sides;
}

/// Returns whether some of the surface is metal.
static bool has_metal(const Scene& scene, const Material& material) {
    const uint32_t share = material.maps ? material.maps->metallic : kNone;
    return share == kNone || scene.textures[share] != plain_texture(vec3(0));
}

void tell_simplifications(const Scene& scene, std::span<const Light> lights,
                          std::string_view source, const LogSink& log) {
    // The only stand-in that is parallel is the sky's.
    const auto is_on_emitter = [](const Light& light) { return light.stand_in && !light.parallel; };
    const auto is_of_sky = [](const Light& light) { return light.stand_in && light.parallel; };
    if (!scene.background.layers.empty() && std::any_of(lights.begin(), lights.end(), is_of_sky))
        say(log, LogLevel::Warning,
            fmt::format("{}: environment maps light surfaces as a sky of even colors; --integrator "
                        "path has them as they are",
                        source));
    if (std::any_of(lights.begin(), lights.end(), is_on_emitter))
        say(log, LogLevel::Warning,
            fmt::format("{}: area lights shine from a few points on them, and shadows are hard; "
                        "--integrator path has them as they are",
                        source));
    const auto shines_alone = [](const Material& m) {
        return m.optics && m.optics->emission != vec3(0) && !m.finish;
    };
    if (std::ranges::any_of(scene.materials, shines_alone))
        say(log, LogLevel::Warning,
            fmt::format("{}: surfaces that send out light are bright but light no others; "
                        "--integrator path has their light",
                        source));
    if (std::ranges::any_of(scene.materials, [&](const Material& m) {
            return m.optics && m.optics->boundary == Optics::Boundary::Metal && !m.finish &&
                   has_metal(scene, m);
        }))
        say(log, LogLevel::Warning,
            fmt::format("{}: metals are matte; --integrator path has their shine", source));
    if (scene.exposure != 1)
        say(log, LogLevel::Info,
            fmt::format("{}: light times {:.3g}, to fit a picture that ends at white; "
                        "--integrator path has the light of the file",
                        source, scene.exposure));
}

Whitted::Whitted(const Scene& scene, const vec3& up, const WhittedOptions& options)
    : scene_(scene),
      up_(up),
      options_(options),
      light_may_pass_(lets_light_through(scene)),
      needs_cones_(needs_cones(scene)),
      has_media_(options.media && has_media(scene)),
      air_(pointers_to(scene.background.media)),
      media_(1),
      containers_(scene.materials.size()) {
    assert(options.max_depth <= UINT16_MAX); // Path::depth counts to it
    assert(options.light_stride >= 1);
    for (size_t m = 0; has_media_ && m < scene.materials.size(); ++m)
        if (!scene.materials[m].media.empty() && media_.size() <= UINT16_MAX) {
            containers_[m] = uint16_t(media_.size());
            media_.push_back(pointers_to(scene.materials[m].media));
        }
    if (options.eye && !scene.on_disk && (has_media_ || has_fog(scene.background)))
        look_around(*options.eye);
}

/// Finds the solids and the containers of media that the eye is in.
void Whitted::look_around(const dvec3& eye) {
    // Along no axis, so that they meet no edges of boxes. Lines that pass an open shape disagree.
    constexpr dvec3 kWays[] = {{0.5773, 0.5127, 0.6355}, {-0.09, 0.99, 0.11}, {0.68, -0.23, -0.69}};
    std::vector<int> sides(scene_.materials.size(), std::numeric_limits<int>::max()); // of each
    for (const dvec3& way : kWays) {
        std::vector<int> along(sides.size());
        for (uint32_t mesh = 0; mesh < scene_.meshes.size(); ++mesh)
            if (const uint32_t material = scene_.meshes[mesh].material;
                material < along.size() &&
                (containers_[material] != 0 || !scene_.materials[material].hollow))
                along[material] += sides_around(scene_.soup, mesh, eye, way);
        std::ranges::transform(sides, along, sides.begin(),
                               [](int a, int b) { return std::min(a, b); });
    }
    for (uint32_t material = 0; material < sides.size(); ++material)
        for (; sides[material] > 0; sides[material] -= 2) // an endless plane has one side
            if (scene_.materials[material].hollow)
                around_eye_.enter(containers_[material]);
            else
                eye_within_.enter(material);
}

void Whitted::shade(std::span<const Ray> rays, std::span<const Path> paths,
                    std::span<const Hit> hits, Film& film, Spawned& spawned) const {
    std::vector<Met> all;
    all.reserve(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        Path path = paths[i];
        if (path.kind == RayKind::Camera) {
            path.inside = around_eye_;
            path.within = eye_within_;
        }
        dim_by_fog(rays[i], hits[i], path, film);
        if (has_media_)
            dim_by_media(rays[i], hits[i], path, film, spawned);
        if (!hits[i].is_hit()) {
            film.add(path.pixel, path.weight * background_color(scene_, up_, rays[i].dir));
            continue;
        }
        Met& met =
            all.emplace_back(scene_, rays[i], path, hits[i], needs_cones_ ? path.cone : Cone());
        follow(rays[i], path, hits[i], met, spawned);
        film.add(met.pixel, met.weight * ambient_light(scene_.background, up_, met.surface));
        if (options_.bounced && scene_.radiosity)
            film.add(met.pixel, met.weight * scene_.radiosity->brightness *
                                    reflected_by_finish(met.surface) *
                                    options_.bounced->at(met.surface.position, met.surface.normal));
    }
    for (uint32_t light = 0; light < scene_.lights.size(); ++light)
        for (const Met& met : all)
            if ((met.sample + light) % options_.light_stride == 0)
                light_up(scene_.lights[light], light, met, film, spawned);
}

/// Takes the light that fog and rainbows keep from the path, and adds their own.
void Whitted::dim_by_fog(const Ray& ray, const Hit& hit, Path& path, Film& film) const {
    const Background& background = scene_.background;
    if (!has_fog(background) || is_in_solid(scene_, path))
        return;
    const double end = hit.is_hit() ? hit.t : double(INFINITY);
    for (const ThroughFog& fog : {through_fog(background.fogs, ray, end),
                                  through_rainbows(background.rainbows, ray, end)}) {
        film.add(path.pixel, path.weight * fog.added);
        path.weight *= fog.share;
    }
}

/// The way of a ray that hits nothing through media, as povray has it.
static constexpr double kEndlessMedia = 1e7;

/// Returns the media on a ray's way: those of all containers that it is in, and those of the air.
std::vector<const Medium*> Whitted::media_along(const Path& path) const {
    if (is_in_solid(scene_, path))
        return {};
    std::vector<const Medium*> media = air_;
    for (const uint16_t number : path.inside.numbers)
        media.insert(media.end(), media_[number].begin(), media_[number].end());
    return media;
}

/// Returns the values of t up to `end` at which the ray crosses the surface of a spotlight's cone.
static void add_cone_crossings(const Light& light, const Ray& ray, double end,
                               std::vector<double>& ends) {
    const double c2 = light.cone->falloff_cosine * light.cone->falloff_cosine;
    const dvec3 from = ray.org - light.position;
    const double a0 = glm::dot(from, light.direction), a1 = glm::dot(ray.dir, light.direction);
    const double a = a1 * a1 - c2 * glm::dot(ray.dir, ray.dir);
    const double b = a0 * a1 - c2 * glm::dot(from, ray.dir);
    const double c = a0 * a0 - c2 * glm::dot(from, from);
    const double root = b * b - a * c;
    if (a == 0 || !(root > 0))
        return;
    for (const double t : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a})
        if (t > 0 && t < end && a0 + t * a1 > 0)
            ends.push_back(t);
}

/// Takes the light that media keep from the path, and adds theirs and that of lamps which they
/// scatter.
void Whitted::dim_by_media(const Ray& ray, const Hit& hit, Path& path, Film& film,
                           Spawned& spawned) const {
    const std::vector<const Medium*> media = media_along(path);
    if (media.empty())
        return;
    const double end = hit.is_hit() ? hit.t : kEndlessMedia / glm::length(ray.dir);
    std::vector<double> ends = {0, end};
    const bool scatters = std::any_of(media.begin(), media.end(), [](const Medium* medium) {
        return medium->scattering != vec3(0);
    });
    for (const Light& light : scene_.lights)
        if (scatters && light.cone && light.lights_media)
            add_cone_crossings(light, ray, end, ends);
    std::sort(ends.begin(), ends.end());
    const ThroughMedia through = through_media(scene_.textures, media, ray, ends);
    const dvec3 way = glm::normalize(ray.dir);
    for (size_t i = 0; i < through.scattering.size(); ++i)
        scatter(through.scattering[i], way, path, path.pixel + uint32_t(i), film, spawned);
    film.add(path.pixel, path.weight * through.added);
    path.weight *= through.share;
}

/// Sends light of all lamps that arrives at the place along the path. turn: the point of an area
/// light that is asked for all of it.
void Whitted::scatter(const ScatteringPlace& from, const dvec3& way, const Path& path,
                      uint32_t turn, Film& film, Spawned& spawned) const {
    for (uint32_t number = 0; number < scene_.lights.size(); ++number) {
        const Light& light = scene_.lights[number];
        if (!light.lights_media || (number + turn) % light.area_points != 0)
            continue;
        FromLight arriving = light_at(light, from.at);
        arriving.color *= thrown_color(scene_, light, from.at);
        const double phase =
            light.area_points * phase_of(*from.medium, glm::dot(way, arriving.towards));
        const Ray ray = shadow_ray(light, from.at);
        const vec3 seen = path.weight * from.share * float(phase) * arriving.color *
                          share_of_air(light, ray) * std::numbers::inv_pi_v<float>;
        if (max_component(seen) < kMinShadow)
            continue;
        if (!options_.shadows || light.shadowless)
            film.add(path.pixel, seen);
        else
            spawned.shadows.push(ray, TriangleId(), {path.pixel, number, 0, seen});
    }
}

/// Returns the share of a light that comes through the air on the way to it.
vec3 Whitted::share_of_air(const Light& light, const Ray& ray) const {
    if (!light.fades_in_air)
        return vec3(1);
    return through_fog(scene_.background.fogs, ray, 1).share *
           share_through_media(scene_.textures, air_, ray, 1);
}

/// Returns in whose media a ray is that leaves the surface.
Containers Whitted::inside_behind(const Path& path, const Met& met, bool goes_through) const {
    Containers inside = path.inside;
    const uint32_t material = scene_.meshes[met.id.mesh].material;
    const uint16_t number = material < containers_.size() ? containers_[material] : uint16_t(0);
    if (number == 0)
        return inside;
    if (!met.surface.entering) {
        if (goes_through)
            inside.leave(number);
        else if (!inside.includes(number))
            inside.enter(number);
    } else if (goes_through)
        inside.enter(number);
    return inside;
}

/// Divides the path's weight among the surface's own color and the two rays that may leave it. The
/// color keeps the weight of a ray that is not followed.
void Whitted::follow(const Ray& ray, const Path& path, const Hit& hit, Met& met,
                     Spawned& spawned) const {
    met.weight = path.weight;
    if (path.depth >= options_.max_depth || !sends_rays_on(met.surface))
        return;
    const Cone cone{path.cone.width_at(ray, hit.t), path.cone.spread};
    const uint32_t material = scene_.meshes[hit.id.mesh].material;
    // The solids around the surface's, from where or to where a ray goes through it.
    Solids around = path.within;
    if (!met.surface.entering)
        around.leave(material);
    if (around.innermost() != kNone)
        met.surface.ior_around = scene_.materials[around.innermost()].ior;
    for (Coat& coat : met.surface.coats)
        coat.surface.ior_around = met.surface.ior_around;
    const bool clear = lets_light_through(met.surface);
    const std::optional<Ray> refracted = clear ? refracted_ray(ray, met.surface) : std::nullopt;
    const bool total = clear && !refracted;
    const Branches parts = branches(met.surface, total);
    // As in povray, a solid absorbs what comes through its surface, not the surface's own light.
    const vec3 kept = share_kept(ray, met.surface);
    const auto spawn = [&](const vec3& share, float taken, RayKind kind, int deeper, auto&& child) {
        const vec3 weight = path.weight * share;
        if (max_component(glm::abs(weight)) < kMinWeight)
            return;
        met.weight -= path.weight * taken;
        const bool reflected = path.reflected || kind == RayKind::Reflection;
        Solids within = kind == RayKind::Reflection ? path.within : around;
        if (kind == RayKind::Refraction && met.surface.entering &&
            material < scene_.materials.size())
            within.enter(material);
        spawned.paths.push(child(), hit.id,
                           {path.pixel, path.sample, uint16_t(path.depth + deeper), kind, reflected,
                            /* scattered= */ false, weight, path.density, path.behind, cone,
                            inside_behind(path, met, kind == RayKind::Refraction), within});
    };
    spawn(total ? kept * parts.mirror : parts.mirror, parts.taken_by_mirror, RayKind::Reflection, 1,
          [&] { return mirror_ray(ray, met.surface); });
    // A ray that goes straight on is no step deeper, as in POV-Ray: a line has only so many
    // surfaces.
    spawn(kept * parts.through, parts.taken_by_through, RayKind::Refraction,
          met.surface.material->ior == met.surface.ior_around ? 0 : 1, [&] { return *refracted; });
}

void Whitted::light_up(const Light& light, uint32_t number, const Met& met, Film& film,
                       Spawned& spawned) const {
    vec3 arriving = float(options_.light_stride) * met.weight * direct_light(light, met.surface);
    if (arriving != vec3(0))
        arriving *= thrown_color(scene_, light, met.surface.position);
    if (arriving == vec3(0))
        return;
    const bool from_behind =
        glm::dot(towards_light(light, met.surface.position), met.surface.geometric_normal) < 0;
    const Ray ray = shadow_ray(light, from_behind ? met.surface.beyond : met.surface.position);
    arriving *= share_of_air(light, ray);
    if (!options_.shadows || light.shadowless) {
        film.add(met.pixel, arriving);
        return;
    }
    // The surface itself may hide a point of an area light whose middle lights it.
    const double side = from_behind ? -1 : 1;
    if (light.shadow_offset == dvec3(0) ||
        side * glm::dot(ray.dir, met.surface.geometric_normal) > 0)
        spawned.shadows.push(ray, met.id, {met.pixel, number, 0, arriving});
}

bool Whitted::pass(const Hit& hit, Ray& ray, Shadow& shadow) const {
    const SurfacePoint glass = surface_point(scene_, ray, hit);
    shadow.arriving *= light_through(glass) * share_kept_in_shadow(ray, glass);
    if (has_media_)
        shadow.arriving *= share_of_media(scene_, ray, hit);
    if (max_component(shadow.arriving) < kMinShadow)
        shadow.arriving = vec3(0);
    ++shadow.passed;
    const dvec3 there = ray.dir;
    ray = shadow_ray(scene_.lights[shadow.light], glass.beyond);
    // A light that lies in the surface has been reached; going back to it might never end.
    return shadow.arriving != vec3(0) && glm::dot(ray.dir, there) > 0;
}

} // namespace ovc
