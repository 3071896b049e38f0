// SPDX-License-Identifier: Apache-2.0
#include "core/texture/bump.h"

#include "core/texture/pattern.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

namespace {

using Kind = Pattern::Kind;
using Wave = Pattern::Wave;

struct AskedNormal {
    const char* name;
    Pattern pattern;
    Bump bump;
    dvec3 expected[2];
};

const dvec3 kPlaces[2] = {{-0.5, 0.5, 0.37}, {0.5, 0.5, 0.37}};

/// The light on plane { z, 0.37 pigment { rgb 1 } normal { NAME scale 0.7 } } under three parallel
/// lights, as povray 3.7.0.10 draws it, has these normals.
const AskedNormal kAskedNormals[] = {
    {"bumps 0.3",
     {.kind = Kind::Bozo},
     {.kind = Bump::Kind::Noise, .amount = 0.3},
     {{-0.05756, 0.02011, -0.99814}, {-0.00657, -0.01326, -0.99989}}},
    {"dents 0.6",
     {.kind = Kind::Dents},
     {.kind = Bump::Kind::Dents, .amount = 0.6},
     {{-0.00871, 0.00306, -0.99995}, {-0.00155, -0.00313, -1}}},
    {"wrinkles 0.3",
     {.kind = Kind::Wrinkles},
     {.kind = Bump::Kind::Wrinkles, .amount = 0.3},
     {{0.12888, 0.11449, -0.98503}, {0.10191, 0.06928, -0.99239}}},
    {"marble 0.4 turbulence 0.5",
     {.kind = Kind::Marble, .wave = Wave::Triangular, .turbulence = dvec3(0.5)},
     {.amount = 0.4},
     {{0.14274, 0.00078, -0.98976}, {-0.01389, 0.0105, -0.99985}}},
    {"granite 0.3",
     {.kind = Kind::Granite},
     {.amount = 0.3},
     {{0.20856, -0.06343, -0.97595}, {0.14849, -0.09166, -0.98465}}},
    {"leopard 0.8 accuracy 0.1",
     {.kind = Kind::Leopard},
     {.amount = 0.8, .accuracy = 0.1},
     {{-0.00872, -0.00852, -0.99992}, {-0.03058, -0.03109, -0.99905}}},
    {"ripples 0.4 frequency 2 phase 0.3",
     {.kind = Kind::Ripples, .frequency = 2, .phase = 0.3},
     {.kind = Bump::Kind::Ripples, .amount = 0.4},
     {{0.03168, -0.01119, -0.99944}, {-0.06864, 0.05175, -0.99630}}},
    {"waves 0.4 frequency 2 phase 0.3",
     {.kind = Kind::Waves, .frequency = 2, .phase = 0.3},
     {.kind = Bump::Kind::Waves, .amount = 0.4},
     {{0.10696, 0.05771, -0.99259}, {0.06771, 0.13985, -0.98786}}},
    {"quilted 0.5 control0 0.3 control1 0.8",
     {.kind = Kind::Quilted, .parameters = {0.3, 0.8}},
     {.kind = Bump::Kind::Quilted, .amount = 0.5},
     {{-0.03918, 0.03918, -0.99846}, {0.03918, 0.03918, -0.99846}}},
    {"facets coords 1",
     {.kind = Kind::Crackle, .parameters = {1, 0.1, 0, 2}},
     {.kind = Bump::Kind::Facets},
     {{0.12317, 0.28298, -0.9512}, {-0.19991, -0.24195, -0.94947}}},
    {"facets size 0.3",
     {.kind = Kind::Crackle, .parameters = {0, 0.3, 0, 2}},
     {.kind = Bump::Kind::Facets},
     {{-0.03196, 0.07878, -0.99638}, {-0.03196, 0.07878, -0.99638}}},
    {"onion slope_map { [0 <0, 1>] [0.5 <1, 0>] [1 <0, -1>] }",
     {.kind = Kind::Onion},
     {.profile = {{0, 0, 1}, {0.5, 1, 0}, {1, 0, -1}}},
     {{0.10140, -0.10114, -0.98969}, {-0.10127, -0.10110, -0.98971}}},
};

void expect_normal(const Pattern& pattern, const Bump& bump, const dvec3& at, const dvec3& expected,
                   const char* name) {
    const std::vector<Texture> textures{{pattern, {{}}}};
    const dvec3 normal = bumped(textures, {}, bump, at, {0, 0, -1}, {0, 0, 1});
    EXPECT_LT(glm::length(normal - expected), 1e-4)
        << name << ": " << normal.x << " " << normal.y << " " << normal.z;
}

} // namespace

TEST(Bump, TiltsNormalsAsPovrayDoes) {
    for (const AskedNormal& asked : kAskedNormals)
        for (int i = 0; i < 2; ++i) {
            Bump bump = asked.bump;
            const double scale = 1 / 0.7;
            bump.pattern.to_texture = {dvec4(scale, 0, 0, 0), dvec4(0, scale, 0, 0),
                                       dvec4(0, 0, scale, 0)};
            expect_normal(asked.pattern, bump, kPlaces[i], asked.expected[i], asked.name);
        }
}

TEST(Bump, MayKeepItsDepthWhereItsPatternIsScaled) {
    std::vector<Texture> textures{{{.kind = Kind::Leopard}, {{}}}};
    Bump half{.amount = 0.8};
    half.pattern.to_texture = {dvec4(2, 0, 0, 0), dvec4(0, 2, 0, 0), dvec4(0, 0, 2, 0)};
    Bump deeper = half;
    half.keeps_depth = true;
    deeper.amount *= 2;
    const auto normal = [&](const Bump& bump) {
        return bumped(textures, {}, bump, {0.4, 0.3, 0.2}, {0, 0, -1}, {0, 0, 1});
    };
    EXPECT_LT(glm::length(normal(half) - normal(deeper)), 1e-12);
    EXPECT_LT(normal(half).z, 0);
    EXPECT_GT(normal(half).z, -1);
}

TEST(Bump, MixesNormalsAsPovrayDoes) {
    const struct {
        const char* name;
        Kind pattern;
        double at[2]; // of the two stops: bumps 0.3 and leopard 0.8
        dvec3 expected[2];
    } kMixes[] = {{"planar",
                   Kind::Planar,
                   {0, 1},
                   {{-0.04368, 0.01185, -0.99898}, {-0.01361, -0.01841, -0.99974}}},
                  {"average",
                   Kind::Average,
                   {1, 3},
                   {{-0.02107, -0.00163, -0.99978}, {-0.02501, -0.02676, -0.99933}}},
                  {"checker",
                   Kind::Checker,
                   {0, 1},
                   {{-0.00890, -0.00887, -0.99992}, {-0.00658, -0.01326, -0.99989}}}};
    const double scale = 1 / 0.7;
    const std::array<dvec4, 3> rows{dvec4(scale, 0, 0, 0), dvec4(0, scale, 0, 0),
                                    dvec4(0, 0, scale, 0)};
    const std::vector<Bump> bumps{{.kind = Bump::Kind::Noise, .amount = 0.3, .pattern = {0, rows}},
                                  {.amount = 0.8, .pattern = {1, rows}}};
    for (const auto& mix : kMixes) {
        const std::vector<Texture> textures{{{.kind = Kind::Bozo}, {{}}},
                                            {{.kind = Kind::Leopard}, {{}}},
                                            {{.kind = mix.pattern}, {{mix.at[0]}, {mix.at[1]}}}};
        const Bump whole{.kind = Bump::Kind::Mix, .pattern = {2, rows}, .parts = {0, 1}};
        for (int i = 0; i < 2; ++i) {
            const dvec3 normal = bumped(textures, bumps, whole, kPlaces[i], {0, 0, -1}, {0, 0, 1});
            EXPECT_LT(glm::length(normal - mix.expected[i]), 1e-4) << mix.name << " " << i;
        }
    }
}

/// A picture of 16 x 16 grays that are 0 except at three texels.
class ThreeTexels final : public ImageLookup {
public:
    ThreeTexels(double here, double left, double right) : codes_{here, left, right} {}

    vec4 color(const PictureArea& area) const override {
        const int x = int(std::floor(16 * area.st.x)), down = 15 - int(std::floor(16 * area.st.y));
        const bool here = down == 9 && x == 7, left = down == 10 && x == 6;
        const bool right = down == 10 && x == 8;
        const double code = here ? codes_[0] : left ? codes_[1] : right ? codes_[2] : 0;
        return vec4(vec3(float(code / 255)), 1);
    }
    dvec2 size() const override { return dvec2(16); }
    bool has_opacity() const override { return false; }

private:
    double codes_[3];
};

TEST(Bump, TiltsNormalsByThreeTexelsAsPovrayDoes) {
    // povray's normals of bump_map { png … bump_size 1 } at the middle of a texel, whose code
    // comes first, then those of the texels below it to the left and right.
    const struct {
        double codes[3];
        dvec3 expected;
    } kAsked[] = {{{123, 120, 126}, {-0.01177, 0.00001, -0.99992}},
                  {{136, 119, 134}, {-0.02938, -0.03719, -0.99887}}};
    for (const auto& asked : kAsked) {
        const ThreeTexels lookup(asked.codes[0], asked.codes[1], asked.codes[2]);
        Texture texture{.kind = TextureKind::Image, .image = ImageTexture{}};
        texture.image->lookup = &lookup;
        Bump bump{.kind = Bump::Kind::Picture, .amount = 1};
        bump.pattern.to_texture = {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};
        const dvec3 normal = bumped(std::vector<Texture>{texture}, {}, bump,
                                    {7.5 / 16, 1 - 9.5 / 16, 0}, {0, 0, -1}, {0, 0, 1});
        EXPECT_LT(glm::length(normal - asked.expected), 1e-4)
            << normal.x << " " << normal.y << " " << normal.z;
    }
}

TEST(Bump, LooksAroundThePlaceThatWarpsLeadTo) {
    // As povray does, whose crackle has one slope in a cell, whatever the turbulence in it.
    Pattern cracked{.kind = Kind::Crackle, .parameters = {-1, 1, 0, 2, 0, 0}};
    const Pattern still = cracked;
    cracked.turbulence = dvec3(0.5);
    const Bump bump{.amount = 0.5,
                    .pattern = {0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}}};
    for (const dvec3& at : kPlaces) {
        const std::vector<Texture> there{{still, {{}}}};
        expect_normal(cracked, bump, at,
                      bumped(there, {}, bump, moved(cracked, at), {0, 0, -1}, {0, 0, 1}),
                      "turbulence");
    }
}

TEST(Bump, IsStretchedByTheMapsBetweenWarpsAsWell) {
    const double scale = 1 / 0.7;
    Bump bump{.amount = 0.8};
    bump.pattern.to_texture = {dvec4(scale, 0, 0, 0), dvec4(0, scale, 0, 0), dvec4(0, 0, scale, 0)};
    Bump within = bump;
    within.pattern.to_texture = {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};
    const Pattern leopard{.kind = Kind::Leopard};
    Pattern stepped = leopard;
    stepped.steps = {{TextureStep::Kind::Affine, bump.pattern.to_texture}};
    const std::vector<Texture> textures{{leopard, {{}}}};
    for (const dvec3& at : kPlaces)
        expect_normal(stepped, within, at, bumped(textures, {}, bump, at, {0, 0, -1}, {0, 0, 1}),
                      "scale");
}

TEST(Bump, IsStretchedWithItsPattern) {
    // povray's normals of bumps 0.5 scale <0.2, 1, 0.5> rotate 30*z.
    Bump bump{.kind = Bump::Kind::Noise, .amount = 0.5};
    const double c = std::sqrt(0.75), s = 0.5;
    bump.pattern.to_texture = {dvec4(c / 0.2, s / 0.2, 0, 0), dvec4(-s, c, 0, 0),
                               dvec4(0, 0, 2, 0)};
    expect_normal({.kind = Kind::Bozo}, bump, kPlaces[0], {0.02664, -0.05611, -0.99806}, "left");
    expect_normal({.kind = Kind::Bozo}, bump, kPlaces[1], {0.01518, 0.09923, -0.99495}, "right");
}

} // namespace ovc
