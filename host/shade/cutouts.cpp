// SPDX-License-Identifier: Apache-2.0
#include "host/shade/cutouts.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {

namespace {

/// Returns the number of the texel that stands for number i of a row of `size`; `size` or more for
/// a hole. i is a whole number, perhaps far outside of the row.
uint32_t texel_number(double i, uint32_t size, Cutout::Beyond beyond) {
    if (i >= 0 && i < size)
        return uint32_t(i);
    if (beyond == Cutout::Beyond::Hole)
        return size;
    if (beyond == Cutout::Beyond::Clamp)
        return i < 0 ? 0 : size - 1;
    return uint32_t(i - size * std::floor(i / size)) % size;
}

float texel(const Cutout& cutout, double x, double y) {
    const uint32_t column = texel_number(x, cutout.width, cutout.beyond);
    const uint32_t row = texel_number(y, cutout.height, cutout.beyond);
    if (column >= cutout.width || row >= cutout.height)
        return 0;
    return float(cutout.opacity[size_t(row) * cutout.width + column]) / 255.0f;
}

/// Returns the opacity between the middles of four texels.
float smooth_opacity(const Cutout& cutout, const dvec2& at) {
    const dvec2 first = glm::floor(at - 0.5);
    const vec2 share(at - 0.5 - first);
    const float top =
        glm::mix(texel(cutout, first.x, first.y), texel(cutout, first.x + 1, first.y), share.x);
    const float below = glm::mix(texel(cutout, first.x, first.y + 1),
                                 texel(cutout, first.x + 1, first.y + 1), share.x);
    return glm::mix(top, below, share.y);
}

} // namespace

float chance_of(const Hit& hit) {
    uint64_t hash = (uint64_t(hit.id.mesh) << 32) | hit.id.prim;
    for (const double number : {hit.u, hit.v, hit.t}) { // the mixing is SplitMix64's
        hash += std::bit_cast<uint64_t>(number) + 0x9e3779b97f4a7c15u;
        hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
        hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
        hash ^= hash >> 31;
    }
    return float(hash >> 40) * 0x1p-24f;
}

namespace {

/// Returns the share of hits that count where a cutout has this opacity.
float share_that_counts(const Cutout& cutout, float opacity) {
    return opacity > 0 && !cutout.partial ? 1 : opacity;
}

} // namespace

/// Returns the mean color of the cutout's texture, at its finest.
static float opacity_of_texture(const Cutout& cutout, std::span<const Texture> textures,
                                const dvec2& uv) {
    TexturePoint point{dvec3(uv, 0)};
    point.has_uv = true;
    point.uv = uv;
    return float(value_at(textures, cutout.texture, point));
}

static float limited(const Cutout& cutout, float opacity) {
    if (cutout.threshold > 0)
        return opacity >= cutout.threshold ? 1.0f : 0.0f;
    return std::clamp(opacity, 0.0f, 1.0f);
}

float opacity_at(const Cutout& cutout, const dvec2& uv, std::span<const Texture> textures) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
        return 0;
    if (cutout.texture != kNoTexture)
        return limited(cutout, cutout.scale * opacity_of_texture(cutout, textures, uv));
    assert(cutout.width > 0 && cutout.height > 0);
    const dvec2 at = cutout.uv_scale * uv + cutout.uv_offset;
    const dvec2 texels(at.x * cutout.width, (1 - at.y) * cutout.height);
    if (!std::isfinite(texels.x) || !std::isfinite(texels.y))
        return 0;
    const float opacity = cutout.smooth ? smooth_opacity(cutout, texels)
                                        : texel(cutout, std::floor(texels.x), std::floor(texels.y));
    return limited(cutout, cutout.scale * opacity);
}

Cutouts::Cutouts(const Scene& scene, Asked asked)
    : any_(std::ranges::any_of(scene.meshes,
                               [&](const MeshInfo& mesh) {
                                   return mesh.cutout != kNone || (asked == Asked::ByShadowRays &&
                                                                   mesh.shadow_cutout != kNone);
                               })),
      textures_(scene.textures),
      meshes_(any_ ? scene.meshes.size() : 0) {
    const auto cutout = [&](uint32_t i) { return i == kNone ? nullptr : &scene.cutouts[i]; };
    for (size_t m = 0; m < meshes_.size(); ++m) {
        const MeshInfo& mesh = scene.meshes[m];
        const bool by_shadows = asked == Asked::ByShadowRays;
        meshes_[m] = {scene.uv_of(mesh), cutout(mesh.cutout),
                      by_shadows ? cutout(mesh.shadow_cutout) : nullptr};
    }
}

bool Cutouts::keep(std::span<const uint64_t>, std::span<const Hit> hits, std::span<uint8_t> keep) {
    for (size_t i = 0; i < hits.size(); ++i)
        keep[i] = counts(hits[i]);
    return true;
}

float Cutouts::opacity_at(TriangleId id, double u, double v) const {
    return any_ ? opacity_of(meshes_[id.mesh], meshes_[id.mesh].all, id, u, v) : 1;
}

/// cutout: of the mesh; null: no holes.
float Cutouts::opacity_of(const OfMesh& mesh, const Cutout* cutout, TriangleId id, double u,
                          double v) const {
    if (!cutout)
        return 1;
    const std::array<vec2, 3> uv = mesh.uv.of(id.prim);
    const dvec2 at = (1 - u - v) * dvec2(uv[0]) + u * dvec2(uv[1]) + v * dvec2(uv[2]);
    return share_that_counts(*cutout, ovc::opacity_at(*cutout, at, textures_));
}

bool Cutouts::counts(const Hit& hit) const {
    assert(hit.id.mesh < meshes_.size());
    const OfMesh& mesh = meshes_[hit.id.mesh];
    return std::ranges::all_of(std::array{mesh.all, mesh.shadow}, [&](const Cutout* cutout) {
        const float opacity = opacity_of(mesh, cutout, hit.id, hit.u, hit.v);
        return opacity >= 1 || (opacity > 0 && chance_of(hit) < opacity);
    });
}

} // namespace ovc
