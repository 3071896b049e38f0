// SPDX-License-Identifier: Apache-2.0
// Lights are chosen by their power, with a binary search in the running sums of their chances.
#include "host/shade/lights/light_sampler.h"

#include "core/texture/luminance.h"
#include "core/texture/pattern.h"
#include "host/shade/lights/thrown_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ovc {

/// A shadow ray ends here, so that its emitter is not in its way. For doubles 2^-48 less than 1
/// would do, but some backends take rays in float.
static constexpr double kBeforeEmitter = 1 - 0x1p-16;
/// About so many triangles are sampled to measure the scene.
static constexpr uint64_t kMeasured = 4096;
/// The places of a triangle where its map is looked at, along each side: more where a mesh has few
/// triangles.
static constexpr int kMapLooks = 5;
static constexpr uint32_t kFewTriangles = 10000;

static dvec3 area_normal(const Triangle& t) {
    return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
}

/// Returns the box of a sample of the scene's triangles.
static Box measured(const Soup& soup) {
    Box box;
    const uint64_t step = soup.triangle_count() / kMeasured + 1;
    uint64_t number = 0;
    for (const Chunk& chunk : soup.chunks) {
        for (uint64_t p = (step - number % step) % step; p < chunk.size(); p += step)
            if (const Triangle t = chunk.triangle(uint32_t(p)); is_finite(t[0]))
                box.add(t[0]);
        number += chunk.size();
    }
    return box;
}

LightSampler::LightSampler(const Scene& scene, const vec3& up, bool with_cutouts)
    : scene_(scene),
      up_(up),
      cutouts_(scene, Cutouts::Asked::ByPaths),
      with_cutouts_(with_cutouts),
      sky_sampler_(scene, up) {
    const Box box = measured(scene.soup);
    const dvec3 middle = box.empty() ? dvec3(0) : box.center();
    const double reach = box.empty() ? 1 : std::max(0.5 * glm::length(box.extent()), 1e-30);
    add_lights(middle, reach);
    add_emitters(reach);
    add_sky();
    share_with_the_weak();
}

/// Adds lights by the light that they bring to the middle of the scene, from no nearer than its
/// reach.
void LightSampler::add_lights(const dvec3& middle, double reach) {
    for (const Light& light : scene_.lights) {
        Light bare = light;
        bare.cone.reset();
        const dvec3 there = middle - light.position;
        const double distance = glm::length(there);
        const dvec3 at = distance > reach ? middle : light.position + dvec3(0, 0, reach);
        const double power =
            light.stand_in ? 0 : std::max(luminance(light_at(bare, at).color), 0.0);
        has_lights_ |= power > 0;
        sums_.push_back(sums_.back() + (std::isfinite(power) ? power : 0));
    }
}

/// Adds emitters by the light that they bring over the scene's reach, seen from the front.
void LightSampler::add_emitters(double reach) {
    emitters_of_.assign(scene_.meshes.size(), kNone);
    for (uint32_t m = 0; m < scene_.meshes.size(); ++m) {
        const uint32_t material = scene_.meshes[m].material;
        if (material >= scene_.materials.size() || !scene_.materials[material].optics)
            continue;
        const Optics& optics = *scene_.materials[material].optics;
        const double power = luminance(optics.emission) / (reach * reach);
        if (!(power > 0) || !std::isfinite(power))
            continue;
        emitters_of_[m] = uint32_t(emitters_.size());
        const Chunk& chunk = scene_.soup.chunks[m];
        const bool is_unseen = chunk.mask() != 0 && !(chunk.mask() & kSeenInReflections);
        const auto& maps = scene_.materials[material].maps;
        emitters_.push_back({m, sums_.size() - 1, optics.two_sided, is_unseen, optics.emission,
                             maps ? maps->emission : kNone});
        for (uint32_t p = 0; p < chunk.size(); ++p) {
            const double area = glm::length(area_normal(chunk.triangle(p)));
            const double share = mean_of_map(emitters_.back(), p);
            sums_.push_back(sums_.back() + (std::isfinite(area) ? power * area * share : 0));
        }
    }
}

/// Returns the mean of a triangle's map at some places, by brightness. The light of a triangle that
/// is dark at all of them is left to the paths that find it.
double LightSampler::mean_of_map(const Emitters& emitters, uint32_t prim) const {
    if (emitters.map == kNone)
        return 1;
    const int looks = scene_.soup.chunks[emitters.mesh].size() > kFewTriangles ? 1 : kMapLooks;
    double sum = 0, all = luminance(emitters.radiance);
    int count = 0;
    for (int i = 0; i < looks; ++i)
        for (int j = 0; i + j < looks; ++j, ++count) {
            const dvec3 weights = (dvec3(i, j, looks - 1 - i - j) + 1.0 / 3) / double(looks);
            sum += luminance(radiance_at(emitters, {emitters.mesh, prim}, weights));
        }
    return std::isfinite(sum) ? sum / (count * all) : 0;
}

/// Returns the radiance of a place of an emitter, by the weights of the triangle's corners.
vec3 LightSampler::radiance_at(const Emitters& emitters, TriangleId id,
                               const dvec3& weights) const {
    if (emitters.map == kNone)
        return emitters.radiance;
    const Triangle t = scene_.soup.triangle(id);
    TexturePoint place(weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2]);
    if (const PerCorner<vec2> all = scene_.uv_of(scene_.meshes[id.mesh]); !all.empty()) {
        const std::array<vec2, 3> uv = all.of(id.prim);
        place.has_uv = true;
        place.uv =
            weights[0] * dvec2(uv[0]) + weights[1] * dvec2(uv[1]) + weights[2] * dvec2(uv[2]);
    }
    return emitters.radiance *
           glm::max(color_at(scene_.textures, emitters.map, place).rgb, vec3(0));
}

/// Adds the sky by the light that it brings to a surface which sees half of it.
void LightSampler::add_sky() {
    if (!sky_sampler_.shines())
        return;
    sky_ = sums_.size() - 1;
    sums_.push_back(sums_.back() + std::numbers::pi * sky_sampler_.mean() / scene_.exposure);
}

/// Half of the choices go by power, the others to all lights and emitting meshes alike: a weak one
/// nearby may light places that a strong one does not reach.
void LightSampler::share_with_the_weak() {
    std::vector<size_t> first(scene_.lights.size());
    std::iota(first.begin(), first.end(), size_t(0));
    for (const Emitters& emitters : emitters_)
        first.push_back(emitters.first);
    if (sky_sampler_.shines())
        first.push_back(sky_);
    first.push_back(sums_.size() - 1);
    const std::vector<double> powers = sums_;
    const auto power = [&](size_t group) {
        return powers[first[group + 1]] - powers[first[group]];
    };
    double shining = 0;
    for (size_t group = 0; group + 1 < first.size(); ++group)
        shining += power(group) > 0;
    for (size_t group = 0; group + 1 < first.size(); ++group) {
        const double scale =
            power(group) > 0 ? 1 / powers.back() + 1 / (shining * power(group)) : 0;
        for (size_t i = first[group]; i < first[group + 1]; ++i)
            sums_[i + 1] = sums_[i] + scale * (powers[i + 1] - powers[i]);
    }
}

std::optional<Arriving> LightSampler::sample(const SurfacePoint& surface, double choice,
                                             const dvec2& u) const {
    if (!(sums_.back() > 0))
        return std::nullopt;
    // The last light whose sum before it is at most `at` is never one without power.
    const double at = std::min(choice * sums_.back(), std::nextafter(sums_.back(), 0.0));
    const size_t i = size_t(std::upper_bound(sums_.begin(), sums_.end(), at) - sums_.begin()) - 1;
    if (i < scene_.lights.size())
        return from_light(uint32_t(i), surface);
    if (i == sky_)
        return from_sky(surface, u);
    const auto next = std::upper_bound(emitters_.begin(), emitters_.end(), i,
                                       [](size_t n, const Emitters& e) { return n < e.first; });
    return from_emitter(next[-1], i, surface, u);
}

std::optional<Arriving> LightSampler::from_light(uint32_t number,
                                                 const SurfacePoint& surface) const {
    if (!surface.lit_by.includes(scene_.lights[number].group))
        return std::nullopt;
    FromLight from = light_at(scene_.lights[number], surface.position);
    from.color *= thrown_color(scene_, scene_.lights[number], surface.position);
    if (from.towards == dvec3(0) || from.color == vec3(0))
        return std::nullopt;
    return Arriving{shadow_ray(scene_.lights[number], surface.position), from.towards,
                    from.color / float(chance(number)), 0, number};
}

/// Uniform in the triangle: Turk 1990, "Generating Random Points in Triangles".
std::optional<Arriving> LightSampler::from_emitter(const Emitters& emitters, size_t i,
                                                   const SurfacePoint& surface,
                                                   const dvec2& u) const {
    const Triangle t = scene_.soup.chunks[emitters.mesh].triangle(uint32_t(i - emitters.first));
    const dvec3 across = area_normal(t);
    const double area = glm::length(across);
    const double root = std::sqrt(u.x);
    const dvec3 weights(1 - root, root * (1 - u.y), root * u.y);
    const dvec3 place = weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2];
    const dvec3 there = place - surface.position;
    const double distance = glm::length(there);
    if (!(distance > 0))
        return std::nullopt;
    const dvec3 towards = there / distance;
    const double cosine = -glm::dot(towards, across) / area; // to the front
    // The shadow ray ends before the emitter, so that nobody asks about its holes there.
    const TriangleId id{emitters.mesh, uint32_t(i - emitters.first)};
    const float there_is = with_cutouts_ ? cutouts_.opacity_at(id, weights[1], weights[2]) : 1;
    if (!(cosine > 0 || (emitters.two_sided && cosine < 0)) || there_is == 0)
        return std::nullopt;
    const double density = chance(i) / area * distance * distance / std::abs(cosine);
    return Arriving{{surface.position, 0, there, kBeforeEmitter},
                    towards,
                    there_is * radiance_at(emitters, id, weights) / float(density),
                    emitters.is_unseen ? 0 : density,
                    kNone};
}

std::optional<Arriving> LightSampler::from_sky(const SurfacePoint& surface, const dvec2& u) const {
    const SkySample sky = sky_sampler_.sample(u);
    const double density = chance(sky_) * sky.density;
    const vec3 radiance = background_color(scene_, up_, sky.direction);
    return Arriving{{surface.position, 0, sky.direction},
                    sky.direction,
                    radiance / float(density),
                    density,
                    kNone};
}

double LightSampler::sky_density(const dvec3& direction) const {
    return sky_sampler_.shines() ? chance(sky_) * sky_sampler_.density(direction) : 0;
}

double LightSampler::density(TriangleId id, double distance, double cosine) const {
    assert(id.mesh < emitters_of_.size());
    const uint32_t number = emitters_of_[id.mesh];
    if (number == kNone || !(std::abs(cosine) > 0))
        return 0;
    const double area = glm::length(area_normal(scene_.soup.triangle(id)));
    return chance(emitters_[number].first + id.prim) / area * distance * distance /
           std::abs(cosine);
}

} // namespace ovc
