// SPDX-License-Identifier: Apache-2.0
// Positions, normals and light of single hits.
// Based on: Whitted 1980, "An Improved Illumination Model for Shaded Display", with a hemisphere of
// sky for ambient light.
#include "host/shade/shade.h"

#include "core/smooth_step.h"
#include "core/texture/pattern.h"
#include "host/shade/finish.h"
#include "host/shade/refract.h"
#include "host/shade/surface/surface_material.h"
#include "host/shade/surface/texture_place.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numbers>

namespace ovc {

/// The share of the background's light that arrives as ambient light; lamps bring the rest.
static constexpr float kSkyShare = 0.32f;
/// Light from nowhere in particular, so that shadows in a room without a sky are not black.
static constexpr float kAmbient = 0.04f;
/// The light of the ground, as a share of the horizon's.
static constexpr float kGround = 0.35f;

/// How far a position lies off its triangle, in units of the largest coordinate of the corners. A
/// position computed from the corners errs by less than half of this: see docs/design/numerics.md,
/// "Spawned rays".
static constexpr double kOffset = 0x1p-48;
/// A position keeps so many offsets away from the edges, or it would cross the neighbour there.
/// The minimum is enough for any angle of more than 1/64 rad between the two. The maximum, for 1e-4
/// rad, is taken as long as it is not above kEdgeShare of the triangle's height.
static constexpr double kMinEdgeOffsets = 64, kMaxEdgeOffsets = 16384;
static constexpr double kEdgeShare = 0x1p-20;

/// Returns a b - c d to two units in the last place, however much cancels. Kahan's algorithm;
/// Jeannerod, Louvet and Muller 2013.
static double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// Returns a x b, exact enough for slivers: rounded products would turn it by their aspect times a
/// rounding.
static dvec3 cross(const dvec3& a, const dvec3& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// Returns the turned normal at unit length, because an instance may be stretched.
static dvec3 turned(const dmat3& turn, const vec3& normal) {
    const dvec3 n = turn * dvec3(normal);
    const double length = glm::length(n);
    return length > 0 ? n / length : n;
}

/// Returns the normals of the hit triangle's corners in the world, or nothing where it has none.
static std::optional<std::array<dvec3, 3>> corner_normals(const Scene& scene, const MeshInfo& mesh,
                                                          const Hit& hit) {
    const PerCorner<vec3> normals = scene.normals_of(mesh);
    if (normals.empty())
        return std::nullopt;
    const std::array<vec3, 3> corner = normals.of(hit.id.prim);
    std::array<dvec3, 3> corners{dvec3(corner[0]), dvec3(corner[1]), dvec3(corner[2])};
    if (mesh.turn != dmat3(1))
        for (size_t i = 0; i < 3; ++i)
            corners[i] = turned(mesh.turn, corner[i]);
    return corners;
}

static dvec3 interpolated_normal(const std::array<dvec3, 3>& corners, const Hit& hit,
                                 const dvec3& fallback) {
    const dvec3 n = (1 - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2];
    const double length = glm::length(n);
    // Opposite or missing normals cancel out; the plane's own normal takes their place.
    return length > 1e-6 && std::isfinite(length) ? n / length : fallback;
}

/// Returns the point of the curved surface that a point of the triangle stands for: halfway to the
/// mean of its projections on the corners' tangent planes, which is exact to the fourth order of
/// the angle between them for a sphere. w: the weights of the corners.
/// Boubekeur and Alexa 2008, "Phong tessellation".
static dvec3 on_curve(const Triangle& t, const std::array<dvec3, 3>& normals, const dvec3& w,
                      const dvec3& at) {
    dvec3 sum(0);
    for (int i = 0; i < 3; ++i) {
        const dvec3& n = normals[size_t(i)];
        sum += w[i] * glm::dot(t[size_t(i)] - at, n) * n;
    }
    return is_finite(sum) ? at + 0.5 * sum : at;
}

static dvec3 facing(const dvec3& normal, const dvec3& towards) {
    return glm::dot(normal, towards) < 0 ? -normal : normal;
}

/// Returns the hit's weights of the corners, moved inwards where it is too close to an edge.
/// doubled_area: of the triangle, above 0.
static dvec3 weights_off_edges(const Hit& hit, const Triangle& t, double doubled_area,
                               double offset) {
    const dvec3 weights{1 - hit.u - hit.v, hit.u, hit.v};
    const dvec3 ab = t[1] - t[0], ac = t[2] - t[0];
    // Most hits are far enough from all edges, even if each were as long as this.
    const double bound = sum_of_magnitudes(ab) + sum_of_magnitudes(ac);
    if (-max_component(-weights) >=
        std::max(kEdgeShare, kMinEdgeOffsets * offset * bound / doubled_area))
        return weights;
    const dvec3 edges{glm::length(t[2] - t[1]), glm::length(ac), glm::length(ab)};
    const dvec3 heights = doubled_area / edges;
    const dvec3 wanted = glm::clamp(dvec3(kEdgeShare), kMinEdgeOffsets * offset / heights,
                                    kMaxEdgeOffsets * offset / heights);
    const dvec3 min_weights = glm::min(wanted, dvec3(0.25));
    if (glm::all(glm::greaterThanEqual(weights, min_weights)))
        return weights;
    return min_weights +
           (1 - min_weights.x - min_weights.y - min_weights.z) * glm::clamp(weights, 0.0, 1.0);
}

/// Returns the number of the material on the side of the surface that is seen.
static uint32_t side_of(const Scene& scene, uint32_t material, bool from_outside) {
    if (from_outside || material >= scene.materials.size())
        return material;
    const uint32_t inside = scene.materials[material].inside;
    return inside == kNone ? material : inside;
}

bool needs_cones(const Scene& scene) {
    return std::ranges::any_of(scene.textures,
                               [](const Texture& texture) {
                                   return texture.kind == TextureKind::Image ||
                                          texture.pattern.kind == Pattern::Kind::Perlin;
                               }) ||
           std::ranges::any_of(scene.materials, [](const Material& material) {
               return material.normal_map.has_value();
           });
}

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit, const Cone& cone) {
    assert(hit.is_hit() && hit.id.mesh < scene.meshes.size());
    const MeshInfo& mesh = scene.meshes[hit.id.mesh];
    const Triangle t = scene.soup.triangle(hit.id);
    const dvec3 outwards = cross(t[1] - t[0], t[2] - t[0]);
    const double doubled_area = glm::length(outwards); // a hit triangle has an area

    SurfacePoint s;
    s.lit_by = mesh.lit_by;
    s.entering = glm::dot(outwards, ray.dir) <= 0;
    s.view = glm::normalize(ray.dir);
    s.geometric_normal = (s.entering ? 1.0 : -1.0) * (outwards / doubled_area);
    const auto normals = corner_normals(scene, mesh, hit);
    s.normal =
        normals ? facing(interpolated_normal(*normals, hit, s.geometric_normal), s.geometric_normal)
                : s.geometric_normal;

    // Computed from the corners, the position errs by a few ulp of their coordinates, however far
    // away the ray began.
    const double reach = std::max({max_component(glm::abs(t[0])), max_component(glm::abs(t[1])),
                                   max_component(glm::abs(t[2]))});
    const double offset = kOffset * reach;
    const dvec3 w = weights_off_edges(hit, t, doubled_area, offset);
    const dvec3 on_plane = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
    s.position = on_plane + offset * s.geometric_normal;
    s.beyond = on_plane - offset * s.geometric_normal;
    TexturePoint point(normals && mesh.curved ? on_curve(t, *normals, w, on_plane) : on_plane,
                       s.normal, s.view);
    if (!scene.textures.empty())
        take_texture_place(scene, mesh, t, hit, cone.width_at(ray, hit.t), s, point);
    take_material(scene, side_of(scene, mesh.material, s.entering), point, s);
    return s;
}

vec3 background_color(const Scene& scene, const vec3& up, const dvec3& dir) {
    const Background& background = scene.background;
    const dvec3 towards = glm::normalize(dir);
    const float height = float(glm::dot(towards, dvec3(up)));
    vec3 seen = glm::mix(background.horizon, background.zenith, std::clamp(height, 0.0f, 1.0f));
    for (const PlacedTexture& layer : background.layers) {
        const TransparentColor c = color_at(scene.textures, layer, towards);
        seen = c.opacity() * c.rgb + (background.layers_add ? vec3(1)
                                      : background.tints    ? c.through()
                                                            : vec3(c.filter + c.transmit)) *
                                         seen;
    }
    return seen;
}

/// Returns the sum of light(surface) of the surface's coats, each weighted.
template <class LightOf>
static vec3 sum_of_coats(const SurfacePoint& surface, const LightOf& light) {
    vec3 sum(0);
    for (const Coat& coat : surface.coats)
        sum += coat.weight * light(coat.surface);
    return sum;
}

vec3 ambient_light(const Background& background, const vec3& up, const SurfacePoint& surface) {
    if (!surface.coats.empty())
        return sum_of_coats(
            surface, [&](const SurfacePoint& coat) { return ambient_light(background, up, coat); });
    if (surface.material->finish)
        return surface.opacity * surface.color * surface.material->finish->ambient;
    const vec3 ground = kGround * background.horizon;
    const vec3 sky = 0.5f * (background.horizon + background.zenith);
    const float openness = 0.5f + 0.5f * float(glm::dot(surface.normal, dvec3(up)));
    const std::optional<Optics>& optics = surface.material->optics;
    return surface.color * (kAmbient + kSkyShare * glm::mix(ground, sky, openness)) +
           (optics ? surface.maps.emission * optics->emission : vec3(0));
}

dvec3 towards_light(const Light& light, const dvec3& position) {
    if (light.distant)
        return -light.direction;
    const dvec3 there = light.position - position;
    return light.parallel ? std::abs(glm::dot(there, light.direction)) * -light.direction : there;
}

/// Returns the share of the light that is left so far off the beam's axis.
static double share_of_beam(const LightBeam& beam, double off_axis) {
    if (off_axis >= beam.falloff)
        return 0;
    const double edge =
        off_axis <= beam.radius ? 1 : smooth_step(beam.falloff, beam.radius, off_axis);
    return std::pow(1 - off_axis / beam.falloff, beam.tightness) * edge;
}

/// Returns the vector from the light to its point that shadow rays go to, on their way `there`.
static dvec3 shadow_offset_of(const Light& light, const dvec3& there) {
    if (!light.faces_places)
        return light.shadow_offset;
    const dvec3 towards = glm::normalize(there);
    const dvec3 z(0, 0, 1), x(1, 0, 0);
    const dvec3 one = glm::normalize(glm::cross(towards, std::abs(towards.z) < 0.9999 ? z : x));
    return light.shadow_offset.x * one + light.shadow_offset.y * glm::cross(one, towards);
}

/// Returns the t at which a shadow ray ends: at its light, whose clearance is free of shadows, or
/// before at the surface that the light is projected through; 0 where it misses that.
static double end_of_shadow_ray(const Light& light, const dvec3& from, const dvec3& way) {
    constexpr double kMinDistance = 1e-6; // for a place on the surface itself
    if (light.distant)
        return std::numeric_limits<double>::infinity();
    if (light.clearance == 0 && !light.projector)
        return glm::dot(way, way) > 0 ? 1 : 0;
    const double length = glm::length(way);
    const double end = length > light.clearance ? 1 - light.clearance / length : 0;
    if (!light.projector)
        return end;
    const double met = light.projector->first_crossing(from, way, kMinDistance / length);
    return met <= 1 ? std::min(met, end) : 0;
}

/// Returns the share of the light's color that is left where `there` leads from to the light: after
/// its cone, its beam and its fall-off, as in POV-Ray 3.7. towards: the light's direction.
static double attenuation(const Light& light, const dvec3& there, const dvec3& towards,
                          double distance) {
    double share = 1;
    if (light.beam)
        share = share_of_beam(*light.beam, glm::length(glm::cross(there, light.direction)));
    if (light.cone) {
        const SpotCone& cone = *light.cone;
        const double cosine = -glm::dot(towards, light.direction);
        if (!(cosine > 0))
            return 0;
        const double edge = cosine >= cone.radius_cosine
                                ? 1
                                : smooth_step(cone.falloff_cosine, cone.radius_cosine, cosine);
        share = std::pow(cosine, cone.tightness) * edge;
    }
    if (light.fade_distance > 0 && light.fade_power > 0)
        share *= 2 / (1 + std::pow(distance / light.fade_distance, light.fade_power));
    return share;
}

FromLight light_at(const Light& light, const dvec3& position) {
    const dvec3 there = towards_light(light, position);
    const double distance = glm::length(there);
    const dvec3 towards = distance > 0 ? there / distance : dvec3(0);
    if (light.projector &&
        end_of_shadow_ray(light, position, there + shadow_offset_of(light, there)) == 0)
        return {towards, vec3(0)};
    return {towards,
            light.color * float(attenuation(light, light.position - position, towards, distance))};
}

/// Returns the share of the light of a direction behind the surface that it scatters to the front.
static vec3 light_from_behind(const SurfacePoint& surface, const dvec3& towards) {
    const std::optional<Finish>& finish = surface.material->finish;
    const double cosine = -glm::dot(surface.normal, towards);
    if (!finish || finish->diffuse_back == 0 || !(cosine > 0) ||
        glm::dot(surface.geometric_normal, towards) >= 0)
        return vec3(0);
    return surface.color * (surface.opacity * finish->diffuse_back * brilliant(*finish, cosine));
}

vec3 direct_light(const Light& light, const SurfacePoint& surface) {
    if (!surface.lit_by.includes(light.group))
        return vec3(0);
    if (!surface.coats.empty())
        return sum_of_coats(surface,
                            [&](const SurfacePoint& coat) { return direct_light(light, coat); });
    const FromLight from = light_at(light, surface.position);
    const dvec3 towards = from.towards != dvec3(0) ? from.towards : surface.normal;
    const double cosine = glm::dot(surface.normal, towards);
    const vec3 arriving = from.color * std::numbers::inv_pi_v<float>;
    if (!(cosine > 0) || !(glm::dot(surface.geometric_normal, towards) > 0))
        return light_from_behind(surface, towards) * arriving;
    if (!surface.material->finish)
        return surface.color * arriving * float(cosine);
    return finish_light(surface, towards, arriving, /* highlights= */ !light.shadowless);
}

Ray shadow_ray(const Light& light, const dvec3& position) {
    const dvec3 middle = towards_light(light, position);
    const dvec3 there = middle + shadow_offset_of(light, middle);
    return {position, 0, there, end_of_shadow_ray(light, position, there)};
}

Branches branches(const SurfacePoint& surface, bool total) {
    const Material& material = *surface.material;
    if (material.finish)
        return finish_branches(surface, total);
    const float mirror = surface.maps.gloss() * material.mirror;
    const float through = std::min(material.transmission, 1 - material.mirror);
    if (total)
        return {vec3(mirror + through), vec3(0), mirror + through, 0};
    return {vec3(mirror), through * material.filter, mirror, through};
}

vec3 share_kept(const Ray& ray, const SurfacePoint& surface) {
    const std::optional<Absorption>& absorption = surface.material->absorption;
    if (!absorption || surface.entering)
        return vec3(1);
    const double way = glm::distance(surface.position, ray.org) / double(absorption->distance);
    if (absorption->power >= 1000) // as povray draws it
        return glm::exp(float(way) * (absorption->color - 1.0f));
    const double share = 1 / (1 + std::pow(way, double(absorption->power)));
    return glm::mix(absorption->color, vec3(1), float(share));
}

vec3 share_kept_in_shadow(const Ray& ray, const SurfacePoint& surface) {
    const std::optional<Absorption>& absorption = surface.material->absorption;
    return absorption && absorption->power == 0 ? vec3(1) : share_kept(ray, surface);
}

Ray mirror_ray(const Ray& ray, const SurfacePoint& surface) {
    const auto mirrored = [&](const dvec3& normal) {
        return ray.dir - 2 * glm::dot(ray.dir, normal) * normal;
    };
    Ray out;
    out.org = surface.position;
    out.dir = mirrored(surface.normal);
    if (glm::dot(out.dir, surface.geometric_normal) <= 0)
        out.dir = mirrored(surface.geometric_normal);
    return out;
}

std::optional<Ray> refracted_ray(const Ray& ray, const SurfacePoint& surface) {
    const double inside = surface.material->ior, around = surface.ior_around;
    const double from = surface.entering ? around : inside, to = surface.entering ? inside : around;
    const bool seen = glm::dot(ray.dir, surface.normal) < 0;
    const auto below = [&](const dvec3& dir) {
        return glm::dot(dir, surface.geometric_normal) < 0;
    };
    std::optional<dvec3> dir =
        refracted(ray.dir, seen ? surface.normal : surface.geometric_normal, from, to);
    if (dir && !below(*dir))
        dir = refracted(ray.dir, surface.geometric_normal, from, to);
    // Within a rounding of the critical angle the ray might still run along the plane.
    if (!dir || !below(*dir))
        return std::nullopt;
    Ray out;
    out.org = surface.beyond;
    out.dir = *dir;
    return out;
}

} // namespace ovc
