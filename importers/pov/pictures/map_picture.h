// SPDX-License-Identifier: Apache-2.0
// MapPicture: the picture of an image_map. The scene's textures name it, for whoever renders to
// open; the scene's functions look at it while the scene is read.
#pragma once

#include "core/texture/image_texture.h"
#include "importers/picture.h"

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace ovc::pov {

class MapPicture final : public ImageLookup {
public:
    /// gamma: as that of an ImageTexture. new_contents: a PNG in the place of the file, or empty.
    MapPicture(std::string file, std::string place, double gamma,
               std::vector<uint8_t> new_contents = {});

    const std::string path;
    const std::string asked_for_at; // "a.pov:12:3"
    const std::vector<uint8_t> contents;

    /// These read the picture when they are first called: most pictures are only named.
    vec4 color(const PictureArea& area) const override;
    dvec2 size() const override;
    bool has_opacity() const override { return true; }

private:
    const Picture& picture() const;
    vec4 texel(const PictureArea& area, double column, double row) const;

    double gamma_;
    mutable std::once_flag is_read_;
    mutable Picture picture_;
    mutable std::vector<float> light_; // of each code
};

} // namespace ovc::pov
