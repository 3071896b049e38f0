// SPDX-License-Identifier: Apache-2.0
// Each of pbrt's families of materials becomes a Whitted material.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/look/textures.h"

#include <algorithm>

namespace ovc::pbrt {

/// The arguments of a Material directive.
struct MaterialContext {
    Textures& textures;
    const Parameters& p;
    Diagnostics& diagnostics;
    Place place;

    vec3 color(std::string_view name, float otherwise) const {
        return glm::clamp(textures.color(p, name, vec3(otherwise)), vec3(0), vec3(1));
    }
    /// Returns the scene's texture of this name, if it varies; color() is its mean then.
    std::optional<uint32_t> texture(std::string_view name) const {
        return textures.texture(p, name);
    }
    double number(std::string_view name, double otherwise) const {
        return textures.number(p, name, otherwise);
    }
};

/// Returns the material; nothing if the type is unknown or "mix".
std::optional<Material> material_of(std::string_view type, const MaterialContext& context);
/// Returns the texture that says where the material has holes; nothing if it has none.
std::optional<uint32_t> holes_of(std::string_view type, const MaterialContext& context);
Material make_matte(const MaterialContext& context);

/// The share of a constant light from everywhere that we assume a surface sees.
inline constexpr float kAmbient = 0.04f;

inline float mean(const vec3& c) {
    return (c.x + c.y + c.z) / 3;
}

} // namespace ovc::pbrt
