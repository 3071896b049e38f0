// SPDX-License-Identifier: Apache-2.0
// Alpha is tested as in pbrt: at the finest level of the picture, between texels where the filter
// is not "point".
#include "importers/pbrt/look/alphas.h"

#include "importers/file/files_read.h"
#include "importers/file/text.h"
#include "importers/pov/pictures/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace ovc::pbrt {

namespace {

/// Returns the texture of that name in the parameter; empty if it is no texture.
std::string texture_name(const Parameters& parameters, std::string_view name) {
    const Parameter* p = parameters.find(name);
    const bool is_texture = p && (p->kind == Kind::Texture || p->kind == Kind::String);
    return is_texture && !p->strings.empty() ? p->strings[0] : std::string();
}

/// Sets where the picture lies; returns false where it does not lie on texture coordinates.
bool take_mapping(const Parameters& p, Cutout& cutout) {
    if (p.text("mapping", "uv") != "uv")
        return false;
    cutout.uv_scale = {p.number("uscale", 1), p.number("vscale", 1)};
    cutout.uv_offset = {p.number("udelta", 0), p.number("vdelta", 0)};
    return true;
}

uint8_t texel_of(double opacity) {
    // No texel that is there in part may become a hole, nor one that is there.
    const double steps = std::clamp(opacity, 0.0, 1.0) * 255;
    return uint8_t(steps < 1 ? std::ceil(steps) : std::floor(steps));
}

/// Returns the light that a sample stands for.
double light_of(uint16_t sample, bool linear) {
    const float code = float(sample) / 65535.0f;
    return double(linear ? code : linear_light(code, kSrgbGamma));
}

/// Returns the opacity of the pixels: their own, where the picture has any, as in pbrt-v4, which
/// takes it for a code as colors are; else their mean color.
std::vector<uint8_t> opacity_of(const Picture& picture, bool inverted, bool linear, bool is_v4) {
    const bool has_opacity =
        std::ranges::any_of(picture.pixels, [](const auto& pixel) { return pixel[3] != 65535; });
    std::vector<uint8_t> opacity;
    opacity.reserve(picture.size());
    for (const auto& pixel : picture.pixels) {
        double value = 0;
        if (has_opacity)
            value = light_of(pixel[3], linear || !is_v4);
        else
            for (size_t i = 0; i < 3; ++i)
                value += light_of(pixel[i], linear) / 3;
        opacity.push_back(texel_of(inverted ? 1 - value : value));
    }
    return opacity;
}

} // namespace

void Alphas::define(const std::string& name, const std::string& type, const Parameters& parameters,
                    const Place& place) {
    Pattern pattern;
    if (type == "imagemap")
        pattern = image_map(parameters);
    else if (type == "checkerboard")
        pattern = checkerboard(parameters);
    else if (type == "scale")
        pattern = scaled(parameters);
    else
        pattern.refused = fmt::format("a texture {}", ovc::quoted(type));
    pattern.type = type;
    pattern.place = place;
    if (Pattern* const earlier = patterns_.find(name))
        earlier->used = earlier->used || textures_.is_used(name);
    patterns_.define(name, std::move(pattern));
}

void Alphas::end_scope(size_t begin) {
    patterns_.end(begin, [&](const std::string& name, const Pattern& pattern) {
        tell_unless_used(name, pattern);
    });
}

/// A texture that is not evaluated was told of already, where it was asked for as alpha.
void Alphas::tell_unless_used(const std::string& name, const Pattern& pattern) const {
    if (!pattern.used && !textures_.is_used(name))
        textures_.tell_mean(pattern.type, pattern.place);
}

Alphas::Pattern Alphas::image_map(const Parameters& p) const {
    Pattern pattern;
    pattern.picture = p.text("filename");
    pattern.inverted = p.flag("invert", false);
    pattern.linear = !p.flag("gamma", true) || p.text("encoding") == "linear";
    Cutout& cutout = pattern.cutout;
    cutout.scale = float(p.number("scale", 1));
    cutout.smooth = p.text("filter") != "point";
    const std::string wrap = p.text("wrap", "repeat");
    cutout.beyond = wrap == "clamp"   ? Cutout::Beyond::Clamp
                    : wrap == "black" ? Cutout::Beyond::Hole
                                      : Cutout::Beyond::Repeat;
    if (!take_mapping(p, cutout))
        pattern.refused = fmt::format("a mapping {}", ovc::quoted(p.text("mapping")));
    return pattern;
}

/// A checkerboard is a picture of 2 x 2 texels for each 2 x 2 squares.
Alphas::Pattern Alphas::checkerboard(const Parameters& p) const {
    Pattern pattern;
    Cutout& cutout = pattern.cutout;
    if (!take_mapping(p, cutout) || p.number("dimension", 2) != 2)
        pattern.refused = "a checkerboard that does not lie on texture coordinates";
    else if (textures_.is_pattern(p, "tex1") || textures_.is_pattern(p, "tex2"))
        pattern.refused = "a checkerboard of patterns";
    const uint8_t even = texel_of(textures_.number(p, "tex1", 1));
    const uint8_t odd = texel_of(textures_.number(p, "tex2", 0));
    cutout.uv_scale *= 0.5;
    cutout.uv_offset *= 0.5;
    cutout.width = cutout.height = 2;
    cutout.opacity = {odd, even, even, odd}; // the square at (0, 0) is in the last row
    return pattern;
}

/// v4 calls the factors tex and scale, v3 tex1 and tex2.
Alphas::Pattern Alphas::scaled(const Parameters& p) const {
    const bool v4 = p.find("tex") || p.find("scale");
    std::array<std::string_view, 2> factors = {v4 ? "tex" : "tex1", v4 ? "scale" : "tex2"};
    if (!textures_.is_pattern(p, factors[0]))
        std::swap(factors[0], factors[1]);
    const std::string name = texture_name(p, factors[0]);
    Pattern pattern;
    if (const Pattern* const factor = patterns_.find(name)) {
        pattern = *factor;
        pattern.scales = name;
    } else
        pattern.refused = "a product without a pattern of floats";
    if (textures_.is_pattern(p, factors[1]))
        pattern.refused = "a product of patterns";
    pattern.cutout.scale *= float(textures_.number(p, factors[1], 1));
    pattern.made.reset();
    pattern.used = false;
    return pattern;
}

Alpha Alphas::of(const Parameters& parameters, std::string_view name) {
    if (textures_.is_pattern(parameters, name)) {
        Pattern* const pattern = patterns_.find(texture_name(parameters, name));
        return {false, pattern ? make(*pattern) : kNone};
    }
    const double share = parameters.find(name) ? textures_.number(parameters, name, 1) : 1;
    if (!(share < 1) || share <= 0)
        return {share <= 0, kNone};
    const auto [at, is_new] = constants_.try_emplace(share, uint32_t(cutouts_.size()));
    if (is_new)
        cutouts_.push_back({.width = 1, .height = 1, .opacity = {255}, .scale = float(share)});
    return {false, at->second};
}

uint32_t Alphas::of_texture(uint32_t texture) {
    if (texture == kNoTexture)
        return kNone;
    const auto [at, is_new] = textured_.try_emplace(texture, uint32_t(cutouts_.size()));
    if (is_new)
        cutouts_.push_back({.texture = texture});
    return at->second;
}

uint32_t Alphas::make(Pattern& pattern) {
    if (pattern.made)
        return *pattern.made;
    pattern.made = kNone;
    pattern.used = true;
    if (Pattern* const factor = patterns_.find(pattern.scales))
        factor->used = true;
    if (!pattern.refused.empty()) {
        diagnostics_.approximate(
            "alpha " + pattern.refused, pattern.place,
            fmt::format("{} as alpha is not evaluated, and makes no holes", pattern.refused));
        return kNone;
    }
    if (!pattern.picture.empty() && !read_picture(pattern))
        return kNone;
    if (pattern.cutout.opacity.empty())
        return kNone;
    pattern.made = uint32_t(cutouts_.size());
    cutouts_.push_back(pattern.cutout);
    if (!pattern.picture.empty())
        pattern.cutout.opacity = {}; // a scaled copy of the texture reads the file anew
    return *pattern.made;
}

bool Alphas::read_picture(Pattern& pattern) {
    const auto path = tokens_.find(pattern.picture);
    if (!path) {
        diagnostics_.missing("file " + pattern.picture, pattern.place,
                             tokens_.no_file(pattern.picture));
        return false;
    }
    note(tokens_.files_read(), *path);
    const Result<Picture> picture = pov::read_picture(*path);
    if (!picture) {
        diagnostics_.missing("file " + pattern.picture, pattern.place,
                             fmt::format("an alpha makes no holes: {}", picture.error().message));
        return false;
    }
    pattern.cutout.width = picture->width;
    pattern.cutout.height = picture->height;
    pattern.cutout.opacity =
        opacity_of(*picture, pattern.inverted, pattern.linear, textures_.is_v4());
    return true;
}

std::vector<Cutout> Alphas::take(bool partial) {
    patterns_.for_each(
        [&](const std::string& name, const Pattern& pattern) { tell_unless_used(name, pattern); });
    for (Cutout& cutout : cutouts_)
        cutout.partial = partial || cutout.texture != kNoTexture;
    return std::move(cutouts_);
}

} // namespace ovc::pbrt
