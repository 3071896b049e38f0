// SPDX-License-Identifier: Apache-2.0
// ImageTexture: a picture in a file as a texture. Whoever renders gives it an ImageLookup, because
// core opens no pictures.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>

namespace ovc {

/// Returns the angle from +a over +b as a share of a turn, in [0, 1).
double share_of_turn(double a, double b);

/// Light x rgb x filter + light x transmit goes through a place of a surface.
struct TransparentColor {
    vec3 rgb{0};
    float filter = 0;
    float transmit = 0;

    float opacity() const { return 1 - filter - transmit; }
    /// Returns the share of light that goes through, for each color.
    vec3 through() const { return filter * rgb + vec3(transmit); }
    bool operator==(const TransparentColor&) const = default;
};

/// What lies beyond the unit square: the picture again, its rim, the picture flipped each second
/// time, or nothing, which is black and transparent.
enum class Beyond : uint64_t { Repeat, Clamp, Mirror, Nothing };

/// How the color between the middles of texels is found: Nearest takes one texel, Smooth four of
/// the finest level. Mipmaps takes the mean of the footprint.
enum class TexelFilter : uint64_t { Nearest, Smooth, Mipmaps };

/// A parallelogram of a picture, around s and t, which are 0 at its left and its lower edge and 1
/// at the others.
struct PictureArea {
    dvec2 st{0};
    dvec2 side_a{0}, side_b{0}; // both 0: a point
    Beyond beyond_s = Beyond::Repeat, beyond_t = Beyond::Repeat;
    TexelFilter filter = TexelFilter::Mipmaps;
};

/// The open picture of an ImageTexture. Any number of threads may ask it.
class ImageLookup {
public:
    virtual ~ImageLookup() = default;
    /// Returns the mean color of the area, linear, and its opacity.
    virtual vec4 color(const PictureArea& area) const = 0;
    /// Returns the picture's width and height in texels.
    virtual dvec2 size() const = 0;
    /// Returns whether the picture has opacity; else it is 1.
    virtual bool has_opacity() const = 0;
};

/// A picture lies in the unit square of the plane of s and t, its first row at t = 1.
struct ImageTexture {
    /// The s and t of a point. Planar: x and y. The next three go around the axis of y, from +x
    /// over +z: longitude and latitude; longitude and y; longitude and the angle around a circle of
    /// radius 1. LatLong: of a direction, the angle around the axis of z from +x over +y, and the
    /// one from +z down, which is 1 at +z. Octahedral: Clarberg's equal-area map of directions.
    enum class Projection : uint64_t { Planar, Spherical, Cylindrical, Torus, LatLong, Octahedral };
    /// Color, or a gray of one of the picture's channels. Mask: the opacity where the picture has
    /// any, else the mean color. Mean: that always. CodedMask: as Mask, of an opacity that is a
    /// code as colors are.
    enum class Channel : uint64_t { Color, Red, Green, Blue, Opacity, Mask, Mean, CodedMask };
    /// The light of a picture whose file says how much light it is to give: the mean luminance of
    /// its texels, that of all ways through a window (ThrownPicture) together, and that which a
    /// surface receives that faces +z below an Octahedral picture as the sky. Of color 1, they are
    /// 1, the window's solid angle, and pi.
    enum class Measure : uint64_t { None, Mean, ThroughWindow, FromAbove };

    uint32_t picture = 0; // index into Scene::pictures
    Projection projection = Projection::Planar;
    /// Rows of a 2 x 3 matrix, which multiplies (s, t, 1).
    std::array<dvec3, 2> to_picture{dvec3(1, 0, 0), dvec3(0, 1, 0)};
    Beyond beyond_s = Beyond::Repeat, beyond_t = Beyond::Repeat;
    TexelFilter filter = TexelFilter::Mipmaps;
    /// Codes of whole numbers, which go from 0 to 1, become linear light by this power; 0: by
    /// sRGB's curve. Pictures of floats hold linear light.
    double gamma = 0;
    Channel channel = Channel::Color;
    Measure per = Measure::None; // whoever opens the picture divides its colors by this
    double window_distance = 1;  // of ThroughWindow, in halves of the window's shorter side
    bool is_transparent = false; // light goes through where the picture has no opacity
    float filter_all = 0, transmit_all = 0; // go through everywhere, of light where it is opaque
    vec3 scale{1}, offset{0};               // the color is scale x the picture's + offset
    TransparentColor otherwise{vec3(0.5f)}; // the color without the picture
    const ImageLookup* lookup = nullptr;    // null: the picture is not open

    bool operator==(const ImageTexture&) const = default;
};

/// Returns the color at a point. sides: of the parallelogram around it whose mean is wanted.
TransparentColor color_at(const ImageTexture& image, const dvec3& at,
                          const std::array<dvec3, 2>& sides);

/// Returns the light of a picture that is open, by image.per: an integral over its texels.
double measured(const ImageTexture& image);

} // namespace ovc
