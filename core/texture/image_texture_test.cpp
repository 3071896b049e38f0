// SPDX-License-Identifier: Apache-2.0
#include "core/texture/image_texture.h"

#include "core/scene.h"
#include "core/texture/pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ovc {

namespace {

using Projection = ImageTexture::Projection;

/// Shows s in red, t in green and the length of side_a in blue; its opacity is 0.25.
class ShowsPlace final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        return {float(area.st.x), float(area.st.y), float(glm::length(area.side_a)), 0.25f};
    }
    dvec2 size() const override { return dvec2(4, 2); }
    bool has_opacity() const override { return shows_opacity; }

    bool shows_opacity = true;
};

const ShowsPlace kShowsPlace{};

ImageTexture image_by(Projection projection) {
    ImageTexture image;
    image.projection = projection;
    image.lookup = &kShowsPlace;
    return image;
}

dvec2 place_of(Projection projection, const dvec3& at) {
    return dvec2(vec2(color_at(image_by(projection), at, {}).rgb));
}

void expect_place(Projection projection, const dvec3& at, const dvec2& expected) {
    const dvec2 found = place_of(projection, at);
    EXPECT_NEAR(found.x, expected.x, 1e-6) << int(projection);
    EXPECT_NEAR(found.y, expected.y, 1e-6) << int(projection);
}

} // namespace

TEST(ImageTexture, ProjectsPointsByTheFormulasOfTheirNames) {
    const double turn = 2 * std::numbers::pi;
    expect_place(Projection::Planar, {0.25, -3, 7}, {0.25, -3});
    expect_place(Projection::Cylindrical, {0, 0.4, 2}, {0.25, 0.4});
    for (const double around : {0.1, 0.3, 0.6, 0.95})
        for (const double up : {-0.2, 0.0, 0.12}) {
            const double c = std::cos(turn * around), s = std::sin(turn * around);
            const double flat = std::cos(turn * up), high = std::sin(turn * up);
            expect_place(Projection::Spherical, {3 * flat * c, 3 * high, 3 * flat * s},
                         {around, 0.5 + 2 * up});
            expect_place(Projection::LatLong, {flat * c, flat * s, high}, {around, 0.5 + 2 * up});
            // On the ring of radius 1, `up` turns from its inside up.
            const double r = 1 - 0.25 * flat;
            expect_place(Projection::Torus, {r * c, -0.25 * high, r * s},
                         {around, up < 0 ? 1 + up : up});
        }
}

TEST(ImageTexture, TheOctahedralMapKeepsAreasAndAxes) {
    expect_place(Projection::Octahedral, {0, 0, 1}, {0.5, 0.5});
    expect_place(Projection::Octahedral, {1, 0, 0}, {1, 0.5});
    expect_place(Projection::Octahedral, {0, -1, 0}, {0.5, 0});
    expect_place(Projection::Octahedral, {0, 0, -1}, {1, 1});
    // Each quarter of the picture and each cell in it gets its share of evenly spread directions.
    constexpr int kCells = 8, kDirections = 200'000;
    std::array<int, kCells * kCells> counts{};
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2.0 * i + 1) / kDirections;
        const double phi = i * std::numbers::pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
        const dvec2 at =
            place_of(Projection::Octahedral, {r * std::cos(phi), r * std::sin(phi), z});
        const auto cell = [](double x) { return std::min(int(x * kCells), kCells - 1); };
        ++counts[size_t(cell(at.y) * kCells + cell(at.x))];
    }
    for (const int count : counts)
        EXPECT_NEAR(count, kDirections / double(kCells * kCells), 0.03 * kDirections / 64);
}

/// A white picture gives as much as the definitions say; one that is s in red and t in green the
/// mean of both by brightness.
TEST(ImageTexture, MeasuresTheLightOfPictures) {
    class White final : public ImageLookup {
    public:
        vec4 color(const PictureArea&) const override { return vec4(1); }
        dvec2 size() const override { return {300, 200}; }
        bool has_opacity() const override { return false; }
    };
    const White white;
    ImageTexture image;
    image.lookup = &white;
    image.per = ImageTexture::Measure::Mean;
    EXPECT_NEAR(measured(image), 1, 1e-6);
    image.per = ImageTexture::Measure::FromAbove;
    EXPECT_NEAR(measured(image), std::numbers::pi, 1e-3);
    // The solid angle of a pyramid of a x b at the distance d is 4 asin(a b / sqrt(...)).
    image.per = ImageTexture::Measure::ThroughWindow;
    image.window_distance = 2;
    const double a = 1.5 / 2, b = 1.0 / 2;
    const double angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    EXPECT_NEAR(measured(image), angle, 1e-4);
    image.lookup = &kShowsPlace;
    image.per = ImageTexture::Measure::Mean;
    EXPECT_NEAR(measured(image), 0.5 * (0.2126 + 0.7152), 1e-6);
}

TEST(ImageTexture, ScalesTurnsAndTakesChannels) {
    ImageTexture image = image_by(Projection::Planar);
    image.to_picture = {dvec3(0, 2, 0.5), dvec3(-1, 0, 0)};
    image.scale = vec3(-1);
    image.offset = vec3(1);
    const TransparentColor color = color_at(image, {0.25, 0.125, 0}, {dvec3(0.5, 0, 0)});
    EXPECT_EQ(color.rgb, vec3(1 - 0.75f, 1 + 0.25f, 1 - 0.5f));
    EXPECT_EQ(color.transmit, 0);
    image.is_transparent = true;
    EXPECT_EQ(color_at(image, dvec3(0), {}).transmit, 0.75f);
    image.scale = vec3(1);
    image.offset = vec3(0);
    image.channel = ImageTexture::Channel::Green;
    EXPECT_EQ(color_at(image, {0.25, 0, 0}, {}).rgb, vec3(-0.25f));
    for (const auto channel : {ImageTexture::Channel::Opacity, ImageTexture::Channel::Mask}) {
        image.channel = channel;
        EXPECT_EQ(color_at(image, {0.25, 0, 0}, {}).rgb, vec3(0.25f));
    }
    image.channel = ImageTexture::Channel::CodedMask;
    image.gamma = 2;
    EXPECT_EQ(color_at(image, {0.25, 0, 0}, {}).rgb, vec3(0.0625f));
    ShowsPlace opaque;
    opaque.shows_opacity = false;
    image.lookup = &opaque;
    EXPECT_EQ(color_at(image, {0.25, 0, 0}, {}).rgb, vec3((0.5f - 0.25f) / 3));
    image.transmit_all = 0.5f;
    image.filter_all = 0.25f;
    const TransparentColor glass = color_at(image, {0, 0, 0}, {});
    EXPECT_EQ(glass.filter, 0.25f * 0.25f);
    EXPECT_EQ(glass.transmit, 0.75f + 0.25f * 0.5f);
}

TEST(ImageTexture, AFootprintAcrossTheSeamOfASphereIsSmall) {
    const ImageTexture image = image_by(Projection::Spherical);
    const TransparentColor color = color_at(image, {1, 0, -0.01}, {dvec3(0, 0, 0.02)});
    EXPECT_NEAR(color.rgb.z, 0.02 / (2 * std::numbers::pi), 1e-4);
}

TEST(ImageTexture, HasAnotherColorWithoutAPictureOrAPlace) {
    ImageTexture image = image_by(Projection::Planar);
    image.otherwise = {vec3(0.25f, 0.5f, 1)};
    EXPECT_EQ(color_at(image, dvec3(std::numeric_limits<double>::quiet_NaN()), {}).rgb,
              vec3(0.25f, 0.5f, 1));
    image.lookup = nullptr;
    EXPECT_EQ(color_at(image, dvec3(0), {}).rgb, vec3(0.25f, 0.5f, 1));
}

/// An image on texture coordinates, the product of it and a half, and both mixed by the image.
static std::vector<Texture> tree() {
    std::vector<Texture> textures(3);
    textures[0].kind = TextureKind::Image;
    textures[0].on_uv = true;
    textures[0].image = image_by(Projection::Planar);
    textures[1].kind = TextureKind::Product;
    textures[1].stops = {{0, {}, 0}, {0, {vec3(0.5f)}, kNoTexture}};
    textures[2].kind = TextureKind::Mix;
    textures[2].stops = {{0, {vec3(1, 0, 0)}, kNoTexture}, {0, {}, 1}, {0, {vec3(0.25f)}}};
    return textures;
}

TEST(ImageTexture, MakesProductsAndMixes) {
    const std::vector<Texture> textures = tree();
    TexturePoint point{dvec3(9)};
    point.has_uv = true;
    point.uv = {0.5, 0.25};
    EXPECT_EQ(color_at(textures, 0, point).rgb, vec3(0.5f, 0.25f, 0));
    EXPECT_EQ(color_at(textures, 1, point).rgb, vec3(0.25f, 0.125f, 0));
    EXPECT_EQ(color_at(textures, 2, point).rgb, vec3(0.8125f, 0.03125f, 0));
    EXPECT_EQ(value_at(textures, 1, point), 0.125);
    point.has_uv = false;
    EXPECT_EQ(color_at(textures, 0, point).rgb, vec3(0.5f)) << "ImageTexture::otherwise";
}

TEST(ImageTexture, AStepMovesThePointAndItsFootprint) {
    std::vector<Texture> textures = tree();
    textures[0].on_uv = false;
    textures[0].pattern.steps = {
        {TextureStep::Kind::Affine, {dvec4(0, 0, 3, 1), dvec4(0, 1, 0, 0), dvec4(1, 0, 0, 0)}}};
    TexturePoint point{dvec3(0, 0.5, 0.25)};
    point.sides = {dvec3(0, 0, 0.5), dvec3(0)};
    EXPECT_EQ(color_at(textures, 0, point).rgb, vec3(1.75f, 0.5f, 1.5f));
}

TEST(ImageTexture, MaterialsSayWhetherTheyLieOnTextureCoordinates) {
    Scene scene;
    scene.textures = tree();
    scene.textures.push_back({{}, {{0, {vec3(1)}, kNoTexture}}});
    scene.materials.resize(5);
    scene.materials[0].texture = PlacedTexture{2};
    scene.materials[1].texture = PlacedTexture{3};
    scene.materials[2].maps = MaterialMaps{.width = 1};
    scene.materials[3].under = 0;
    EXPECT_EQ(materials_on_uv(scene), (std::vector<bool>{true, false, true, true, false}));
}

} // namespace ovc
