// SPDX-License-Identifier: Apache-2.0
// Textures replaces each texture by its mean, because no material of ours has a texture.
#pragma once

#include "importers/pbrt/look/spectrum.h"

#include <unordered_map>

namespace ovc::pbrt {

class Textures {
public:
    explicit Textures(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    /// Adds the texture of a Texture directive, with its class as `type` ("scale"). Warns of a
    /// pattern, but not of floats, which Alphas may evaluate.
    void define(const std::string& name, bool is_float, const std::string& type,
                const Parameters& parameters, const Place& place);
    /// Warns that textures of this class are shown by their mean.
    void tell_mean(const std::string& type, const Place& place) const;

    /// Returns the colour that a parameter states, or the mean of the texture that it names;
    /// `otherwise` without either.
    vec3 color(const Parameters& parameters, std::string_view name, const vec3& otherwise) const;
    double number(const Parameters& parameters, std::string_view name, double otherwise) const;
    /// Returns whether the parameter names a texture that is not the same all over. Masks made of
    /// such patterns are better not used.
    bool is_pattern(const Parameters& parameters, std::string_view name) const;

private:
    struct Mean {
        vec3 color;
        bool is_pattern;
    };

    vec3 mean(const std::string& type, const Parameters& parameters) const;

    Diagnostics& diagnostics_;
    std::unordered_map<std::string, Mean> means_;
};

} // namespace ovc::pbrt
