// SPDX-License-Identifier: Apache-2.0
// Materials maps pbrt's materials to Whitted's, as the table in docs/reference/pbrt.md says.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/interpret/scoped_names.h"
#include "importers/pbrt/look/lights.h"
#include "importers/pbrt/look/textures.h"

#include <unordered_map>

namespace ovc::pbrt {

class Materials {
public:
    Materials(Textures& textures, Diagnostics& diagnostics)
        : textures_(textures), diagnostics_(diagnostics) {}

    /// Returns the material of a Material directive, as an index into all(); equal materials share
    /// one.
    uint32_t make(const std::string& type, const Parameters& parameters, const Place& place);
    /// Does what MakeNamedMaterial says.
    void define(const std::string& name, const Parameters& parameters, const Place& place);
    /// Returns the material of NamedMaterial; warns and returns the first if there is none of that
    /// name.
    uint32_t named(const std::string& name, const Place& place);
    size_t begin_scope() const { return named_.begin(); }
    /// Ends the scope for which begin_scope() returned `begin`.
    void end_scope(size_t begin) { named_.end(begin); }
    /// Returns the material `surface` with an emission of this radiance.
    uint32_t emitter(uint32_t surface, const Emission& emission, const vec3& radiance,
                     const Place& place);

    /// Returns the material with an inside that absorbs so much light per length, some above 0.
    uint32_t filled(uint32_t glass, const vec3& absorbed);

    const std::vector<Material>& all() const { return all_; }
    /// Returns the texture that says where the material has holes; kNoTexture: it has none.
    uint32_t holes(uint32_t material) const { return holes_[material]; }
    /// Returns whether the material has a use for texture coordinates.
    bool wants_uv(uint32_t material) const { return wants_uv_[material]; }
    std::vector<Material> take() { return std::move(all_); }

private:
    /// A material that is to get its name, and its holes().
    struct Mapped {
        Material material;
        uint32_t holes = kNoTexture;
        uint32_t mixes = 0; // that it is made of
    };

    Mapped mapped(const std::string& type, const Parameters& parameters, const Place& place);
    Mapped mix(const Parameters& parameters, const Place& place);
    vec3 amount_of(const Parameters& parameters) const;
    Material mixed(const Material& a, const Material& b, const Parameters& parameters);
    uint32_t mixed_holes(uint32_t a, uint32_t b, const Parameters& parameters, const Place& place);
    uint32_t add(Mapped made);
    bool is_on_uv(const Material& material) const;

    Textures& textures_;
    Diagnostics& diagnostics_;
    std::vector<Material> all_{Material{"matte", vec3(0.5f)}}; // the first before any Material
    std::vector<uint32_t> holes_{kNoTexture};                  // of each material
    std::vector<uint32_t> mixes_{0};                           // that each is made of
    std::vector<bool> wants_uv_{false};
    ScopedNames<uint32_t> named_;
    std::unordered_multimap<std::string, uint32_t> by_key_; // indices into all_, to find equals
};

/// Returns whether nothing of the material is seen: it is only the border of a medium.
bool is_invisible(const Material& material);
/// Returns whether the material is the surface of glass.
bool is_clear(const Material& material);

} // namespace ovc::pbrt
