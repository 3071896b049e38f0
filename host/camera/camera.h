// SPDX-License-Identifier: Apache-2.0
// Camera rays of a pinhole in double, the order in which pixels are visited, and a view for scenes
// that come without one.
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/camera/face_rays.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// The largest coordinate that a camera or a light may have; rays from farther away overflow.
inline constexpr double kFarthest = 1e100;

/// Checks that `camera` can make rays: its numbers are finite and no larger than kFarthest, its
/// field of view is between 0 and 180 degrees, the eye is not the target, its window has an area
/// that is not seen edge on, and its lens is sharp somewhere in front of it. The error does not say
/// whose camera it is.
Result<Done> check_camera(const Camera& camera);

/// A camera prepared for an image of width x height pixels, which may be a part of its picture.
class Pinhole {
public:
    /// part: must lie within its picture. camera: check_camera() must accept it; an up along the
    /// view is replaced by an axis that is not.
    /// scene: has the faces of the camera and the textures of its bump, and must outlive it; null:
    /// it has none.
    Pinhole(const Camera& camera, const PicturePart& part, const Scene* scene = nullptr);
    Pinhole(const Camera& camera, uint32_t width, uint32_t height)
        : Pinhole(camera, {{width, height}, 0, 0, {width, height}}) {}

    /// Returns the ray through a place in pixel (x, y); pixel (0, 0) is top left. place: from (0,
    /// 0), the pixel's top left corner, to (1, 1). dir is not of unit length: t is the depth, of a
    /// window in units of its direction. A pixel that a bent picture leaves out gets a ray with a
    /// dir of 0, which hits nothing. A place outside of the pixel is one in its neighbours.
    /// lens: a place in the unit disk, where the ray goes through the camera's lens, if it has one.
    /// sample: the ray's number in its pixel, which chooses the face of a camera that has faces.
    Ray ray(uint32_t x, uint32_t y, const dvec2& place = dvec2(0.5), const dvec2& lens = dvec2(0),
            uint32_t sample = 0) const;

    bool has_lens() const { return lens_.has_value(); }

    const PicturePart& part() const { return part_; }

    uint32_t width() const { return part_.size.width; }
    uint32_t height() const { return part_.size.height; }
    /// Both are of unit length and perpendicular to the view.
    const dvec3& up() const { return up_; }
    const dvec3& right() const { return right_; }

private:
    Ray ray_at(const dvec2& at, const dvec2& lens) const; // at: in the picture, from 0 to 1
    Ray straight_ray(const dvec2& at) const;

    PicturePart part_;
    const Scene* scene_;
    std::optional<Bump> bump_;
    std::optional<Lens> lens_;
    double nearest_;
    dvec3 eye_, right_, up_;
    // From the eye to the middle of the image plane, and from there to its right and upper edge.
    dvec3 middle_, to_right_, to_top_;
    bool orthographic_ = false;
    std::optional<ImageWindow> bent_;
    std::optional<FaceRays> faces_;
};

/// Returns the pixels y * width + x of an image, each once, along Hilbert's curve. Neighbours in
/// the list are neighbours in the image, except where the curve leaves it, so a batch of rays
/// touches few leaves. width, height <= 65535.
std::vector<uint32_t> pixel_order(uint32_t width, uint32_t height);

/// Returns the unit vector along axis 0, 1 or 2.
dvec3 axis_vector(int axis);

/// Returns a camera that looks at `bounds` from in front, a little from the right and above, so
/// that the whole box just fits into an image of width x height. up: the axis that is up. The front
/// of a model is +z where y is up, -y where z is up, and +z where x is up. Empty bounds give the
/// default Camera, with that axis up.
Camera framing_camera(const Box& bounds, uint32_t width, uint32_t height, int up = 1);

/// Returns a round lens across the camera's view. radius: above 0. focus: the distance along the
/// view at which it is sharp; none: the camera's target.
Lens lens_of(const Camera& camera, double radius, std::optional<double> focus);

/// Returns a light above the camera's left shoulder: from the eye 1.1 of its distance to the target
/// up, and 0.9 of it to the left.
Light shoulder_light(const Camera& camera);

/// Returns `lights` as they stand for a picture of `scene` from `camera`, with those on the camera
/// moved to it. Where there are none it is the shoulder light, unless the scene means to have none.
std::vector<Light> placed_lights(const Scene& scene, const std::vector<Light>& lights,
                                 const Camera& camera);

/// The color of a light for which the user gave only a position. It is a little warm, and a white
/// surface that faces it comes out at about 0.8.
inline constexpr vec3 kDefaultLightColor{2.6f, 2.45f, 2.2f};

} // namespace ovc
