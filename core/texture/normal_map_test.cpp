// SPDX-License-Identifier: Apache-2.0
#include "core/texture/normal_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

namespace {

/// Its gray is 3 s + t / 2.
class Ramp final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        return vec4(vec3(float(3 * area.st.x + 0.5 * area.st.y)), 1);
    }
    dvec2 size() const override { return dvec2(64, 64); }
    bool has_opacity() const override { return false; }
};

/// A texture with the same color everywhere.
class Even final : public ImageLookup {
public:
    explicit Even(const vec3& color) : color_(color, 1) {}
    vec4 color(const PictureArea&) const override { return color_; }
    dvec2 size() const override { return dvec2(1); }
    bool has_opacity() const override { return false; }

private:
    const vec4 color_;
};

std::vector<Texture> showing(const ImageLookup& lookup) {
    Texture texture;
    texture.kind = TextureKind::Image;
    texture.on_uv = true;
    texture.image = ImageTexture{.lookup = &lookup};
    return {texture};
}

/// A place of the plane of x and y, where u grows by 1 over two units of x, and v over one of y.
TexturePoint on_plane() {
    TexturePoint point{dvec3(1, 1, 0)};
    point.has_uv = true;
    point.uv = {0.25, 0.5};
    point.by_uv = {dvec3(2, 0, 0), dvec3(0, 1, 0)};
    return point;
}

void expect_near(const dvec3& found, const dvec3& expected) {
    EXPECT_LT(glm::length(found - glm::normalize(expected)), 1e-4)
        << found.x << " " << found.y << " " << found.z;
}

} // namespace

TEST(NormalMap, HeightsTiltAgainstTheirSlopeInTheWorld) {
    const Ramp ramp;
    const NormalMap map{.kind = NormalMap::Kind::Height, .scale = 0.5};
    // The height is 0.5 (3 x / 2 + y / 2).
    expect_near(tilted(showing(ramp), map, on_plane(), {0, 0, 1}), {-0.75, -0.25, 1});
    expect_near(tilted(showing(ramp), map, on_plane(), {0, 0, -1}), {-0.75, -0.25, -1});
}

TEST(NormalMap, TexelsMeasureHeightsByTheirOwnWidth) {
    const Ramp ramp;
    const NormalMap map{.kind = NormalMap::Kind::Texels, .scale = 8};
    // A texel is 1/32 of a unit wide.
    expect_near(tilted(showing(ramp), map, on_plane(), {0, 0, 1}), {-0.375, -0.125, 1});
}

TEST(NormalMap, ColorsAreNormalsAlongTheTextureCoordinates) {
    const Even right(vec3(1, 0.5f, 0.5f)), slanted(vec3(0.75f, 0.25f, 1));
    NormalMap map{.kind = NormalMap::Kind::Tangent};
    expect_near(tilted(showing(right), map, on_plane(), {0, 0, 1}), {1, 0, 0});
    expect_near(tilted(showing(slanted), map, on_plane(), {0, 0, 1}), {0.5, -0.5, 1});
    map.scale = 2;
    expect_near(tilted(showing(slanted), map, on_plane(), {0, 0, 1}), {1, -1, 1});
    TexturePoint mirrored = on_plane();
    mirrored.by_uv[1] = -mirrored.by_uv[1];
    expect_near(tilted(showing(slanted), map, mirrored, {0, 0, 1}), {1, 1, 1});
}

TEST(NormalMap, LeavesTheNormalWhereThereAreNoTextureCoordinates) {
    const Ramp ramp;
    TexturePoint point = on_plane();
    point.has_uv = false;
    expect_near(tilted(showing(ramp), {}, point, {0, 0, 1}), {0, 0, 1});
    point.has_uv = true;
    point.by_uv = {};
    expect_near(tilted(showing(ramp), {}, point, {0, 0, 1}), {0, 0, 1});
}

} // namespace ovc
