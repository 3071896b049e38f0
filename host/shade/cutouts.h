// SPDX-License-Identifier: Apache-2.0
// Cutouts tells hits on a surface from hits on its holes. It is the filter that a backend asks.
#pragma once

#include "core/scene.h"
#include "core/sieve.h"

#include <span>
#include <vector>

namespace ovc {

/// Returns a number in [0, 1) that differs from hit to hit as if by chance.
float chance_of(const Hit& hit);

class Cutouts final : public HitFilter {
public:
    /// The rays that ask: for shadow rays a mesh may have holes of its own.
    enum class Asked { ByPaths, ByShadowRays };

    /// The scene must outlive it.
    Cutouts(const Scene& scene, Asked asked);

    /// Returns whether any mesh has holes. If none has, nobody need ask.
    bool any() const { return any_; }

    /// Returns the share of hits at a place of a triangle that count.
    float opacity_at(TriangleId id, double u, double v) const;

    /// Whether a hit counts depends on its mesh, prim, u, v and t alone, so that it is the same in
    /// any batch.
    bool keep(std::span<const uint64_t> rays, std::span<const Hit> hits,
              std::span<uint8_t> keep) override;

private:
    /// The holes of a mesh, and where the texture coordinates of its corners lie.
    struct OfMesh {
        PerCorner<vec2> uv{std::span<const vec2>()};
        const Cutout* all = nullptr; // null: no holes
        const Cutout* shadow = nullptr;
    };

    bool counts(const Hit& hit) const;
    float opacity_of(const OfMesh& mesh, const Cutout* cutout, TriangleId id, double u,
                     double v) const;

    const bool any_;
    std::span<const Texture> textures_;
    std::vector<OfMesh> meshes_; // empty where none has holes
};

/// Returns the opacity at the texture coordinates, from 0 to 1; 0 where these are no numbers.
/// textures: of the scene.
float opacity_at(const Cutout& cutout, const dvec2& uv, std::span<const Texture> textures = {});

} // namespace ovc
