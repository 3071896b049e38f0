// SPDX-License-Identifier: Apache-2.0
#include "core/texture/bump.h"
#include "core/texture/pattern.h"
#include "importers/pov/test_parse.h"
#include "importers/readers.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

namespace ovc {

namespace {

Scene textured_scene(const std::string& text) {
    Result<Scene> scene = parsed_scene("#version 3.7;\n" + text);
    if (!scene) {
        ADD_FAILURE() << text << ": " << scene.error().message;
        return {};
    }
    return std::move(*scene);
}

Scene textured_box(const std::string& look) {
    return textured_scene("box { -1, 1 " + look + " }");
}

const Material& box_material(const Scene& scene) {
    return scene.materials.at(scene.meshes.at(0).material);
}

/// Returns the color of the box at a point.
TransparentColor box_color(const Scene& scene, const dvec3& at) {
    const Material& material = box_material(scene);
    if (!material.texture) {
        ADD_FAILURE() << "no texture";
        return {};
    }
    return color_at(scene.textures, material.texture->texture, material.texture->at(at));
}

const dvec3 kPlaces[2] = {dvec3(vec3(0.31f, 0.72f, 0.15f)), dvec3(vec3(-1.7f, 2.25f, 0.55f))};

struct AskedColors {
    const char* pigment;
    vec3 at_places[2];
};

/// The colors are those that povray 3.7.0.10 prints for function { pigment { … } }.
const AskedColors kAskedColors[] = {
    {"bozo", {{0, 1, 0}, {0, 0, 1}}},
    {"marble", {{0.90000f, 0.30400f, 0.30400f}, {0.90000f, 0.31998f, 0.31998f}}},
    {"wood", {{0.66600f, 0.31200f, 0.20000f}, {0.66600f, 0.31200f, 0.20000f}}},
    {"agate", {{0.69270f, 0.39270f, 0.09270f}, {0.66650f, 0.36650f, 0.06650f}}},
    {"radial", {{0.21475f, 0.78525f, 1}, {1, 0.34895f, 0.65105f}}},
    {"brick", {{0.60000f, 0.15000f, 0.15000f}, {0.60000f, 0.15000f, 0.15000f}}},
    {"hexagon", {{0, 0, 1}, {1, 0, 0}}},
    {"cubic", {{0, 1, 0}, {0, 1, 0}}},
    {"checker rgb x, rgb z scale 0.4", {{0, 0, 1}, {0, 0, 1}}},
    {"gradient <1,2,0> turbulence 0.4 color_map { [0.2 rgb x] [0.5 rgb y] [0.5 rgb z] [0.8 rgb 1] "
     "} rotate 30*z",
     {{0.00197f, 0.99803f, 0}, {0.28722f, 0.71278f, 0}}},
    {"marble turbulence 0.3 lambda 2.2 pigment_map { [0.1 bozo scale 0.3] [0.7 rgb x] } scale 0.7 "
     "translate 0.2",
     {{1, 0, 0}, {1, 0.04190f, 0.04190f}}},
    {"granite warp { turbulence 0.3 octaves 2 } scale 0.5 warp { repeat 2*x offset y flip x } "
     "rotate 20*y",
     {{0.31106f, 0.31106f, 0.31106f}, {0.39213f, 0.39213f, 0.39213f}}},
    {"average pigment_map { [1 wood scale 0.2] [2 leopard scale 0.1] }",
     {{0.47081f, 0.35281f, 0.31548f}, {0.22596f, 0.10796f, 0.07063f}}},
    {"checker pigment { onion } pigment { gradient x } turbulence 0.2",
     {{0.71963f, 0.71963f, 0.71963f}, {0.82224f, 0.82224f, 0.82224f}}},
    {"wrinkles color_map { [0, 0.4 color rgb 0 color rgb 1] [0.4, 1 color rgb x color rgb y] } "
     "scale 0.3",
     {{0.52206f, 0.47794f, 0}, {0.51706f, 0.48294f, 0}}},
    {"spherical sine_wave frequency 3 phase 0.1 scale 2 color_map { [0 rgb x] [1 rgb z] }",
     {{0.78672f, 0, 0.21328f}, {0.20611f, 0, 0.79389f}}},
    {"function { pow(Wood_fn(x, y, z).red, 2) } color_map { [0 rgb x] [1 rgb z] }",
     {{0.55644f, 0, 0.44356f}, {0.84f, 0, 0.16f}}},
    {"function { abs(Turn(x, y, z).y) * 0.3 + Cracks(x, y, z) / 4 } color_map { [0 rgb x] [1 rgb "
     "z] }",
     {{0.50591f, 0, 0.49409f}, {0.26453f, 0, 0.73547f}}},
    {"function { Wood_fn(x, y, z).gray } scale 2 color_map { [0 rgb x] [1 rgb z] }",
     {{0.59563f, 0, 0.40437f}, {0.59563f, 0, 0.40437f}}},
    {"pigment_pattern { marble turbulence 0.2 } color_map { [0 rgb x] [1 rgb z] }",
     {{1, 0, 0}, {0.65664f, 0, 0.34336f}}},
    {"crackle form <1, 0, 0> turbulence 0.2 scale 0.5 color_map { [0 rgb x] [1 rgb z] }",
     {{0.19761f, 0, 0.80239f}, {0.33783f, 0, 0.66217f}}},
    {"julia <0.353, 0.288>, 20 interior 1, 1 scale 2 color_map { [0 rgb x] [1 rgb z] }",
     {{0.60805f, 0, 0.39195f}, {0.95f, 0, 0.05f}}},
    {"mandel 22 interior 6, 1.78 scale 4 color_map { [0 rgb x] [1 rgb z] }",
     {{0.92998f, 0, 0.07002f}, {0.94457f, 0, 0.05543f}}},
    {"mandel 20", {{0, 1, 1}, {0, 0, 0}}},
    {"mandel 20 exponent 3 scale 2", {{1, 1, 1}, {0, 0, 0}}},
    {"triangular rgb x, rgb z scale 0.4", {{1, 0, 0}, {0, 0, 1}}},
    {"square rgb x, rgb z scale 0.4", {{1, 0, 0}, {0, 0, 1}}},
    {"square rgb x rgb y rgb z rgb 1 scale <0.3, 1, 0.1> cubic_wave", {{1, 0, 0}, {0, 1, 0}}},
    {"brick rgb x rgb z brick_size 0.4 mortar 0.1 frequency -1.39 phase 1.93",
     {{0.07001f, 0, 0.92999f}, {0.46f, 0, 0.54f}}},
    {"hexagon rgb x rgb y rgb z scale 0.4 frequency 0.3 phase 0.1",
     {{0.9f, 0.1f, 0}, {0.3f, 0.7f, 0}}},
    {"checker rgb x rgb z scale 0.4 phase 0.4", {{0, 0, 1}, {0, 0, 1}}},
    {"triangular rgb x rgb y rgb z scale 0.4 triangle_wave", {{1, 0, 0}, {1, 0, 0}}},
    {"gradient x warp { black_hole <0, 1, 0>, 3 strength 0.5 } color_map { [0 rgb x] [1 rgb z] }",
     {{0.57747f, 0, 0.42253f}, {0.7634f, 0, 0.2366f}}},
    {"function { select(x, min(y, 0.7, z), 0, max(x, y) / 2) } color_map { [0 rgb x] [1 rgb z] }",
     {{0.64f, 0, 0.36f}, {0.45f, 0, 0.55f}}},
};

/// Functions that the pigments call.
const char* const kFunctions =
    "#declare Wood_fn = function { pigment { wood turbulence 0.1 scale 0.3 } }\n"
    "#declare Turn = function { transform { rotate 30*z scale 2 } }\n"
    "#declare Cracks = function { pattern { crackle scale 0.4 } }\n";

} // namespace

TEST(PovPattern, HasTheColorsThatPovrayPrints) {
    for (const AskedColors& asked : kAskedColors) {
        const Scene scene = textured_scene(
            kFunctions + ("box { -1, 1 pigment { " + std::string(asked.pigment) + " } }"));
        for (int place = 0; place < 2; ++place) {
            const TransparentColor color = box_color(scene, kPlaces[place]);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(color.rgb[i], asked.at_places[place][i], 2e-4)
                    << asked.pigment << " " << i;
        }
    }
}

/// As inside() of povray 3.7.0.10 says.
TEST(PovPattern, TellsInsideFromOutside) {
    const Scene scene = textured_scene(
        "#declare O = difference { sphere { 0, 1 } box { 0, 2 } }\n"
        "box { -1, 1 pigment { object { union { object { O } plane { y, -0.8 } } rgb x rgb z } "
        "scale 2 } }");
    EXPECT_TRUE(scene.omissions.empty());
    EXPECT_EQ(box_color(scene, {-1, 1, 1}).rgb, vec3(0, 0, 1));
    EXPECT_EQ(box_color(scene, {1, 1, 1}).rgb, vec3(1, 0, 0)) << "within the box";
    EXPECT_EQ(box_color(scene, {-1, -1.7, 1}).rgb, vec3(0, 0, 1)) << "below the plane";
    EXPECT_EQ(box_color(scene, {-1.9, 1, 1}).rgb, vec3(1, 0, 0));
    const Scene everted =
        textured_scene("box { -1, 1 pigment { object { box { 0, 1 inverse } rgb x rgb z } } }");
    EXPECT_EQ(box_color(everted, dvec3(0.5)).rgb, vec3(1, 0, 0));
    EXPECT_EQ(box_color(everted, dvec3(-0.5)).rgb, vec3(0, 0, 1));
}

/// The texture coordinates are those that povray 3.7.0.10 draws; see core/texture/warp.cpp.
TEST(PovPattern, LiesOnTextureCoordinatesOfShapes) {
    const auto uv_at = [](const std::string& shape, const dvec3& at) {
        const auto value = [&](const char* axis) {
            const Scene scene =
                textured_scene(shape + " pigment { uv_mapping function { " + axis +
                               " } color_map { [0 rgb 0] [1 rgb 1] } } scale 2 translate 3*x }");
            EXPECT_TRUE(scene.omissions.empty());
            return double(box_color(scene, 2.0 * at + dvec3(3, 0, 0)).rgb.x);
        };
        return dvec2(value("x"), value("y"));
    };
    const auto expect_uv = [](const dvec2& found, const dvec2& expected) {
        EXPECT_LT(glm::length(found - expected), 1e-3) << found.x << " " << found.y;
    };
    expect_uv(uv_at("sphere { y, 1", {0.222, 0.556, -0.868}), {0.7899, 0.3534});
    expect_uv(uv_at("torus { 1, 0.4", {0.667, 0.345, 1}), {0.3436, 0.6658});
    const struct {
        dvec3 at;
        dvec2 uv;
    } kSides[] = {{{-0.75, 0.75, -1}, {0.9687, 0.625}}, {{0.75, 0.75, 1}, {0.4688, 0.625}},
                  {{1, 0.75, -0.75}, {0.7187, 0.625}},  {{-1, 0.75, 0.75}, {0.2188, 0.625}},
                  {{-0.75, 1, 0.75}, {0.2813, 0.7083}}, {{0.75, -1, 0.75}, {0.4688, 0.2917}}};
    for (const auto& side : kSides)
        expect_uv(uv_at("box { <-2, -1, -1>, <2, 1, 1>", side.at * dvec3(2, 1, 1)), side.uv);
    expect_uv(uv_at("sor { 4, <0.5, -1.5>, <0.6, -1>, <0.9, 1>, <1, 1.5>", {0, 0.222, -0.8}),
              {0.75, 0.611});
    // Others have those of the world.
    expect_uv(uv_at("cylinder { -y, y, 1", {-1.4, 0.3, 0}), {0.2, 0.6});
}

TEST(PovPattern, MovesWithItsObject) {
    const std::string map = " color_map { [0 rgb 0] [1 rgb 1] } ";
    const Scene still = textured_box("pigment { gradient x" + map + "}");
    const Scene moved = textured_box("pigment { gradient x" + map + "scale 2 } translate 3*x");
    EXPECT_NEAR(box_color(still, {0.25, 0, 0}).rgb.x, 0.25, 1e-6);
    EXPECT_NEAR(box_color(moved, {3.5, 0, 0}).rgb.x, 0.25, 1e-6);
}

TEST(PovPattern, ChangesWhatANameStandsFor) {
    const Scene scene = textured_scene("#declare P = pigment { marble color_map { [0 rgb x]"
                                       " [1 rgb y] } } box { -1, 1 pigment { P turbulence 0.5 } }");
    const Texture& texture = scene.textures.at(box_material(scene).texture->texture);
    EXPECT_EQ(texture.pattern.kind, Pattern::Kind::Marble);
    EXPECT_EQ(texture.pattern.turbulence, dvec3(0.5));
    EXPECT_EQ(texture.stops.at(1).color.rgb, vec3(0, 1, 0));
}

TEST(PovPattern, OldScenesHaveOldNoise) {
    for (const auto& [version, kind] :
         {std::pair{"3.1", NoiseKind::Original}, {"3.6", NoiseKind::Corrected}}) {
        const Scene scene =
            textured_scene("#version " + std::string(version) + "; box { -1, 1 pigment { bozo } }");
        EXPECT_EQ(scene.textures.at(0).pattern.noise, kind) << version;
    }
}

TEST(PovTexture, HasLayers) {
    const Scene scene =
        textured_box("texture { pigment { rgb x } finish { ambient 0.5 } } "
                     "texture { pigment { bozo color_map { [0 rgb y] [1 rgbt 1] } } }");
    const Material& upper = box_material(scene);
    ASSERT_NE(upper.under, kNone);
    EXPECT_GT(upper.transmission, 0);
    EXPECT_EQ(scene.materials[upper.under].color, vec3(1, 0, 0));
    EXPECT_EQ(scene.materials[upper.under].finish->ambient, vec3(0.5f));
}

TEST(PovTexture, MixesTextures) {
    const Scene scene =
        textured_box("texture { gradient y texture_map { [0.4 pigment { rgb x }] [0.6 "
                     "pigment { checker } finish { phong 1 } scale 2] } scale 3 }");
    const Material& mixed = box_material(scene);
    ASSERT_TRUE(mixed.mix);
    const Texture& mix = scene.textures.at(mixed.mix->texture);
    ASSERT_EQ(mix.stops.size(), 2u);
    EXPECT_EQ(scene.materials.at(mix.stops[0].texture).color, vec3(1, 0, 0));
    const Material& checkered = scene.materials.at(mix.stops[1].texture);
    EXPECT_EQ(checkered.finish->phong, 1);
    ASSERT_TRUE(checkered.texture);
    EXPECT_EQ(checkered.texture->at({6, 12, -6}), dvec3(1, 2, -1)) << "both scales";
}

/// Transformations, warps and turbulence, in the order in which povray applies them.
const char* const kMoves[] = {
    "turbulence 0.4",
    "scale 0.5 warp { repeat 0.3*y offset 0.1*x flip y } rotate 20*z turbulence 0.2",
    "warp { black_hole <0, 1, 0>, 3 strength 0.5 } translate 0.3 warp { turbulence 0.3 octaves 2 "
    "}"};

/// As povray draws it, and as a map of pigments does.
TEST(PovTexture, WarpsOfAMixMoveItsTextures) {
    const std::string part = "pigment { gradient z color_map { [0 rgb x] [1 rgb y] } scale 0.3 }";
    for (const std::string moves : kMoves)
        for (const char* pattern : {"planar", "average"}) {
            const Scene of_textures =
                textured_box("texture { " + std::string(pattern) + " texture_map { [1 " + part +
                             " rotate 10*y] [1 " + part + "] } " + moves + " }");
            const Scene of_pigments =
                textured_box("pigment { " + std::string(pattern) + " pigment_map { [1 " +
                             part.substr(9, part.size() - 11) + " rotate 10*y] [1 " +
                             part.substr(9, part.size() - 11) + "] } " + moves + " }");
            const auto stops_of = [](const Scene& scene, const PlacedTexture& placed) {
                return scene.textures.at(placed.texture).stops;
            };
            const Material& mixed = box_material(of_textures);
            ASSERT_TRUE(mixed.mix);
            const PlacedTexture whole = *box_material(of_pigments).texture;
            for (const dvec3& at : kPlaces)
                for (size_t i = 0; i < 2; ++i) {
                    const uint32_t stop = stops_of(of_textures, *mixed.mix).at(i).texture;
                    const Material& material = of_textures.materials.at(stop);
                    const vec3 found = color_at(of_textures.textures, *material.texture, at).rgb;
                    const Pattern& outer = of_pigments.textures.at(whole.texture).pattern;
                    const TexturePoint moved =
                        evaluate(of_pigments.textures, outer, whole.at(at)).at;
                    const vec3 expected =
                        color_at(of_pigments.textures, stops_of(of_pigments, whole).at(i).texture,
                                 moved)
                            .rgb;
                    EXPECT_LT(glm::length(found - expected), 1e-5f) << pattern << " " << moves;
                }
        }
}

/// As a plane is bright that povray 3.7.0.10 draws, lit and seen head on.
TEST(PovFinish, AlbedosAreOfAllDirectionsTogether) {
    const Scene scene =
        textured_box("pigment { rgb 1 } finish { diffuse albedo 0.4 brilliance 4 "
                     "phong albedo 0.3 phong_size 30 specular albedo 0.3 roughness 0.1 }");
    const Finish& finish = *box_material(scene).finish;
    EXPECT_NEAR(finish.diffuse, 0.4 * 2.50, 1e-3);
    EXPECT_NEAR(finish.phong, 0.3 * 15.498, 1e-3);
    EXPECT_NEAR(finish.specular, 0.3 * 1.5259, 1e-3);
}

TEST(PovFinish, OneReflectionIsMultipliedByFresnelsShare) {
    const auto head_on = [](const std::string& reflection) {
        const Scene scene = textured_box("finish { reflection { " + reflection + " } }");
        const Finish& finish = *box_material(scene).finish;
        EXPECT_EQ(finish.grazing_reflection, vec3(0.5f));
        return finish.reflection;
    };
    EXPECT_EQ(head_on("0.5 fresnel"), vec3(0));
    EXPECT_EQ(head_on("0.2, 0.5 fresnel"), vec3(0.2f));
    EXPECT_EQ(head_on("0.5 falloff 2"), vec3(0.5f));
}

TEST(PovTexture, TilesBeginWithTheSecond) {
    const Scene scene = textured_box("texture { tiles { texture { pigment { rgb x } } "
                                     "tile2 texture { pigment { rgb y } } } }");
    const Texture& mix = scene.textures.at(box_material(scene).mix->texture);
    EXPECT_EQ(mix.pattern.kind, Pattern::Kind::Checker);
    ASSERT_EQ(mix.stops.size(), 2u);
    EXPECT_EQ(scene.materials.at(mix.stops[0].texture).color, vec3(0, 1, 0)) << "as povray draws";
    EXPECT_EQ(scene.materials.at(mix.stops[1].texture).color, vec3(1, 0, 0));
}

/// As povray 3.7.0.10 draws it: what is behind is brighter, and the surface's own light is missing.
TEST(PovTexture, MayLetMoreLightThroughThanThereIs) {
    const Scene scene = textured_box("pigment { rgb 0.5 transmit 3 } finish { ambient 1 }");
    EXPECT_EQ(box_material(scene).transmission, 3);
    EXPECT_EQ(box_material(scene).finish->ambient, vec3(-2));
}

TEST(PovNormal, TiltsNormals) {
    const Scene scene =
        textured_box("pigment { rgb 1 } normal { granite 0.3 accuracy 0.1 scale 2 no_bump_scale "
                     "turbulence 0.2 } scale 3");
    const Material& material = box_material(scene);
    ASSERT_TRUE(material.bump);
    EXPECT_EQ(material.bump->kind, Bump::Kind::Height);
    EXPECT_EQ(material.bump->amount, 0.3);
    EXPECT_EQ(material.bump->accuracy, 0.1);
    EXPECT_TRUE(material.bump->keeps_depth);
    EXPECT_EQ(material.bump->pattern.at({6, 12, -6}), dvec3(1, 2, -1)) << "both scales";
    const Pattern& pattern = scene.textures.at(material.bump->pattern.texture).pattern;
    EXPECT_EQ(pattern.kind, Pattern::Kind::Granite);
    EXPECT_EQ(pattern.turbulence, dvec3(0.2));
    for (const char* const look :
         {"no_bump_scale normal { bumps }", "normal { bumps } no_bump_scale scale 3"})
        EXPECT_TRUE(
            box_material(textured_scene("box { -1, 1 texture { " + std::string(look) + " } }"))
                .bump->keeps_depth)
            << look;
    const Scene named = textured_scene("#declare N = normal { bumps 0.4 }\n"
                                       "box { -1, 1 texture { normal { N bump_size 0.7 } } }");
    EXPECT_EQ(box_material(named).bump->kind, Bump::Kind::Noise);
    EXPECT_EQ(box_material(named).bump->amount, 0.7);
    EXPECT_TRUE(scene.omissions.empty());
}

/// A mix of one normal with itself is this normal, moved as povray moves it.
TEST(PovNormal, WarpsOfAMixMoveItsNormals) {
    const auto normal_at = [](const std::string& look, const dvec3& at) {
        const Scene scene = textured_box("normal { " + look + " }");
        return bumped(scene.textures, scene.bumps, *box_material(scene).bump, at, {0, 0, -1},
                      {0, 0, 1});
    };
    const struct {
        const char *of_mix, *of_one;
    } kMixes[] = {{"turbulence 0.4", "warp { turbulence 0.4 }"},
                  {"scale 0.5 warp { repeat 0.3*y flip y } rotate 20*z",
                   "scale 0.5 warp { repeat 0.3*y flip y } rotate 20*z"}};
    for (const auto& mix : kMixes)
        for (const std::string pattern : {"planar", "average"})
            for (const dvec3& at : kPlaces) {
                const dvec3 mixed = normal_at(
                    pattern + " normal_map { [1 bumps 0.6] [1 bumps 0.6] } " + mix.of_mix, at);
                const dvec3 one = normal_at(std::string("bumps 0.6 ") + mix.of_one, at);
                EXPECT_LT(glm::length(mixed - one), 1e-9) << pattern << " " << mix.of_mix;
            }
}

TEST(PovNormal, LeavesOutTextureCoordinatesWithAWarning) {
    for (const char* look :
         {"normal { uv_mapping bumps 1 }", "normal { bumps 1 uv_mapping }",
          "normal { uv_mapping gradient x 1 scale 2 }", "uv_mapping normal { bumps 1 }",
          "uv_mapping texture { normal { gradient x 1 } }"}) {
        std::vector<std::string> warnings;
        ASSERT_TRUE(
            parse_pov("sphere { 0, 1 " + std::string(look) + " }", "x.pov", gather(warnings)))
            << look;
        ASSERT_EQ(warnings.size(), 1u) << look;
        EXPECT_NE(warnings[0].find("uv_mapping of a normal is left out"), std::string::npos)
            << warnings[0];
    }
}

TEST(PovNormal, HasFacets) {
    const Scene scene = textured_box("normal { facets size 0.3 metric 3 }");
    ASSERT_TRUE(box_material(scene).bump);
    EXPECT_EQ(box_material(scene).bump->kind, Bump::Kind::Facets);
    const Pattern& pattern = scene.textures.at(box_material(scene).bump->pattern.texture).pattern;
    EXPECT_EQ(pattern.parameters[FacetParameter::kSize], 0.3);
    EXPECT_EQ(pattern.parameters[FacetParameter::kMetric], 3);
    EXPECT_TRUE(scene.omissions.empty());
    EXPECT_FALSE(parsed_scene("box { 0, 1 pigment { facets size 1 } }"));
    const Scene noisy = textured_box("normal { facets coords 0.4 size 0.3 }");
    const Pattern& in_space = noisy.textures.at(box_material(noisy).bump->pattern.texture).pattern;
    EXPECT_EQ(in_space.parameters[FacetParameter::kCoords], 0.4);
    EXPECT_EQ(in_space.parameters[FacetParameter::kSize], 0.3);
}

TEST(PovTexture, FinishesHaveFilms) {
    const Scene scene =
        textured_scene("global_settings { irid_wavelength rgb <0.6, 0.5, 0.4> noise_generator 3 }\n"
                       "box { -1, 1 finish { irid { 0.3 thickness 0.5 turbulence 0.7 } } }");
    const Finish& finish = *box_material(scene).finish;
    EXPECT_EQ(finish.irid, 0.3f);
    EXPECT_EQ(finish.irid_thickness, 0.5f);
    EXPECT_EQ(finish.irid_turbulence, 0.7f);
    EXPECT_EQ(finish.irid_wavelengths, vec3(0.6f, 0.5f, 0.4f));
    EXPECT_EQ(finish.irid_noise, NoiseKind::Perlin);
    EXPECT_TRUE(scene.omissions.empty());
}

TEST(PovNormal, HasMapsOfNormals) {
    const Scene scene = textured_box("normal { gradient x normal_map { [0.3 bumps 0.4 scale 2] "
                                     "[0.7 onion 0.2 slope_map { [0 <0, 1>] [1 <1, 0>] }] } "
                                     "scale 3 }");
    const Material& material = box_material(scene);
    ASSERT_TRUE(material.bump);
    EXPECT_EQ(material.bump->kind, Bump::Kind::Mix);
    ASSERT_EQ(material.bump->parts.size(), 2u);
    const Bump& noise = scene.bumps.at(material.bump->parts[0]);
    EXPECT_EQ(noise.kind, Bump::Kind::Noise);
    EXPECT_EQ(noise.amount, 0.4);
    EXPECT_EQ(noise.pattern.at({6, 12, -6}), dvec3(1, 2, -1)) << "both scales";
    const Bump& height = scene.bumps.at(material.bump->parts[1]);
    ASSERT_EQ(height.profile.size(), 2u);
    EXPECT_EQ(height.profile[1].height, 1);
    EXPECT_EQ(height.profile[0].slope, 1);
}

TEST(PovTexture, HasTwoSidesAndAnInside) {
    const Scene scene =
        textured_box("texture { pigment { rgbf 1 } } interior_texture { pigment { rgb x } } "
                     "interior { fade_distance 2 fade_power 1 fade_color rgb y }");
    const Material& outer = box_material(scene);
    ASSERT_NE(outer.inside, kNone);
    EXPECT_EQ(scene.materials.at(outer.inside).color, vec3(1, 0, 0));
    ASSERT_TRUE(outer.absorption);
    EXPECT_EQ(*outer.absorption, (Absorption{2, 1, vec3(0, 1, 0)}));
}

/// povray 3.7.0.10 draws an ambient of rgbf <0.8, 0.4, 0.3, 1> at 0.2 of its color without a
/// version, and not at all with 3.7.
TEST(PovTexture, OldFiltersHideByTheirBrightestComponent) {
    for (const auto& [version, expected] : {std::pair{"3.6", 0.2f}, {"3.7", 0.0f}}) {
        const Scene scene = textured_scene(
            "#version " + std::string(version) +
            "; box { -1, 1 pigment { rgbf <0.8, 0.4, 0.3, 1> } finish { ambient 1 } }");
        EXPECT_NEAR(box_material(scene).finish->ambient.x, expected, 1e-6) << version;
        EXPECT_EQ(scene.background.tints, expected == 0) << version;
    }
}

/// As povray 3.7.0.10 draws them.
TEST(PovSky, ABackgroundThatLetsLightThroughIsDarker) {
    const std::string background = "background { rgbft <0.8, 0.6, 0.4, 0.3, 0.5> } box { 0, 1 }";
    EXPECT_EQ(textured_scene(background).background.zenith, vec3(0.4f, 0.3f, 0.2f));
    EXPECT_EQ(textured_scene("#version 3.6; " + background).background.zenith,
              vec3(0.8f, 0.6f, 0.4f));
}

TEST(PovSky, HasFog) {
    const Scene scene = textured_scene("#declare F = fog { distance 5 rgbt <1, 0, 0, 0.5> }\n"
                                       "fog { F } fog { fog_type 2 fog_alt 2 fog_offset 1 up z "
                                       "distance 3 rgb 1 } box { 0, 1 }");
    ASSERT_EQ(scene.background.fogs.size(), 2u);
    EXPECT_EQ(scene.background.fogs[0].distance, 5);
    EXPECT_EQ(scene.background.fogs[0].color.transmit, 0.5f);
    EXPECT_EQ(scene.background.fogs[1], (Fog{{vec3(1)}, 3, 2, 1, {0, 0, 1}}));
}

TEST(PovSky, FogMayBeTurbulent) {
    const Scene scene = textured_scene("fog { distance 5 rgb 1 turbulence <1, 2, 3> turb_depth 0.2 "
                                       "octaves 3 omega 0.7 lambda 3 } box { 0, 1 }");
    EXPECT_TRUE(scene.omissions.empty());
    const Fog& fog = scene.background.fogs.at(0);
    EXPECT_EQ(fog.turbulence, dvec3(1, 2, 3));
    EXPECT_EQ(fog.turbulence_depth, 0.2);
    EXPECT_EQ(fog.octaves, (Octaves{3, 0.7, 3}));
}

TEST(PovPattern, HasAsManyWaveSourcesAsTheSceneSays) {
    const std::string box = "box { 0, 1 pigment { ripples } }";
    const auto sources = [](const Scene& scene) {
        return scene.textures.at(0).pattern.parameters[0];
    };
    EXPECT_EQ(sources(textured_scene("global_settings { number_of_waves 3 } " + box)), 3);
    EXPECT_EQ(sources(textured_scene(box)), 10);
}

TEST(PovSky, HasRainbows) {
    const Scene scene = textured_scene(
        "#declare R = rainbow { direction <0, 0, 2> angle 42 width 5 distance 9 jitter 0.1 "
        "arc_angle 120 falloff_angle 30 up x color_map { [0.6 rgbt <1, 0, 0, 0.5>] [0.2 rgb 1] } "
        "}\n"
        "rainbow { R } rainbow { angle 3 width 2 } box { 0, 1 }");
    EXPECT_TRUE(scene.omissions.empty());
    ASSERT_EQ(scene.background.rainbows.size(), 1u) << "without colors there is none";
    const Rainbow& bow = scene.background.rainbows[0];
    EXPECT_EQ(bow.direction, dvec3(0, 0, 1));
    ASSERT_EQ(bow.colors.size(), 2u);
    EXPECT_EQ(bow.colors[0].at, double(0.2f));
    EXPECT_EQ(bow.colors[1].color.transmit, 0.5f);
    EXPECT_EQ(bow.arc, 120);
    EXPECT_EQ(bow.full_arc, 30);
    EXPECT_EQ(bow.up, dvec3(1, 0, 0));
}

TEST(PovSky, HasPatterns) {
    const Scene scene = textured_scene("sky_sphere { pigment { gradient y } "
                                       "pigment { rgbt <1, 0, 0, 0.5> } scale 2 }");
    ASSERT_EQ(scene.background.layers.size(), 2u);
    const PlacedTexture& lower = scene.background.layers[0];
    EXPECT_NEAR(color_at(scene.textures, lower.texture, lower.at({0, 1, 0})).rgb.x, 0.5, 1e-6);
    EXPECT_EQ(scene.textures[scene.background.layers[1].texture].stops[0].color.transmit, 0.5f);
}

TEST(PovPattern, HasOnlySoManyParts) {
    for (const char* mix : {"texture { average texture_map { [1 T][1 T] } }",
                            "texture { checker texture { T } texture { T } }",
                            "texture { tiles { texture { T } tile2 texture { T } } }",
                            "texture { T normal { average normal_map { [1 N][1 N] } } }"}) {
        const auto scene =
            parsed_scene("#declare N = normal { bumps } #declare T = texture { pigment { rgb 1 } } "
                         "#for (I, 0, 40) #declare T = " +
                         std::string(mix) +
                         " #declare N = normal { average normal_map { [1 N][1 N] } } #end "
                         "sphere { 0, 1 texture { T } }");
        ASSERT_FALSE(scene) << mix;
        EXPECT_NE(scene.error().message.find("found a mix of more than 100000 patterns"),
                  std::string::npos)
            << scene.error().message;
    }
}

TEST(PovPattern, LiesOnlySoDeep) {
    const std::string names = "#declare T = texture { pigment { rgbt 0.9 } } "
                              "#declare P = pigment { rgb 1 } #declare N = normal { bumps } ";
    for (const char* step :
         {"#declare P = pigment { gradient x pigment_map { [0 P][1 rgb 0] } }",
          "#declare N = normal { gradient x normal_map { [0 N][1 bumps 0] } }",
          "#declare T = texture { gradient x texture_map { [0 T][1 pigment { rgb 0 }] } }",
          "#declare T = texture { T } texture { pigment { rgbt 0.9 } }",
          "#declare T = texture { pigment { rgbt 0.9 } } texture { T }",
          "#declare T = texture { T } texture { T }"}) {
        const auto scene =
            parsed_scene(names + "#for (I, 1, 20000) " + step +
                         " #end sphere { 0, 1 texture { T } pigment { P } normal { N } }");
        ASSERT_FALSE(scene) << step;
        EXPECT_NE(
            scene.error().message.find("found patterns or layers more than 400 deep in each other"),
            std::string::npos)
            << scene.error().message;
    }
}

/// Each names the one before twice, and is made only once.
TEST(PovPattern, IsRefusedWhereFunctionsTakeTooManySteps) {
    const TestFolder folder;
    const auto scene = load(folder.write(
        "a.pov", "#declare P = pigment { gradient x } #for (I, 1, 40) #declare P = pigment { "
                 "pigment_pattern { P } pigment_map { [0 P][1 rgb 1] } } #end "
                 "sphere { 0, 1 pigment { P } }"));
    ASSERT_FALSE(scene);
    EXPECT_EQ(folder.plain(scene.error().message),
              "a.pov: the textures cannot be evaluated: they have no meaning, lie more than 500 "
              "deep in each other, or take more than 1000000 steps for one color");
}

TEST(PovPattern, MixesTexturesOnly) {
    const Result<Scene> scene =
        parsed_scene("box { 0, 1 texture { gradient x color_map { [0 rgb 0] [1 rgb 1] } } }");
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("expected textures"), std::string::npos);
}

TEST(PovPattern, HasTilings) {
    const Scene scene = textured_scene("plane { y, 0 pigment { tiling 7 scale 2 } }");
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].pattern.kind, Pattern::Kind::Tiling);
    EXPECT_EQ(scene.textures[0].pattern.parameters[0], 7);
    const Result<Scene> other = parsed_scene("plane { y, 0 pigment { tiling 28 } }");
    ASSERT_FALSE(other);
    EXPECT_NE(other.error().message.find("the number of a tiling"), std::string::npos)
        << other.error().message;
}

} // namespace ovc
