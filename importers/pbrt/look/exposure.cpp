// SPDX-License-Identifier: Apache-2.0
// The exposure is a mean over a sample of the triangles in view, weighed by their size in the
// picture.
#include "importers/pbrt/look/exposure.h"

#include "core/texture/luminance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace ovc::pbrt {

namespace {

constexpr uint64_t kSamples = 20000;

/// A mean radiance from kDarkest to kBrightest stays; any other is brought to kWanted. A picture of
/// mean 0.2 looks like most photographs do.
constexpr double kDarkest = 0.02, kBrightest = 0.6, kWanted = 0.25;
constexpr double kMaxExposure = 1e30; // colors times this are floats

/// Returns the triangle's area in the picture, in units of its window; 0 if it is out of view.
double weight_in(const Camera& camera, const Triangle& t, const dvec3& middle) {
    assert(camera.window);
    const ImageWindow& w = *camera.window;
    const dvec3 there = middle - camera.eye;
    if (w.bend != ImageWindow::Bend::Flat) { // all around
        const double distance = glm::length(there);
        const dvec3 across = 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
        const double area = std::abs(glm::dot(across, there));
        return distance > 0 ? std::min(area / (distance * distance * distance), 1.0) : 0;
    }
    const dvec3 forward = glm::normalize(w.direction);
    const double depth = glm::dot(there, forward);
    if (!(depth > 0))
        return 0;
    const double scale = w.orthographic ? 1 : glm::length(w.direction) / depth;
    const dvec3 seen = w.orthographic ? there : there * scale - w.direction;
    const double x = glm::dot(seen, w.right) / glm::dot(w.right, w.right);
    const double y = glm::dot(seen, w.up) / glm::dot(w.up, w.up);
    if (std::abs(x) > 0.5 || std::abs(y) > 0.5)
        return 0;
    const dvec3 normal = 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
    const double facing =
        std::abs(glm::dot(normal, w.orthographic ? forward : glm::normalize(there)));
    return std::min(facing * scale * scale, glm::length(glm::cross(w.right, w.up)));
}

/// Returns the light that arrives, as the host shades it and core/scene.h describes at Light.
vec3 arriving(const Light& light, const dvec3& at, const dvec3& normal) {
    const dvec3 there = light.parallel ? -light.direction : light.position - at;
    const double distance = glm::length(there);
    if (!(distance > 0))
        return vec3(0);
    const dvec3 towards = there / distance;
    double share = std::abs(glm::dot(towards, normal));
    if (light.cone) {
        const double cosine = -glm::dot(towards, light.direction);
        if (cosine <= light.cone->falloff_cosine)
            return vec3(0);
        share *= std::pow(cosine, light.cone->tightness);
    }
    // The window is taken as square, because the picture is not open.
    if (light.thrown && light.thrown->has_window &&
        !ThrownPicture::through_window(glm::normalize(light.thrown->texture.at(-towards)), 1))
        return vec3(0);
    if (light.fade_distance > 0)
        share *= 2 / (1 + std::pow(distance / light.fade_distance, light.fade_power));
    return light.color * float(share * std::numbers::inv_pi);
}

/// A light lights one side of a triangle, and we do not know which side the camera sees, so we
/// count half of the light.
double radiance_of(const Scene& scene, const Material& material, const Triangle& t,
                   const dvec3& middle) {
    const dvec3 across = glm::cross(t[1] - t[0], t[2] - t[0]);
    const dvec3 normal = across / glm::length(across);
    vec3 light(0);
    for (const Light& source : scene.lights)
        light += 0.5f * arriving(source, middle, normal);
    const float diffuse = material.finish ? material.finish->diffuse : 1;
    const vec3 ambient = material.finish ? material.finish->ambient : vec3(0);
    return luminance(material.color * (diffuse * light + ambient));
}

} // namespace

ExposureMeter::ExposureMeter(const Scene& scene, uint64_t triangles)
    : scene_(scene), step_(triangles / kSamples + 1) {}

void ExposureMeter::add(const Chunk& chunk, const Material& material) {
    const bool can_see = scene_.camera && scene_.camera->window && !scene_.lights.empty();
    const bool is_lit = can_see && (!material.finish || material.finish->diffuse > 0);
    for (uint64_t p = (step_ - number_ % step_) % step_; is_lit && p < chunk.size(); p += step_) {
        const Triangle t = chunk.triangle(uint32_t(p));
        const dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
        const double weight =
            triangle_fault(t) == TriangleFault::None ? weight_in(*scene_.camera, t, middle) : 0;
        if (!(weight > 0))
            continue;
        sum_ += weight * radiance_of(scene_, material, t, middle);
        weights_ += weight;
    }
    number_ += chunk.size();
}

float ExposureMeter::exposure() const {
    const double mean = weights_ > 0 ? sum_ / weights_ : 0;
    if (!(mean > 0) || (mean >= kDarkest && mean <= kBrightest))
        return 1;
    return float(std::min(kWanted / mean, kMaxExposure));
}

float fitting_exposure(const Scene& scene) {
    assert(scene.meshes.size() == scene.soup.chunks.size());
    ExposureMeter meter(scene, scene.soup.triangle_count());
    for (size_t m = 0; m < scene.soup.chunks.size(); ++m)
        meter.add(scene.soup.chunks[m], scene.materials[scene.meshes[m].material]);
    return meter.exposure();
}

void expose(Scene& scene, const vec3& exposure) {
    for (Light& light : scene.lights)
        light.color *= exposure;
    scene.background.horizon *= exposure;
    scene.background.zenith *= exposure;
    for (const PlacedTexture& layer : scene.background.layers)
        if (auto& image = scene.textures[layer.texture].image)
            image->scale *= exposure;
    for (Material& material : scene.materials) {
        if (material.finish && material.finish->diffuse == 0)
            material.finish->ambient *= exposure;
        if (material.optics)
            material.optics->emission *= exposure;
    }
}

} // namespace ovc::pbrt
