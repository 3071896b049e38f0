// SPDX-License-Identifier: Apache-2.0
// Materials: pbrt's, mapped to Whitted's. docs/reference/pbrt.md has the table.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/look/textures.h"

#include <unordered_map>

namespace ovc::pbrt {

class Materials {
public:
    Materials(const Textures& textures, Diagnostics& diagnostics)
        : textures_(textures), diagnostics_(diagnostics) {}

    /// The material of a Material directive, as an index into all(); equal ones are one.
    uint32_t make(const std::string& type, const Parameters& parameters, const Place& place);
    /// MakeNamedMaterial, and NamedMaterial (which warns where there is none of that name).
    void define(const std::string& name, const Parameters& parameters, const Place& place);
    uint32_t named(const std::string& name, const Place& place);
    /// The material `surface`, sending out light of this radiance.
    uint32_t emitter(uint32_t surface, const vec3& radiance, bool two_sided);

    const std::vector<Material>& all() const { return all_; }
    std::vector<Material> take() { return std::move(all_); }

private:
    Material mapped(const std::string& type, const Parameters& parameters, const Place& place);
    Material mix(const Parameters& parameters, const Place& place);
    uint32_t add(Material material);

    const Textures& textures_;
    Diagnostics& diagnostics_;
    std::vector<Material> all_{Material{"matte", vec3(0.5f)}}; // the first: before any Material
    std::unordered_map<std::string, uint32_t> named_;
    std::unordered_multimap<std::string, uint32_t> by_key_; // of all_, to find equals
};

/// Whether nothing of it is seen: only the border of a medium.
bool is_invisible(const Material& material);
/// Whether it sends out light.
bool is_emitter(const Material& material);

} // namespace ovc::pbrt
