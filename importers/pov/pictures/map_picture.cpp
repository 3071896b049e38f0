// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/map_picture.h"

#include "importers/png.h"
#include "importers/pov/pictures/picture.h"
#include "importers/pov/values/expression.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ovc::pov {

MapPicture::MapPicture(std::string file, std::string place, double gamma,
                       std::vector<uint8_t> new_contents)
    : path(std::move(file)),
      asked_for_at(std::move(place)),
      contents(std::move(new_contents)),
      gamma_(gamma) {}

const Picture& MapPicture::picture() const {
    std::call_once(is_read_, [this] {
        Result<Picture> read = contents.empty() ? read_picture(path) : read_png(contents);
        if (read)
            picture_ = std::move(*read);
        else // It was there when the scene named it, so that nobody waits for this.
            picture_ = {1, 1, true, {{32768, 32768, 32768, 65535}}, {}};
        for (size_t code = 0; code < 65536; ++code) {
            const double share = double(code) / 65535;
            light_.push_back(float(gamma_ == 0 ? from_srgb(share, 1) : std::pow(share, gamma_)));
        }
    });
    return picture_;
}

dvec2 MapPicture::size() const {
    return {picture().width, picture().height};
}

/// Returns the number of a texel among `count`. POV-Ray mirrors no picture.
static size_t wrapped(double number, uint32_t count, Beyond beyond) {
    const double n = count;
    if (beyond == Beyond::Repeat)
        return size_t(number - n * std::floor(number / n));
    return size_t(std::clamp(number, 0.0, n - 1));
}

/// Rows count from the lower edge up.
vec4 MapPicture::texel(const PictureArea& area, double column, double row) const {
    const Picture& all = picture();
    const size_t x = wrapped(column, all.width, area.beyond_s);
    const size_t y = wrapped(row, all.height, area.beyond_t);
    const auto& codes = all.pixels[(all.height - 1 - y) * all.width + x];
    return {light_[codes[0]], light_[codes[1]], light_[codes[2]], float(codes[3]) / 65535};
}

vec4 MapPicture::color(const PictureArea& area) const {
    const auto is_nothing = [](Beyond beyond, double place) {
        return beyond == Beyond::Nothing && !(place >= 0 && place < 1);
    };
    if (is_nothing(area.beyond_s, area.st.x) || is_nothing(area.beyond_t, area.st.y))
        return vec4(0);
    const dvec2 at = area.st * size();
    if (area.filter == TexelFilter::Nearest)
        return texel(area, std::floor(at.x), std::floor(at.y));
    const dvec2 low = glm::floor(at - 0.5);
    const vec2 share = vec2(at - 0.5 - low);
    return glm::mix(
        glm::mix(texel(area, low.x, low.y), texel(area, low.x + 1, low.y), share.x),
        glm::mix(texel(area, low.x, low.y + 1), texel(area, low.x + 1, low.y + 1), share.x),
        share.y);
}

} // namespace ovc::pov
