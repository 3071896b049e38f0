// SPDX-License-Identifier: Apache-2.0
#include "core/texture/bump.h"

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
};

void expect_normal(const Pattern& pattern, const Bump& bump, const dvec3& at, const dvec3& expected,
                   const char* name) {
    const std::vector<Texture> textures{{pattern, {{}}}};
    const dvec3 normal = bumped(textures, bump, at, {0, 0, -1});
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
