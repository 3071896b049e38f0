// SPDX-License-Identifier: Apache-2.0
// Camera rays: a pinhole in double, the order pixels are visited in, and a view for scenes that
// come without one.
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "core/result.h"
#include "core/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// The largest coordinate that a camera or a light may have; rays from farther away overflow.
inline constexpr double kFarthest = 1e100;

/// Whether rays can be made of `camera`: its numbers are finite and no larger than kFarthest, the
/// eye is not the target, and its window has an area that is not seen edge on. The error does not
/// say whose camera it is.
Result<Done> check_camera(const Camera& camera);

/// A part of a larger picture, so many pixels from its left and upper edge.
struct PicturePart {
    ImageSize picture;
    uint32_t left = 0;
    uint32_t top = 0;
    ImageSize size;
};

/// A camera made ready for an image of width x height pixels, which may be a part of its picture.
class Pinhole {
public:
    /// The part lies within its picture. check_camera() accepts the camera; an up along the view is
    /// replaced by an axis that is not.
    Pinhole(const Camera& camera, const PicturePart& part);
    Pinhole(const Camera& camera, uint32_t width, uint32_t height)
        : Pinhole(camera, {{width, height}, 0, 0, {width, height}}) {}

    /// Through a place in pixel (x, y), (0, 0) being top left: from (0, 0), its top left corner, to
    /// (1, 1). dir is not of unit length: t is the depth, in a window's case in units of its
    /// direction. A pixel that a bent picture leaves out gets a ray that hits nothing: its dir is
    /// 0.
    Ray ray(uint32_t x, uint32_t y, const dvec2& place = dvec2(0.5)) const;

    uint32_t width() const { return part_.size.width; }
    uint32_t height() const { return part_.size.height; }
    /// Unit length, perpendicular to the view.
    const dvec3& up() const { return up_; }
    const dvec3& right() const { return right_; }

private:
    PicturePart part_;
    dvec3 eye_, right_, up_;
    // To the middle of the image plane, and from there to its right and upper edge.
    dvec3 middle_, to_right_, to_top_;
    bool orthographic_ = false;
    std::optional<ImageWindow> bent_;
};

/// The pixels y * width + x of an image, each once, along Hilbert's curve: neighbours in the list
/// are neighbours in the image but where the curve leaves it, so a batch of rays touches few
/// leaves. width, height <= 65535.
std::vector<uint32_t> pixel_order(uint32_t width, uint32_t height);

/// The unit vector along axis 0, 1 or 2.
dvec3 axis_vector(int axis);

/// Looks at `bounds` from in front, a little from the right and above, so that the whole box just
/// fits into an image of width x height. up: the axis that is up; the one in front of what a model
/// shows is +z where that is y, else the one that turning y there brings it to: -y of z, +z of x.
/// Empty bounds: the default Camera, with that axis up.
Camera framing_camera(const Box& bounds, uint32_t width, uint32_t height, int up = 1);

/// A light above the camera's left shoulder, as far away as the eye is from the target.
Light shoulder_light(const Camera& camera);

/// `lights` as they stand for a picture of `scene` from `camera`: those on the camera are where it
/// is. Where there are none, the shoulder light, unless the scene means to have none.
std::vector<Light> placed_lights(const Scene& scene, const std::vector<Light>& lights,
                                 const Camera& camera);

/// What a light has that was only given a position, a little warm: a white surface that faces it
/// comes out at about 0.8.
inline constexpr vec3 kDefaultLightColor{2.6f, 2.45f, 2.2f};

} // namespace ovc
