// SPDX-License-Identifier: Apache-2.0
// Phong 1975, Blinn 1977, Fresnel's equations, and POV-Ray's ways with them.
#include "host/shade/finish.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace ovc {

/// Returns white, or the surface's color the more metallic it is, except at grazing angles. POV-Ray
/// approximates Fresnel's curve of a metal so. angle_cosine: to the normal.
static vec3 metallic_tint(const SurfacePoint& surface, float metallic, double angle_cosine) {
    if (!(metallic > 0))
        return vec3(1);
    const double x = std::acos(std::clamp(std::abs(angle_cosine), 0.0, 1.0)) * 2 / std::numbers::pi;
    const double grazing =
        std::clamp(0.014567225 / ((x - 1.12) * (x - 1.12)) - 0.011612903, 0.0, 1.0);
    return vec3(1) + metallic * float(1 - grazing) * (surface.color - vec3(1));
}

/// The share of light that a boundary reflects, the mean of both polarisations.
static double fresnel_share(double cosine, double ior) {
    const double g_square = ior * ior + cosine * cosine - 1;
    if (!(g_square > 0))
        return 1;
    const double g = std::sqrt(g_square);
    const double a = (g - cosine) / (g + cosine);
    const double b = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1);
    return 0.5 * a * a * (1 + b * b);
}

static vec3 reflected_share(const SurfacePoint& surface) {
    const Finish& finish = *surface.material->finish;
    if (finish.reflection == vec3(0) && finish.grazing_reflection == vec3(0))
        return vec3(0);
    const double cosine = std::abs(glm::dot(surface.view, surface.normal));
    const double inside = surface.material->ior / surface.ior_around;
    const double grazing = finish.fresnel
                               ? fresnel_share(cosine, surface.entering ? inside : 1 / inside)
                               : std::pow(1 - cosine, double(finish.reflection_falloff));
    return surface.maps.gloss() *
           glm::mix(finish.reflection, finish.grazing_reflection, float(grazing)) *
           metallic_tint(surface, finish.metallic_reflection, cosine);
}

static double highlight(const SurfacePoint& surface, const dvec3& towards) {
    const Finish& finish = *surface.material->finish;
    double sum = 0;
    if (finish.phong > 0) {
        const dvec3 mirrored =
            surface.view - 2 * glm::dot(surface.view, surface.normal) * surface.normal;
        const double cosine = glm::dot(mirrored, towards);
        sum += cosine > 0 ? finish.phong * std::pow(cosine, double(finish.phong_size)) : 0;
    }
    if (finish.specular > 0) {
        const dvec3 half_way = towards - surface.view;
        const double cosine = glm::dot(half_way, surface.normal) / glm::length(half_way);
        sum += cosine > 0 ? finish.specular * std::pow(cosine, 1 / double(finish.roughness)) : 0;
    }
    return sum;
}

float brilliant(const Finish& finish, double cosine) {
    return float(finish.brilliance == 1 ? cosine : std::pow(cosine, double(finish.brilliance)));
}

/// Hash: Steele, Lea and Flood 2014, SplitMix64.
float random_share(const dvec3& at) {
    uint64_t bits = 0;
    for (int i = 0; i < 3; ++i) {
        bits = (bits ^ std::bit_cast<uint64_t>(at[i])) + 0x9e3779b97f4a7c15u;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
        bits ^= bits >> 31;
    }
    return float(bits >> 40) * 0x1p-24f;
}

/// What a thin film on the surface makes of a lamp's light: the waves that its two sides reflect
/// amplify or cancel each other. povray's light has this formula.
static vec3 interference(const SurfacePoint& surface, double light_cosine) {
    constexpr Octaves kOctaves{2, 0.5, 5};
    const Finish& finish = *surface.material->finish;
    double thickness = finish.irid_thickness;
    if (finish.irid_turbulence != 0)
        thickness *=
            1 + double(finish.irid_turbulence) *
                    (2 * scalar_turbulence(surface.position, kOctaves, finish.irid_noise) - 1);
    const double way =
        thickness * (light_cosine + std::abs(glm::dot(surface.view, surface.normal)));
    vec3 factor;
    for (int i = 0; i < 3; ++i)
        factor[i] = 1 + finish.irid * float(std::cos(2 * std::numbers::pi * way /
                                                     double(finish.irid_wavelengths[i])));
    return factor;
}

vec3 finish_light(const SurfacePoint& surface, const dvec3& towards, const vec3& arriving,
                  bool highlights) {
    const Finish& finish = *surface.material->finish;
    const double cosine = glm::dot(surface.normal, towards);
    const float grain = finish.crand > 0 ? finish.crand * random_share(surface.position) : 0;
    vec3 light =
        surface.color * (surface.opacity * (finish.diffuse * brilliant(finish, cosine) - grain));
    if (highlights)
        light += surface.maps.gloss() * metallic_tint(surface, finish.metallic, cosine) *
                 float(highlight(surface, towards));
    if (finish.irid != 0)
        light *= interference(surface, cosine);
    return light * arriving;
}

Branches finish_branches(const SurfacePoint& surface, bool total) {
    if (total) // POV-Ray's glass then dims nothing, whatever it reflects and lets through otherwise
        return {vec3(1), vec3(0)};
    Branches parts;
    parts.through = surface.through;
    if (surface.coats.empty())
        parts.mirror = reflected_share(surface);
    for (const Coat& coat : surface.coats)
        parts.mirror += coat.share * reflected_share(coat.surface);
    if (surface.material->finish->conserve_energy)
        parts.through *= glm::clamp(vec3(1) - parts.mirror, vec3(0), vec3(1));
    return parts;
}

} // namespace ovc
