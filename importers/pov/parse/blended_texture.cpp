// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/blended_texture.h"

#include "importers/pov/parse/texture.h"

#include <algorithm>
#include <cassert>

namespace ovc::pov {

uint32_t builtin(std::string_view name) {
    const std::span<const FloatFunction> all = float_functions();
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const FloatFunction& f) { return f.name == name; });
    assert(at != all.end());
    return uint32_t(at - all.begin());
}

/// Adds the sum of the weights at the place that the formula gets.
static void add_sum(std::span<const WeightedTexture> parts, ProgramBuilder& to) {
    using FormulaOp = FormulaStep::Kind;
    to.constant(0);
    for (const WeightedTexture& part : parts) {
        for (uint32_t axis = 0; axis < 3; ++axis)
            to.add(FormulaOp::Argument, axis);
        to.call(part.weight, 3);
        to.add(FormulaOp::Add);
    }
}

/// Returns the share of the parts from `first` on, in [0, 1].
static ProgramPtr share_of_rest(std::span<const WeightedTexture> parts, size_t first) {
    using FormulaOp = FormulaStep::Kind;
    ProgramBuilder share;
    add_sum(parts.subspan(first), share);
    add_sum(parts, share);
    share.constant(1e-30);
    share.add(FormulaOp::Builtin, builtin("max"), 2);
    share.add(FormulaOp::Divide);
    return share.take();
}

/// Blends the two halves of the parts, so that a place where one has no weight asks the other one
/// alone. Subtracts the steps that the formulas take from `work`, which must not fall below 0.
static std::optional<Texture> blended(std::span<const WeightedTexture> parts, bool on_corners,
                                      double& work) {
    if (parts.size() == 1)
        return parts.front().texture;
    const size_t half = parts.size() / 2;
    auto map = std::make_shared<PatternMap>();
    map->pattern.kind = Pattern::Kind::Function;
    map->pattern.wave = Pattern::Wave::None;
    map->on_corners = on_corners;
    map->program = share_of_rest(parts, half);
    if (!map->program)
        return std::nullopt;
    work -= formula_work(map->program->formula, map->program->textures.size());
    if (work < 0)
        return std::nullopt;
    for (const auto& part : {parts.first(half), parts.subspan(half)}) {
        std::optional<Texture> texture = blended(part, on_corners, work);
        if (!texture)
            return std::nullopt;
        MapStop& stop = map->stops.emplace_back();
        stop.at = map->stops.size() == 1 ? 0 : 1;
        stop.texture = std::make_shared<const Texture>(std::move(*texture));
    }
    return mix_of(std::move(map));
}

std::optional<Texture> blended(const std::vector<WeightedTexture>& parts, bool on_corners) {
    assert(!parts.empty());
    double work = kMaxFormulaWork / 2; // the other half is for the textures
    return blended(parts, on_corners, work);
}

bool same_look(const Texture& a, const Texture& b) {
    const auto color = [](const Color& c) {
        return std::array<float, 5>{c.rgb.x, c.rgb.y, c.rgb.z, c.filter, c.transmit};
    };
    return color(a.pigment.color) == color(b.pigment.color) && a.pigment.holes == b.pigment.holes &&
           a.pigment.uv_mapping == b.pigment.uv_mapping &&
           ((!a.pigment.holes && !a.pigment.pattern) || a.pigment.placed == b.pigment.placed) &&
           a.pigment.pattern == b.pigment.pattern && a.mix.pattern == b.mix.pattern &&
           a.under == b.under && a.normal.pattern.pattern == b.normal.pattern.pattern &&
           a.normal.amount == b.normal.amount && a.surface.finish == b.surface.finish &&
           a.surface.ambient == b.surface.ambient && a.surface.emission == b.surface.emission;
}

} // namespace ovc::pov
