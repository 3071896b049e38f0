// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/thrown_light.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Shows s and t, and is twice as wide as high.
class ShowsSlidePlace final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        return {float(area.st.x), float(area.st.y), 0.5f, 1};
    }
    dvec2 size() const override { return dvec2(512, 256); }
    bool has_opacity() const override { return false; }
};

struct Slide {
    Scene scene;
    Light light;

    explicit Slide(ImageTexture::Projection projection, bool has_window, bool is_open = true) {
        static const ShowsSlidePlace lookup;
        Texture picture;
        picture.kind = TextureKind::Image;
        picture.image = ImageTexture{.projection = projection,
                                     .otherwise = {vec3(1)},
                                     .lookup = is_open ? &lookup : nullptr};
        scene.textures = {picture};
        light.position = {1, 2, 3};
        light.thrown = ThrownPicture{{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}},
                                     has_window};
    }
    void expect(const dvec3& way, const vec3& color) const {
        const vec3 seen = thrown_color(scene, light, light.position + way);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(seen[k], color[k], 1e-6) << way.x << ' ' << way.y << ' ' << way.z;
    }
};

TEST(ThrownLight, APictureAroundALampLiesInAllDirections) {
    const Slide slide(ImageTexture::Projection::LatLong, false);
    slide.expect({0, 0, 7}, {0, 1, 0.5f});
    slide.expect({3, 0, 0}, {0, 0.5f, 0.5f});
    slide.expect({0, 0.1, 0}, {0.25f, 0.5f, 0.5f});
    slide.expect({0, 0, 0}, vec3(0));
}

TEST(ThrownLight, AWindowHasTheShapeOfItsPicture) {
    const Slide slide(ImageTexture::Projection::Planar, true);
    slide.expect({0, 0, 2}, {0.5f, 0.5f, 0.5f});
    slide.expect({1.5, 0, 1}, {0.875f, 0.5f, 0.5f});
    slide.expect({-4, -2, 4}, {0.25f, 0.25f, 0.5f});
    slide.expect({0, 1.5, 1}, vec3(0));
    slide.expect({2.5, 0, 1}, vec3(0));
    slide.expect({0, 0, -2}, vec3(0));
}

TEST(ThrownLight, AWindowWithoutAPictureIsSquareAndWhite) {
    const Slide slide(ImageTexture::Projection::Planar, true, false);
    slide.expect({0.9, 0.9, 1}, vec3(1));
    slide.expect({1.5, 0, 1}, vec3(0));
}

TEST(ThrownLight, ALightMayBeScaled) {
    for (const double scale : {1e-6, 1e6}) {
        Slide slide(ImageTexture::Projection::Planar, true);
        for (dvec4& row : slide.light.thrown->texture.to_texture)
            row *= scale;
        slide.expect({1.5, 0, 1}, {0.875f, 0.5f, 0.5f});
        slide.expect({0, 0, -2}, vec3(0));
    }
}

TEST(ThrownLight, OtherLightsKeepTheirColor) {
    Slide slide(ImageTexture::Projection::Planar, true);
    slide.light.thrown.reset();
    slide.expect({0, 0, -2}, vec3(1));
}

} // namespace
} // namespace ovc
