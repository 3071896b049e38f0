// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/hole_table.h"

#include <cassert>

namespace ovc::pov {

uint32_t HoleTable::number(const Pigment& pigment, const dmat4& placed, bool on_uv) {
    assert(pigment.holes);
    const auto [at, is_new] =
        cutouts_.try_emplace(pigment.holes.get(), uint32_t(scene_.cutouts.size()));
    if (is_new)
        scene_.cutouts.push_back(pigment.holes->cutout);
    const dmat4 to_picture = glm::inverse(placed);
    const bool is_last = !placed_.empty() && placed_.back().cutout == at->second &&
                         placed_.back().on_uv == on_uv && placed_.back().to_picture == to_picture;
    if (!is_last)
        placed_.push_back({at->second, on_uv, to_picture});
    return uint32_t(placed_.size() - 1);
}

void HoleTable::add_uv(uint32_t holes, const std::array<dvec3, 3>& in_world, const vec2* uv,
                       std::vector<vec2>& to) const {
    if (holes == kNone)
        return;
    const PlacedHoles& placed = placed_[holes];
    for (size_t i = 0; i < 3; ++i) {
        const dvec3 from = !placed.on_uv ? in_world[i] : uv ? dvec3(uv[i], 0) : dvec3(0);
        to.emplace_back(placed.to_picture * dvec4(from, 1));
    }
}

} // namespace ovc::pov
