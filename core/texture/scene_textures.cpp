// SPDX-License-Identifier: Apache-2.0
// Finds the textures and materials of a scene that lie on texture coordinates.
#include "core/scene.h"

namespace ovc {

std::vector<bool> textures_on_uv(std::span<const Texture> textures,
                                 const std::vector<bool>& mixes) {
    assert(mixes.size() == textures.size());
    std::vector<bool> on_uv(textures.size());
    for (size_t t = 0; t < textures.size(); ++t) {
        on_uv[t] = textures[t].on_uv;
        for (const TextureStop& stop : textures[t].stops)
            if (!mixes[t] && stop.texture != kNoTexture && on_uv[stop.texture])
                on_uv[t] = true;
    }
    return on_uv;
}

std::vector<bool> materials_on_uv(const Scene& scene) {
    std::vector<bool> mixes(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.mix)
            mixes[material.mix->texture] = true;
    const std::vector<bool> on_uv = textures_on_uv(scene.textures, mixes);
    std::vector<bool> wanted(scene.materials.size());
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const MaterialMaps maps = material.maps.value_or(MaterialMaps{});
        for (const uint32_t map : {maps.reflection, maps.width, maps.emission, maps.metallic})
            wanted[m] = wanted[m] || (map != kNone && on_uv[map]);
        wanted[m] = wanted[m] || (material.texture && on_uv[material.texture->texture]) ||
                    (material.normal_map && !scene.textures.empty() &&
                     material.normal_map->kind != NormalMap::Kind::Space) ||
                    (material.bump && on_uv[material.bump->pattern.texture]) ||
                    (material.under != kNone && wanted[material.under]);
        if (material.mix)
            wanted[m] = wanted[m] || on_uv[material.mix->texture];
        if (material.mix)
            for (const TextureStop& stop : scene.textures[material.mix->texture].stops)
                wanted[m] = wanted[m] || wanted[stop.texture];
    }
    return wanted;
}

} // namespace ovc
