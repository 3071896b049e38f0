// SPDX-License-Identifier: Apache-2.0
// Alphas turns the float textures that shapes name as their alpha into cutouts.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/interpret/scoped_names.h"
#include "importers/pbrt/look/textures.h"

#include <map>

namespace ovc::pbrt {

/// The effect of a parameter such as alpha on a shape.
struct Alpha {
    bool is_zero = false;    // nothing is there
    uint32_t cutout = kNone; // index into what take() returns; kNone: no holes
};

class Alphas {
public:
    Alphas(const Textures& textures, const Tokens& tokens, Diagnostics& diagnostics)
        : textures_(textures), tokens_(tokens), diagnostics_(diagnostics) {}

    /// Notes the texture of a Texture directive of floats, with its class as `type`. A picture is
    /// read only once a shape names the texture.
    void define(const std::string& name, const std::string& type, const Parameters& parameters,
                const Place& place);

    size_t begin_scope() const { return patterns_.begin(); }
    /// Ends the scope for which begin_scope() returned `begin`. Textures::end_scope() comes after
    /// it.
    void end_scope(size_t begin);

    /// Returns the alpha that the parameter of a shape states. Warns of what is not evaluated,
    /// which then makes no holes.
    Alpha of(const Parameters& parameters, std::string_view name);

    /// Returns the cutout of a texture of the scene; kNone: there is no such texture.
    uint32_t of_texture(uint32_t texture);

    /// Returns all cutouts, and warns of patterns that no alpha is made of. partial: as in Cutout.
    std::vector<Cutout> take(bool partial);

private:
    /// A texture whose opacity is not filled in before `made` is its index.
    struct Pattern {
        std::string type;
        std::string scales; // the name of the texture that this one is a multiple of, or empty
        Cutout cutout;
        std::string picture; // its file; empty: the opacity is there
        bool inverted = false;
        bool linear = false; // the picture's samples are no sRGB codes
        std::string refused; // the reason why it cannot be a cutout
        Place place;
        bool used = false;            // a shape has named it, or a multiple of it
        std::optional<uint32_t> made; // an index into cutouts_, or kNone where that failed
    };

    Pattern image_map(const Parameters& parameters) const;
    Pattern checkerboard(const Parameters& parameters) const;
    Pattern scaled(const Parameters& parameters) const;
    uint32_t make(Pattern& pattern);
    bool read_picture(Pattern& pattern);
    void tell_unless_used(const std::string& name, const Pattern& pattern) const;

    const Textures& textures_;
    const Tokens& tokens_;
    Diagnostics& diagnostics_;
    ScopedNames<Pattern> patterns_;
    std::map<double, uint32_t> constants_;  // the cutouts of constant alphas
    std::map<uint32_t, uint32_t> textured_; // those of textures of the scene
    std::vector<Cutout> cutouts_;
};

} // namespace ovc::pbrt
