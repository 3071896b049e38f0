// SPDX-License-Identifier: Apache-2.0
// Tiles: the scene's texels in one texture, or tiled over several. Based on: thesis, section 3.2.
#pragma once

#include "core/result.h"
#include "gpu/gl/gl_object.h"
#include "plugin/thesis/system.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ovc::thesis {

/// A texture holds 2^bits texels, 2^shift of them in a row; the last has only the rows it needs.
struct TilePlan {
    uint32_t bits = 0;
    uint32_t shift = 0;
    uint64_t texels = 0;

    uint32_t width() const { return 1u << shift; }
    uint32_t count() const { return uint32_t((texels + (uint64_t(1) << bits) - 1) >> bits); }
    uint32_t height(uint32_t tile) const;
    uint64_t tile_bytes(uint32_t tile) const { return uint64_t(width()) * height(tile) * 16; }
    uint64_t bytes() const;
    /// Returns the defines of shaders/thesis/scene_texels.glsl.
    std::string defines() const;
};

inline constexpr uint32_t kTextureBits = 24; // 4096 x 4096 texels, as the thesis has them
inline constexpr uint64_t kTextureBytes = uint64_t(16) << kTextureBits;
inline constexpr uint32_t kMaxTextures = 8; // the look-up's branches

/// Returns a plan for `texels` (> 0) in at least `textures` (> 0) textures, each within
/// kTextureBytes.
TilePlan plan_tiles(uint64_t texels, uint32_t textures);

/// The textures, filled with texels. All calls need the context current.
class Tiles {
public:
    Tiles(Ledger& ledger, const TilePlan& plan, Texels texels);
    /// Binds the textures to units from OVC_BINDING_SCENE on.
    void bind() const;

private:
    std::vector<gl::Texture2D> textures_;
};

} // namespace ovc::thesis
