// SPDX-License-Identifier: Apache-2.0
// Holes are the places where the picture of an image_map lets all light through.
#pragma once

#include "core/cutout.h"
#include "importers/picture.h"
#include "importers/pov/values/value.h"

#include <map>

namespace ovc::pov {

/// The transparency that an image_map gives to its picture.
struct MapTransparency {
    struct Share {
        float filter = 0, transmit = 0;
    };
    Share all;                     // of every color
    std::map<int, Share> of_index; // of single colors of a table, besides
    bool once = false;             // the picture is not repeated; around it there is nothing
};

/// Returns the holes of the picture and the average color of what is there, which lets `all`
/// through; nothing where all of it lets the same share of light through. light: the light of the
/// 256 codes of a sample.
HolesPtr holes_of(const Picture& picture, const MapTransparency& transparency, bool smooth,
                  const std::array<double, 256>& light);

} // namespace ovc::pov
