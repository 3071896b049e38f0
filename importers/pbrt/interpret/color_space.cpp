// SPDX-License-Identifier: Apache-2.0
// Sources: the primaries of SMPTE EG 432-1 (Display P3, with the white D65), ITU-R BT.2020 and
// SMPTE ST 2065-1 (ACES). Its white, D60, is scaled to that of sRGB in linear colors.
#include "importers/pbrt/interpret/color_space.h"

#include <algorithm>
#include <iterator>

namespace ovc::pbrt {

namespace {

struct NamedSpace {
    std::string_view name;
    dmat3 to_srgb; // the columns are what red, green and blue of the space become
};

const NamedSpace kSpaces[] = {
    {"srgb", dmat3(1)},
    {"dci-p3",
     {1.2249402, -0.0420570, -0.0196376, -0.2249402, 1.0420570, -0.0786360, 0, 0, 1.0982736}},
    {"rec2020",
     {1.6604910, -0.1245505, -0.0181508, -0.5876411, 1.1328999, -0.1005789, -0.0728499, -0.0083494,
      1.1187297}},
    {"aces2065-1",
     {2.4432987, -0.2795107, -0.0187592, -1.0691119, 1.3735110, -0.1622704, -0.3741868, -0.0940003,
      1.1810297}}};

} // namespace

std::optional<dmat3> color_space_of(std::string_view name) {
    const NamedSpace* const at = std::ranges::find(kSpaces, name, &NamedSpace::name);
    return at == std::end(kSpaces) ? std::nullopt : std::optional(at->to_srgb);
}

} // namespace ovc::pbrt
