// SPDX-License-Identifier: Apache-2.0
// Textures: each stands for its mean, for no material of ours has a texture.
#pragma once

#include "importers/pbrt/look/spectrum.h"

#include <unordered_map>

namespace ovc::pbrt {

class Textures {
public:
    explicit Textures(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    /// A Texture directive: its class ("scale"), and what that is made of.
    void define(const std::string& name, const std::string& type, const Parameters& parameters,
                const Place& place);

    /// The colour that a parameter gives, itself or by the name of a texture.
    vec3 color(const Parameters& parameters, std::string_view name, const vec3& otherwise) const;
    double number(const Parameters& parameters, std::string_view name, double otherwise) const;
    /// Whether that colour is not the same all over: masks made of patterns are better not used.
    bool is_pattern(const Parameters& parameters, std::string_view name) const;

private:
    struct Mean {
        vec3 color;
        bool is_pattern;
    };

    vec3 mean(const std::string& type, const Parameters& parameters, const Place& place) const;

    Diagnostics& diagnostics_;
    std::unordered_map<std::string, Mean> means_;
};

} // namespace ovc::pbrt
