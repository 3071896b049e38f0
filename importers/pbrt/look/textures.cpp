// SPDX-License-Identifier: Apache-2.0
// A texture's mean is exact for constants and their mixtures, and a middle grey for unknown
// patterns.
#include "importers/pbrt/look/textures.h"

#include "importers/file/picture_path.h"
#include "importers/file/text.h"
#include "importers/pbrt/interpret/left_over.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pbrt {

static bool is_plain(const std::string& type) {
    return type == "constant" || type == "scale" || type == "mix";
}

/// Whether pbrt's parameters of this name are floats, whatever has them.
static bool takes_floats(std::string_view name) {
    static constexpr std::string_view kFloats[] = {"alpha",        "amount",     "bumpmap",
                                                   "displacement", "roughness",  "shadowalpha",
                                                   "sigma",        "uroughness", "vroughness"};
    return std::ranges::find(kFloats, name) != std::end(kFloats);
}

/// Whether make() knows textures of this class, if their mapping and their parts are among those
/// that it knows too.
static bool is_evaluated(const TextureRequest& request) {
    if (request.type == "imagemap")
        return !request.parameters.text("filename").empty();
    static constexpr std::string_view kPatterns[] = {"bilerp", "checkerboard", "dots",    "fbm",
                                                     "marble", "windy",        "wrinkled"};
    return is_plain(request.type) ||
           std::ranges::find(kPatterns, request.type) != std::end(kPatterns);
}

void Textures::define(const std::string& name, TextureRequest request) {
    if (!request.is_float && !is_evaluated(request))
        tell_mean(request.type, request.place);
    Definition definition;
    definition.mean = mean(request.type, request.parameters);
    definition.is_pattern = !is_plain(request.type);
    for (const Parameter& p : request.parameters.all())
        if (const Definition* const part = find(p, request.is_float || takes_floats(p.name))) {
            definition.is_pattern = definition.is_pattern || part->is_pattern;
            definition.parts[p.name] = size_t(part - definitions_.data());
            definition.count += part->count;
        }
    if (definition.count > kMaxCombined)
        diagnostics_.fail(request.place,
                          fmt::format("found a texture of more than {} others", kMaxCombined));
    if (is_plain(request.type))
        tell_left_over(request.parameters, "textures", request.type, diagnostics_);
    definition.request = std::move(request);
    by_name_[definition.request.is_float].define(name, definitions_.size());
    definitions_.push_back(std::move(definition));
}

void Textures::tell_means(const Parameters& parameters) const {
    for (const Parameter& p : parameters.all()) {
        const Definition* const found =
            p.asked && !p.evaluated ? find(p, takes_floats(p.name)) : nullptr;
        const bool is_told = found && found->is_made && !found->made;
        if (found && found->is_pattern && !is_told)
            say_mean(found->request.type, found->request.place);
    }
}

void Textures::tell_mean(const std::string& type, const Place& place) const {
    if (!is_plain(type))
        say_mean(type, place);
}

void Textures::say_mean(const std::string& type, const Place& place) const {
    diagnostics_.approximate("texture " + type, place,
                             fmt::format("textures {} are shown by their mean", ovc::quoted(type)));
}

const Textures::Definition* Textures::find(const Parameters& parameters,
                                           std::string_view name) const {
    const Parameter* p = parameters.find(name);
    return p ? find(*p, takes_floats(name)) : nullptr;
}

/// A texture of colors and one of floats may have the same name. v1 leaves open which it asks for.
const Textures::Definition* Textures::find(const Parameter& parameter, bool of_floats) const {
    // v1 may give a texture's name for a float or a color.
    if ((parameter.kind != Kind::Texture && parameter.kind != Kind::String) ||
        parameter.strings.empty())
        return nullptr;
    const size_t* at = by_name_[of_floats].find(parameter.strings[0]);
    at = at ? at : by_name_[!of_floats].find(parameter.strings[0]);
    return at ? &definitions_[*at] : nullptr;
}

void Textures::end_scope(const std::array<size_t, 2>& begin) {
    for (size_t kind = 0; kind < begin.size(); ++kind)
        by_name_[kind].end(begin[kind]);
}

bool Textures::is_pattern(const Parameters& parameters, std::string_view name) const {
    const Definition* const found = find(parameters, name);
    return found && found->is_pattern;
}

bool Textures::is_used(const std::string& name) const {
    const size_t* const at = by_name_[true].find(name);
    return at && definitions_[*at].made.has_value();
}

vec3 Textures::mean(const std::string& type, const Parameters& p) const {
    if (type == "constant")
        return color(p, "value", vec3(1));
    if (type == "scale") // v4 calls its factors tex and scale
        return p.find("tex") || p.find("scale")
                   ? color(p, "tex", vec3(1)) * color(p, "scale", vec3(1))
                   : color(p, "tex1", vec3(1)) * color(p, "tex2", vec3(1));
    if (type == "mix")
        return glm::mix(color(p, "tex1", vec3(0)), color(p, "tex2", vec3(1)),
                        float(number(p, "amount", 0.5)));
    if (type == "checkerboard" || type == "directionmix")
        return 0.5f * (color(p, "tex1", vec3(1)) + color(p, "tex2", vec3(0)));
    if (type == "dots")
        return 0.5f * (color(p, "inside", vec3(1)) + color(p, "outside", vec3(0)));
    if (type == "bilerp")
        return 0.25f * (color(p, "v00", vec3(0)) + color(p, "v01", vec3(1)) +
                        color(p, "v10", vec3(0)) + color(p, "v11", vec3(1)));
    return vec3(0.5f * float(p.number("scale", 1)));
}

vec3 Textures::color(const Parameters& parameters, std::string_view name,
                     const vec3& otherwise) const {
    const Parameter* p = parameters.find(name);
    if (!p)
        return otherwise;
    if (!p->is_color())
        p->wants = 1;
    if (p->kind == Kind::Texture || p->kind == Kind::String) {
        if (const Definition* const found = find(parameters, name))
            return found->mean;
        diagnostics_.missing("texture of that name", p->place,
                             fmt::format("there is no texture {}",
                                         ovc::quoted(p->strings.empty() ? "" : p->strings[0])));
        return otherwise;
    }
    const auto found = color_of(*p, is_v4_);
    if (!found && p->kind == Kind::Spectrum)
        diagnostics_.approximate(
            "spectrum by name", p->place,
            fmt::format("the spectrum {} is not known; a default takes its place",
                        ovc::quoted(p->strings.empty() ? "" : p->strings[0])));
    return found.value_or(otherwise);
}

double Textures::number(const Parameters& parameters, std::string_view name,
                        double otherwise) const {
    const vec3 c = color(parameters, name, vec3(float(otherwise)));
    return (double(c.x) + double(c.y) + double(c.z)) / 3;
}

} // namespace ovc::pbrt
