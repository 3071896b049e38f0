// SPDX-License-Identifier: Apache-2.0
// Tiles: plans how many there are and how large, fills and binds them.
#include "plugin/thesis/tiles.h"

#include "core/text/format_text.h"
#include "shaders/layout.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace ovc::thesis {

TilePlan plan_tiles(uint64_t texels, uint32_t textures) {
    assert(texels > 0 && textures > 0);
    const uint32_t enough = uint32_t(std::bit_width(texels - 1)); // for one texture
    const uint64_t share = std::max<uint64_t>(texels / textures, 1);
    const uint32_t bits = textures == 1 ? enough : uint32_t(std::bit_width(share) - 1);
    TilePlan plan;
    plan.bits = std::min(bits, kTextureBits);
    plan.shift = (plan.bits + 1) / 2;
    plan.texels = texels;
    return plan;
}

uint32_t TilePlan::height(uint32_t tile) const {
    assert(tile < count());
    const uint64_t rest = texels - (uint64_t(tile) << bits);
    const uint64_t here = std::min(rest, uint64_t(1) << bits);
    return uint32_t((here + width() - 1) >> shift);
}

uint64_t TilePlan::bytes() const {
    uint64_t sum = 0;
    for (uint32_t tile = 0; tile < count(); ++tile)
        sum += tile_bytes(tile);
    return sum;
}

std::string TilePlan::defines() const {
    return format_text(
        "#define OVC_TILES {}\n#define OVC_TILE_BITS {}\n#define OVC_TILE_SHIFT {}\n", count(),
        bits, shift);
}

Tiles::Tiles(Ledger& ledger, const TilePlan& plan, Texels texels) {
    assert(texels.size() == plan.texels);
    texels.resize((texels.size() + plan.width() - 1) >> plan.shift << plan.shift); // whole rows
    for (uint32_t tile = 0; tile < plan.count(); ++tile) {
        const uint32_t height = plan.height(tile);
        textures_.emplace_back(ledger, GL_RGBA32UI, sizeof(uvec4), plan.width(), height, "scene");
        glTextureSubImage2D(textures_.back().id(), 0, 0, 0, GLsizei(plan.width()), GLsizei(height),
                            GL_RGBA_INTEGER, GL_UNSIGNED_INT, &texels[size_t(tile) << plan.bits]);
    }
}

void Tiles::bind() const {
    for (size_t tile = 0; tile < textures_.size(); ++tile)
        glBindTextureUnit(GLuint(OVC_BINDING_SCENE + tile), textures_[tile].id());
}

} // namespace ovc::thesis
