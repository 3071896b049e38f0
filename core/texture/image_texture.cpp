// SPDX-License-Identifier: Apache-2.0
// Projections of points onto a picture. The octahedral one: Clarberg 2008, "Fast Equal-Area Mapping
// of the (Hemi)Sphere using SIMD", in the form of pbrt-v4.
#include "core/texture/image_texture.h"

#include "core/scene.h"
#include "core/system/parallel.h"
#include "core/texture/luminance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

double share_of_turn(double a, double b) {
    const double share = std::atan2(b, a) / (2 * std::numbers::pi);
    return share < 0 ? share + 1 : share;
}

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

dvec2 octahedral(const dvec3& direction) {
    const dvec3 d = glm::abs(direction);
    const double length = glm::length(d);
    if (!(length > 0))
        return dvec2(0.5);
    const double r = std::sqrt(std::max(1 - d.z / length, 0.0));
    const double larger = std::max(d.x, d.y), smaller = std::min(d.x, d.y);
    double phi = larger > 0 ? std::atan2(smaller, larger) * 2 / std::numbers::pi : 0;
    phi = d.x < d.y ? 1 - phi : phi;
    dvec2 at(r - phi * r, phi * r);
    if (direction.z < 0)
        at = dvec2(1 - at.y, 1 - at.x);
    return {0.5 * (std::copysign(at.x, direction.x) + 1),
            0.5 * (std::copysign(at.y, direction.y) + 1)};
}

dvec2 projected(ImageTexture::Projection projection, const dvec3& at) {
    const double around = std::hypot(at.x, at.z);
    switch (projection) {
    case ImageTexture::Projection::Planar:
        break;
    case ImageTexture::Projection::Spherical:
        return {share_of_turn(at.x, at.z), 0.5 + 2 * std::atan2(at.y, around) / kTurn};
    case ImageTexture::Projection::Cylindrical:
        return {share_of_turn(at.x, at.z), at.y};
    case ImageTexture::Projection::Torus:
        return {share_of_turn(at.x, at.z), share_of_turn(1 - around, -at.y)};
    case ImageTexture::Projection::LatLong:
        return {share_of_turn(at.x, at.y),
                1 - 2 * std::atan2(std::hypot(at.x, at.y), at.z) / kTurn};
    case ImageTexture::Projection::Octahedral:
        return octahedral(at);
    }
    return dvec2(at);
}

/// Returns how far one point of the picture lies from another. Around an axis, the shorter way.
dvec2 step(const ImageTexture& image, const dvec2& from, const dvec3& to) {
    dvec2 between = projected(image.projection, to) - from;
    if (image.projection != ImageTexture::Projection::Planar)
        between -= glm::round(between);
    return between;
}

dvec2 turned(const ImageTexture& image, const dvec2& side) {
    const std::array<dvec3, 2>& rows = image.to_picture;
    return {rows[0].x * side.x + rows[0].y * side.y, rows[1].x * side.x + rows[1].y * side.y};
}

vec3 of_channel(const ImageTexture& image, const vec4& found) {
    switch (image.channel) {
    case ImageTexture::Channel::Color:
        break;
    case ImageTexture::Channel::Red:
        return vec3(found.x);
    case ImageTexture::Channel::Green:
        return vec3(found.y);
    case ImageTexture::Channel::Blue:
        return vec3(found.z);
    case ImageTexture::Channel::Opacity:
        return vec3(found.w);
    case ImageTexture::Channel::Mask:
    case ImageTexture::Channel::CodedMask:
        if (image.lookup->has_opacity())
            return vec3(image.channel == ImageTexture::Channel::Mask
                            ? found.w
                            : linear_light(found.w, image.gamma));
        [[fallthrough]];
    case ImageTexture::Channel::Mean:
        return vec3((found.x + found.y + found.z) / 3);
    }
    return vec3(found);
}

} // namespace

TransparentColor color_at(const ImageTexture& image, const dvec3& at,
                          const std::array<dvec3, 2>& sides) {
    if (!image.lookup)
        return image.otherwise;
    const dvec2 st = projected(image.projection, at);
    const std::array<dvec3, 2>& rows = image.to_picture;
    PictureArea area{{glm::dot(rows[0], dvec3(st, 1)), glm::dot(rows[1], dvec3(st, 1))}};
    if (!std::isfinite(area.st.x) || !std::isfinite(area.st.y))
        return image.otherwise;
    if (sides[0] != dvec3(0) || sides[1] != dvec3(0)) {
        area.side_a = turned(image, step(image, st, at + sides[0]));
        area.side_b = turned(image, step(image, st, at + sides[1]));
    }
    area.beyond_s = image.beyond_s;
    area.beyond_t = image.beyond_t;
    area.filter = image.filter;
    const vec4 found = image.lookup->color(area);
    TransparentColor color;
    color.rgb = image.scale * of_channel(image, found) + image.offset;
    const float opacity = image.is_transparent ? std::clamp(found.w, 0.0f, 1.0f) : 1;
    color.filter = opacity * image.filter_all;
    color.transmit = 1 - opacity + opacity * image.transmit_all;
    return color;
}

/// Returns the solid angle of a texel at a place of the unit square, or that times the cosine by
/// which a surface receives its light, as a share of the square's. shape: width by height.
static double weight_of_texel(const ImageTexture& image, const dvec2& at, double shape) {
    const dvec2 signed_at = 2.0 * at - 1.0;
    switch (image.per) {
    case ImageTexture::Measure::None:
    case ImageTexture::Measure::Mean:
        break;
    case ImageTexture::Measure::ThroughWindow: {
        const dvec2 half = glm::max(dvec2(shape, 1 / shape), 1.0); // of the window
        const double distance = image.window_distance;
        const double cosine = distance / glm::length(dvec3(half * signed_at, distance));
        return 4 * half.x * half.y / (distance * distance) * cosine * cosine * cosine;
    }
    case ImageTexture::Measure::FromAbove: { // a texel at the rim of the upper half has z = 0
        const double from_rim = 1 - std::abs(signed_at.x) - std::abs(signed_at.y);
        const double r = 1 - from_rim;
        return from_rim > 0 ? 4 * std::numbers::pi * (1 - r * r) : 0;
    }
    }
    return 1;
}

double measured(const ImageTexture& image) {
    assert(image.lookup);
    const dvec2 size = glm::max(image.lookup->size(), 1.0);
    const size_t width = size_t(size.x), height = size_t(size.y);
    const auto add_texels = [&](size_t first, size_t last, double sum) {
        for (size_t i = first; i < last; ++i) {
            const dvec2 at = (dvec2(double(i % width), double(i / width)) + 0.5) / size;
            PictureArea texel{at};
            texel.filter = TexelFilter::Nearest;
            sum += weight_of_texel(image, at, size.x / size.y) *
                   luminance(of_channel(image, image.lookup->color(texel)));
        }
        return sum;
    };
    return parallel_reduce(width * height, 0.0, add_texels,
                           [](double a, double b) { return a + b; }) /
           (size.x * size.y);
}

} // namespace ovc
