// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.5.2, "Media") says what a medium is; how strong it is was
// found by asking povray for values.
#include "host/shade/surface/media.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <cmath>

namespace ovc {

bool has_media(const Scene& scene) {
    return !scene.background.media.empty() ||
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return !material.media.empty(); });
}

size_t max_shadow_rays(const Scene& scene) {
    const auto scatterers = [](const std::vector<Medium>& media) {
        return size_t(std::count_if(media.begin(), media.end(), [](const Medium& medium) {
            return medium.scattering != vec3(0);
        }));
    };
    size_t most = scatterers(scene.background.media);
    for (const Material& material : scene.materials)
        most = std::max(most, scatterers(material.media));
    return scene.lights.size() * (1 + most * kMaxMediumSamples);
}

double phase_of(const Medium& medium, double cosine) {
    const double e = double(medium.eccentricity);
    switch (medium.phase) {
    case Medium::Phase::Even:
        break;
    case Medium::Phase::MieHazy:
        return 0.5 + 4.5 * std::pow(0.5 * (1 + cosine), 8);
    case Medium::Phase::MieMurky:
        return 0.5 + 16.5 * std::pow(0.5 * (1 + cosine), 32);
    case Medium::Phase::Rayleigh:
        return 0.75 * (1 + cosine * cosine);
    case Medium::Phase::HenyeyGreenstein:
        return (1 - e * e) / std::pow(1 + e * e - 2 * e * cosine, 1.5);
    }
    return 1;
}

/// Returns the density at a point of the world.
static vec3 density_at(std::span<const Texture> textures, const Medium& medium, const dvec3& at) {
    vec3 density(1);
    for (const PlacedTexture& placed : medium.densities)
        density *= color_at(textures, placed.texture, placed.at(TexturePoint(at))).rgb;
    return glm::max(density, vec3(0));
}

/// Light beyond so many optical depths is not looked for.
constexpr double kDeepest = 16;

/// Returns the share of light that is lost on a unit of length where the density is 1.
static vec3 lost_in(const Medium& medium) {
    return medium.absorption + medium.extinction * medium.scattering;
}

/// Returns the t up to which even media let light through, at most the given one.
static double end_of_sight(std::span<const Medium> media, const Ray& ray, double t) {
    vec3 lost(0);
    for (const Medium& medium : media) {
        if (!medium.densities.empty())
            return t;
        lost += lost_in(medium);
    }
    const double least = double(-max_component(-lost)) * glm::length(ray.dir);
    return least > 0 ? std::min(t, kDeepest / least) : t;
}

vec3 share_through_media(std::span<const Texture> textures, std::span<const Medium> media,
                         const Ray& ray, double t) {
    constexpr uint32_t kPlaces = 8;
    const bool is_even = std::all_of(media.begin(), media.end(),
                                     [](const Medium& medium) { return medium.densities.empty(); });
    const uint32_t places = is_even ? 1 : kPlaces;
    vec3 lost(0);
    for (uint32_t i = 0; i < places; ++i)
        for (const Medium& medium : media)
            lost += density_at(textures, medium, ray.org + (i + 0.5) / places * t * ray.dir) *
                    lost_in(medium);
    return glm::exp(-float(t * glm::length(ray.dir) / places) * lost);
}

/// All media are looked at in the same places, as densely as the one that asks for most.
ThroughMedia through_media(std::span<const Texture> textures, std::span<const Medium> media,
                           const Ray& ray, double t) {
    ThroughMedia all;
    uint32_t samples = 1;
    for (const Medium& medium : media)
        samples = std::clamp(medium.samples, samples, kMaxMediumSamples);
    const double step = end_of_sight(media, ray, t) / samples;
    const float length = float(step * glm::length(ray.dir));
    for (uint32_t i = 0; i < samples && max_component(all.share) > 0; ++i) {
        const dvec3 at = ray.org + (i + 0.5) * step * ray.dir;
        vec3 lost(0), emitted(0);
        const size_t first = all.scattering.size();
        for (const Medium& medium : media) {
            const vec3 density = length * density_at(textures, medium, at);
            lost += density * lost_in(medium);
            emitted += density * medium.emission;
            if (medium.scattering != vec3(0) && density != vec3(0))
                all.scattering.push_back({at, density * medium.scattering, &medium});
        }
        const vec3 here = all.share * glm::exp(-0.5f * lost); // in the middle of the step
        all.added += here * emitted;
        for (size_t s = first; s < all.scattering.size(); ++s)
            all.scattering[s].share *= here;
        all.share *= glm::exp(-lost);
    }
    return all;
}

} // namespace ovc
