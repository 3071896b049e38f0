// SPDX-License-Identifier: Apache-2.0
// Textures of PBRT files: pictures and patterns on their mappings, and what materials do with them.
#include "core/texture/noise/perlin.h"
#include "core/texture/pattern.h"
#include "importers/test_files.h"

#include <cmath>
#include <numbers>

namespace ovc {
namespace {

constexpr const char* kTexturedTriangle =
    " Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0  1 0 0  0 1 0] "
    "\"point2 uv\" [0 0  1 0  0 1] ";

/// Shows s, t and 0.5.
class ShowsPbrtPlace final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        return {float(area.st.x), float(area.st.y), 0.5f, 1};
    }
    dvec2 size() const override { return dvec2(8); }
    bool has_opacity() const override { return false; }
};

struct TexturedScene {
    Scene scene;
    std::vector<std::string> warnings;

    const Material& material() const { return scene.materials[scene.meshes.at(0).material]; }
    const ImageTexture& image(uint32_t texture) const { return *scene.textures[texture].image; }
    /// Returns the color of the material's texture at a point of the world and texture coordinates.
    vec3 color_of(const dvec3& at, const dvec2& uv) const {
        TexturePoint point{at};
        point.has_uv = true;
        point.uv = uv;
        const PlacedTexture& placed = material().texture.value();
        return color_at(scene.textures, placed.texture, placed.at(point)).rgb;
    }
};

TexturedScene read_textured(const std::string& text) {
    static const ShowsPbrtPlace lookup;
    const TestFolder folder;
    TexturedScene read;
    Result<Scene> scene =
        load(folder.write("a.pbrt", "WorldBegin\n" + text), gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    for (std::string& warning : read.warnings)
        warning = folder.plain(warning);
    for (PictureFile& picture : read.scene.pictures) {
        picture.file = folder.plain(picture.file);
        picture.asked_for_at = folder.plain(picture.asked_for_at);
    }
    for (Texture& texture : read.scene.textures)
        if (texture.image)
            texture.image->lookup = &lookup;
    return read;
}

TexturedScene read_picture(const std::string& parameters) {
    return read_textured("Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\" " +
                         parameters + " Material \"matte\" \"texture Kd\" \"t\"" +
                         kTexturedTriangle);
}

void expect_near(const vec3& found, const vec3& expected) {
    EXPECT_LT(glm::length(found - expected), 1e-5f) << found.x << " " << found.y << " " << found.z
                                                    << " for " << expected.x << " " << expected.y;
}

TEST(PbrtTexture, PicturesLieOnTextureCoordinates) {
    const TexturedScene read = read_picture("\"float uscale\" 2 \"float vscale\" 3 "
                                            "\"float udelta\" 0.25 \"float vdelta\" 0.5");
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.scene.pictures.size(), 1u);
    EXPECT_EQ(read.scene.pictures[0].file, "a.png");
    EXPECT_EQ(read.scene.pictures[0].asked_for_at, "a.pbrt:2");
    EXPECT_EQ(read.scene.meshes[0].uv, (std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(read.scene.meshes[0].texture_coordinates_left_out, 0u);
    expect_near(read.color_of(dvec3(9), {0.125, 0.25}), vec3(0.5f, 1.25f, 0.5f));
}

TEST(PbrtTexture, MappingsAreThoseOfTheirFormulas) {
    const dvec3 at(0.3, -0.4, 0.7);
    const double pi = std::numbers::pi;
    const TexturedScene planar =
        read_picture("\"string mapping\" \"planar\" \"vector3 v1\" [1 2 0] \"vector3 v2\" [0 0 3] "
                     "\"float udelta\" 0.5 \"float vdelta\" -1");
    expect_near(planar.color_of(at, dvec2(0)), vec3(0.3f - 0.8f + 0.5f, 2.1f - 1, 0.5f));
    const double theta = std::acos(at.z / glm::length(at));
    const double phi = std::atan2(at.y, at.x) + 2 * pi;
    const TexturedScene spherical = read_picture("\"string mapping\" \"spherical\"");
    expect_near(spherical.color_of(at, dvec2(0)),
                vec3(float(theta / pi), float(phi / (2 * pi)), 0.5f));
    const TexturedScene cylindrical = read_picture("\"string mapping\" \"cylindrical\"");
    expect_near(cylindrical.color_of(at, dvec2(0)),
                vec3(float((pi + std::atan2(at.y, at.x)) / (2 * pi)), 0.7f, 0.5f));
}

TEST(PbrtTexture, MappingsInSpaceAreThoseOfTheTexture) {
    const TexturedScene read = read_textured(
        "AttributeBegin Translate 1 2 3 Scale 2 2 2 Texture \"t\" \"color\" \"imagemap\" "
        "\"string filename\" \"a.png\" \"string mapping\" \"planar\" AttributeEnd "
        "Material \"matte\" \"texture Kd\" \"t\"" +
        std::string(kTexturedTriangle));
    expect_near(read.color_of({2, 2.5, 0}, dvec2(0)), vec3(0.5f, 0.25f, 0.5f));
    EXPECT_TRUE(read.scene.meshes[0].uv.empty()) << "nothing lies on texture coordinates";
}

TEST(PbrtTexture, ParametersOfPictures) {
    const auto image = [](const std::string& parameters) {
        return *read_picture(parameters).scene.textures[0].image;
    };
    EXPECT_EQ(image("").gamma, 0);
    EXPECT_EQ(image("").filter, TexelFilter::Mipmaps);
    EXPECT_EQ(image("\"bool gamma\" false").gamma, 1);
    EXPECT_EQ(image("\"string encoding\" \"linear\"").gamma, 1);
    EXPECT_EQ(image("\"string encoding\" \"gamma 2.5\"").gamma, 2.5);
    EXPECT_EQ(image("\"float gamma\" 1.8").gamma, 1.8);
    EXPECT_EQ(image("\"string wrap\" \"black\"").beyond_s, Beyond::Nothing);
    EXPECT_EQ(image("\"string wrap\" \"clamp\"").beyond_t, Beyond::Clamp);
    EXPECT_EQ(image("\"string filter\" \"point\"").filter, TexelFilter::Nearest);
    EXPECT_EQ(image("\"string filter\" \"bilinear\"").filter, TexelFilter::Smooth);
    const ImageTexture inverted = image("\"bool invert\" true \"float scale\" 0.5");
    EXPECT_EQ(inverted.scale, vec3(-0.5f));
    EXPECT_EQ(inverted.offset, vec3(1));
}

TEST(PbrtTexture, ProductsMixesAndBoardsAreMadeOfParts) {
    const std::string picture =
        "Texture \"p\" \"color\" \"imagemap\" \"string filename\" \"a.png\" ";
    const auto made = [&](const std::string& texture) {
        return read_textured(picture + "Texture \"t\" \"color\" " + texture +
                             " Material \"diffuse\" \"texture reflectance\" \"t\"" +
                             kTexturedTriangle);
    };
    const dvec2 uv(0.25, 0.75);
    const vec3 shown(0.25f, 0.75f, 0.5f);
    expect_near(
        made("\"scale\" \"texture tex1\" \"p\" \"rgb tex2\" [1 0.5 0]").color_of(dvec3(0), uv),
        shown * vec3(1, 0.5f, 0));
    expect_near(made("\"scale\" \"texture tex\" \"p\" \"float scale\" 0.5").color_of(dvec3(0), uv),
                0.5f * shown);
    expect_near(made("\"mix\" \"rgb tex1\" [1 1 1] \"texture tex2\" \"p\" \"float amount\" 0.25")
                    .color_of(dvec3(0), uv),
                0.75f + 0.25f * shown);
    const TexturedScene board = made("\"checkerboard\" \"texture tex1\" \"p\" \"rgb tex2\" [1 0 0] "
                                     "\"float uscale\" 4 \"float vscale\" 4");
    expect_near(board.color_of(dvec3(0), {0.3, 0.9}), vec3(0.3f, 0.9f, 0.5f));
    expect_near(board.color_of(dvec3(0), {0.3, 0.6}), vec3(1, 0, 0));
    const TexturedScene solid =
        made("\"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [1 1 1] \"rgb tex2\" [0 0 0]");
    expect_near(solid.color_of({0.5, 1.5, 1.5}, uv), vec3(1));
    expect_near(solid.color_of({0.5, 1.5, 2.5}, uv), vec3(0));
}

TEST(PbrtTexture, NoiseLiesInTheSpaceOfItsTexture) {
    const auto made = [](const std::string& texture) {
        return read_textured("AttributeBegin Scale 2 2 2 Texture \"t\" \"color\" " + texture +
                             " AttributeEnd Material \"matte\" \"texture Kd\" \"t\"" +
                             kTexturedTriangle);
    };
    const dvec3 at(0.3, 1.4, -2.2);
    const TexturedScene wrinkled =
        made("\"wrinkled\" \"integer octaves\" 3 \"float roughness\" 0.25");
    EXPECT_TRUE(wrinkled.warnings.empty());
    expect_near(wrinkled.color_of(2.0 * at, dvec2(0)), vec3(float(turbulence_sum(at, {3, 0.25}))));
    EXPECT_TRUE(wrinkled.scene.meshes[0].uv.empty());
    const dvec3 high(0.4, 0.6, 0.3);
    expect_near(made("\"fbm\" \"integer octaves\" 2").color_of(2.0 * high, dvec2(0)),
                vec3(float(std::clamp(noise_sum(high, {2, 0.5}), 0.0, 1.0))));
    // Where the wave of marble is lowest and highest, its color is that of either end.
    const TexturedScene marble = made("\"marble\" \"float variation\" 0 \"float scale\" 3");
    for (const double height : {-0.5, 0.5})
        expect_near(marble.color_of({0, height * std::numbers::pi / 3 * 2, 0}, dvec2(0)),
                    1.5f * vec3(0.58f, 0.58f, 0.6f));
}

TEST(PbrtTexture, DotsAndCornersLieOnTextureCoordinates) {
    const auto made = [](const std::string& texture) {
        return read_textured("Texture \"t\" \"color\" " + texture +
                             " Material \"matte\" \"texture Kd\" \"t\"" + kTexturedTriangle);
    };
    const TexturedScene corners = made("\"bilerp\" \"rgb v00\" [1 0 0] \"rgb v01\" [0 1 0] "
                                       "\"rgb v10\" [0 0 1] \"rgb v11\" [1 1 1]");
    EXPECT_TRUE(corners.warnings.empty());
    expect_near(corners.color_of(dvec3(0), {0.25, 0.5}), vec3(0.5f, 0.5f, 0.25f));
    expect_near(corners.color_of(dvec3(0), {1, 0}), vec3(0, 0, 1));
    // pbrt's pictures have "inside" around the dots.
    const TexturedScene dots = made("\"dots\" \"rgb outside\" [1 0 0] \"float uscale\" 40 "
                                    "\"float vscale\" 40");
    int inside = 0;
    for (int i = 0; i < 10000; ++i)
        inside += dots.color_of(dvec3(0), {(i % 100) / 100.0, (i / 100) / 100.0}) == vec3(1, 0, 0);
    // Less than half of the squares have a dot, of pi 0.35^2 of their area.
    EXPECT_GT(inside, 10000 * 0.35 * std::numbers::pi * 0.35 * 0.35);
    EXPECT_LT(inside, 10000 * 0.5 * std::numbers::pi * 0.35 * 0.35);
}

TEST(PbrtTexture, APatternThatIsNotKnownIsItsMeanAndSaid) {
    const TexturedScene read = read_textured(
        "Texture \"n\" \"color\" \"ptex\"\nTexture \"t\" \"color\" \"scale\" \"texture tex1\" "
        "\"n\" Material \"matte\" \"texture Kd\" \"t\"" +
        std::string(kTexturedTriangle));
    EXPECT_FALSE(read.material().texture);
    EXPECT_EQ(read.warnings,
              (std::vector<std::string>{"a.pbrt:2: textures 'ptex' are shown by their mean"}));
}

TEST(PbrtTexture, WhatIsShownByItsMeanIsSaidWhereverItStands) {
    const std::string picture =
        "Texture \"c\" \"color\" \"imagemap\" \"string filename\" \"a.png\"\n"
        "Texture \"s\" \"color\" \"scale\" \"texture tex1\" \"c\" \"color tex2\" [2 2 2]\n";
    const auto warnings = [&](const std::string& material) {
        return read_textured(picture + material + kTexturedTriangle).warnings;
    };
    const std::vector<std::string> told = {"a.pbrt:2: textures 'imagemap' are shown by their mean"};
    EXPECT_EQ(warnings("Material \"glass\" \"texture Kt\" \"c\""), told);
    EXPECT_EQ(warnings("Material \"glass\" \"texture Kr\" \"c\""), told);
    EXPECT_EQ(warnings("Material \"metal\" \"texture k\" \"c\""), told);
    EXPECT_EQ(warnings("MakeNamedMaterial \"m\" \"string type\" \"uber\" \"texture Kd\" \"c\" "
                       "\"texture Kt\" \"c\""),
              told);
    EXPECT_EQ(warnings("Material \"glass\" \"texture Kt\" \"s\""),
              (std::vector<std::string>{"a.pbrt:3: textures 'scale' are shown by their mean"}));
    EXPECT_EQ(warnings("Material \"matte\" \"texture Kd\" \"s\""), std::vector<std::string>());
    EXPECT_EQ(warnings("Material \"matte\" \"texture Kd\" \"c\" AreaLightSource \"diffuse\""),
              (std::vector<std::string>{
                  "a.pbrt:4: textures of surfaces that emit light are shown by their mean"}));
}

TEST(PbrtTexture, TooManyInEachOtherAreAnError) {
    const std::string color = "Texture \"t0\" \"color\" \"checkerboard\" MakeNamedMaterial \"m0\" "
                              "\"string type\" \"matte\" \"texture Kd\" \"t0\"\n";
    const auto failure = [&](const std::string& before, const std::string& middle) {
        std::string text = color;
        for (int i = 1; i <= 1001; ++i)
            text += before + std::to_string(i) + middle + std::to_string(i - 1) + "\"]\n";
        const TestFolder folder;
        folder.write("a.pbrt", text);
        return folder.failure("a.pbrt");
    };
    EXPECT_EQ(failure("Texture \"t", "\" \"color\" \"scale\" \"texture tex1\" [\"t"),
              "a.pbrt:1001: found a texture of more than 1000 others");
    EXPECT_EQ(failure("Texture \"t",
                      "\" \"color\" \"mix\" \"texture tex2\" \"t0\" \"texture tex1\" [\"t"),
              "a.pbrt:501: found a texture of more than 1000 others");
    EXPECT_EQ(failure("MakeNamedMaterial \"m",
                      "\" \"string type\" \"mix\" \"string materials\" [\"m0\" \"m"),
              "a.pbrt:1002: found a mix of more than 1000 others");
}

TEST(PbrtTexture, WordsThatPbrtRefusesAreSaid) {
    const auto warnings = [](const std::string& words) {
        return read_textured("Texture \"c\" \"color\" \"imagemap\" \"string filename\" \"a.png\" " +
                             words + " Material \"matte\" \"texture Kd\" \"c\"" + kTexturedTriangle)
            .warnings;
    };
    EXPECT_EQ(warnings("\"string wrap\" \"mirror\""),
              (std::vector<std::string>{
                  "a.pbrt:2: the wrap 'mirror' of a texture left out: it is unknown"}));
    EXPECT_EQ(
        warnings("\"string wrap\" \"octahedralsphere\""),
        (std::vector<std::string>{"a.pbrt:2: textures that wrap around a sphere are repeated"}));
    EXPECT_EQ(warnings("\"string filter\" \"cubic\" \"string encoding\" \"rec709\"").size(), 2u);
    EXPECT_TRUE(warnings("\"string filter\" \"EWA\" \"string encoding\" \"gamma 2.2\"").empty());
}

/// Half of the picture and half of red, then as much red as the picture's mean says.
TEST(PbrtTexture, MaterialsAreMixedTexelByTexel) {
    const std::string materials =
        "Texture \"c\" \"color\" \"imagemap\" \"string filename\" \"a.png\" "
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"texture Kd\" \"c\" "
        "MakeNamedMaterial \"b\" \"string type\" \"matte\" \"rgb Kd\" [1 0 0] Material \"mix\" ";
    const TexturedScene half =
        read_textured(materials + "\"string materials\" [\"a\" \"b\"]" + kTexturedTriangle);
    EXPECT_TRUE(half.warnings.empty());
    expect_near(half.color_of(dvec3(0), {0.25, 0.75}),
                0.5f * (vec3(0.25f, 0.75f, 0.5f) + vec3(1, 0, 0)));
    const TexturedScene masked =
        read_textured(materials + "\"string materials\" [\"a\" \"b\"] \"texture amount\" \"c\"" +
                      kTexturedTriangle);
    EXPECT_TRUE(masked.warnings.empty());
    expect_near(masked.color_of(dvec3(0), {0, 0.25}),
                0.75f * vec3(0, 0.25f, 0.5f) + 0.25f * vec3(1, 0, 0));
    const TexturedScene v3 =
        read_textured(materials +
                      "\"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" "
                      "\"texture amount\" \"c\"" +
                      kTexturedTriangle);
    expect_near(v3.color_of(dvec3(0), {0, 0.25}),
                0.25f * vec3(0, 0.25f, 0.5f) + 0.75f * vec3(1, 0, 0));
}

TEST(PbrtTexture, MaterialsTakeColorsReflectionsHolesAndBumps) {
    const std::string pictures =
        "Texture \"c\" \"color\" \"imagemap\" \"string filename\" \"a.png\" "
        "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"b.png\" ";
    const TexturedScene plastic =
        read_textured(pictures +
                      "Material \"plastic\" \"texture Kd\" \"c\" \"texture Ks\" \"c\" "
                      "\"texture bumpmap\" \"f\"" +
                      kTexturedTriangle);
    EXPECT_TRUE(plastic.warnings.empty());
    EXPECT_TRUE(plastic.material().texture);
    ASSERT_TRUE(plastic.material().maps);
    EXPECT_EQ(plastic.material().optics->reflection, vec3(1));
    ASSERT_TRUE(plastic.material().normal_map);
    EXPECT_EQ(plastic.material().normal_map->kind, NormalMap::Kind::Height);
    EXPECT_EQ(plastic.scene.pictures.size(), 2u);
    const TexturedScene solid = read_textured(
        "Texture \"w\" \"float\" \"windy\" Texture \"s\" \"float\" \"scale\" \"texture tex1\" "
        "\"w\" \"float tex2\" 0.1 Material \"matte\" \"texture bumpmap\" \"s\"" +
        std::string(kTexturedTriangle));
    EXPECT_TRUE(solid.warnings.empty());
    ASSERT_TRUE(solid.material().normal_map);
    EXPECT_EQ(solid.material().normal_map->kind, NormalMap::Kind::Space);
    EXPECT_TRUE(solid.scene.meshes[0].uv.empty());
    const TexturedScene uber =
        read_textured(pictures + "Material \"uber\" \"rgb Kd\" [1 0 0] \"texture opacity\" \"f\"" +
                      kTexturedTriangle);
    ASSERT_NE(uber.scene.meshes[0].cutout, kNone);
    const Cutout& cutout = uber.scene.cutouts[uber.scene.meshes[0].cutout];
    EXPECT_TRUE(cutout.partial);
    EXPECT_TRUE(uber.scene.textures[cutout.texture].image);
    const auto mix_with = [&](const std::string& other) {
        return read_textured(pictures +
                             "MakeNamedMaterial \"a\" \"string type\" \"uber\" \"texture opacity\" "
                             "\"f\" MakeNamedMaterial \"b\" \"string type\" " +
                             other +
                             " Material \"mix\" \"string materials\" [\"a\" \"b\"] "
                             "\"float amount\" 0.25" +
                             kTexturedTriangle);
    };
    const TexturedScene same = mix_with("\"uber\" \"rgb Kd\" [1 0 0] \"texture opacity\" \"f\"");
    ASSERT_NE(same.scene.meshes[0].cutout, kNone);
    EXPECT_TRUE(same.scene.textures[same.scene.cutouts[0].texture].image);
    const TexturedScene one = mix_with("\"matte\"");
    ASSERT_NE(one.scene.meshes[0].cutout, kNone);
    const Texture& holes = one.scene.textures[one.scene.cutouts[0].texture];
    EXPECT_EQ(holes.kind, TextureKind::Mix);
    EXPECT_EQ(holes.stops[1].color.rgb, vec3(1));
    EXPECT_EQ(holes.stops[2].color.rgb, vec3(0.25f));
    const TexturedScene normals = read_textured(
        "Material \"diffuse\" \"string normalmap\" \"n.png\"" + std::string(kTexturedTriangle));
    ASSERT_TRUE(normals.material().normal_map);
    EXPECT_EQ(normals.material().normal_map->kind, NormalMap::Kind::Tangent);
    EXPECT_EQ(normals.image(normals.material().normal_map->texture).gamma, 1);
    EXPECT_EQ(normals.scene.meshes[0].uv.size(), 3u);
}

TEST(PbrtTexture, ANameThatIsDefinedAnewMeansTheNewTexture) {
    const TexturedScene read =
        read_textured("Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"a.png\" "
                      "Texture \"s\" \"color\" \"scale\" \"texture tex1\" \"t\" "
                      "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"b.png\" "
                      "Material \"matte\" \"texture Kd\" \"s\"" +
                      std::string(kTexturedTriangle));
    ASSERT_EQ(read.scene.pictures.size(), 1u);
    EXPECT_EQ(read.scene.pictures[0].file, "a.png");
}

/// As in v1 to v3. A name that is new within the scope stays, as in v4.
TEST(PbrtTexture, ANameThatIsDefinedWithinAScopeEndsWithIt) {
    const char* const inner =
        "AttributeBegin Texture \"t\" \"color\" \"constant\" \"rgb value\" [0 1 0] "
        "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [0 0 1] "
        "MakeNamedMaterial \"n\" \"string type\" \"matte\" \"rgb Kd\" [0 1 1] AttributeEnd ";
    const std::string outer =
        "Texture \"t\" \"color\" \"constant\" \"rgb value\" [1 0 0] "
        "MakeNamedMaterial \"m\" \"string type\" \"matte\" \"rgb Kd\" [1 1 0] ";
    const auto color = [&](const std::string& material) {
        return read_textured(outer + inner + material + kTexturedTriangle).material().color;
    };
    expect_near(color("Material \"matte\" \"texture Kd\" \"t\""), vec3(1, 0, 0));
    expect_near(color("NamedMaterial \"m\""), vec3(1, 1, 0));
    expect_near(color("NamedMaterial \"n\""), vec3(0, 1, 1));
}

TEST(PbrtTexture, ColorsAndFloatsMayHaveTheSameName) {
    const TexturedScene read =
        read_textured("Texture \"t\" \"color\" \"constant\" \"rgb value\" [1 0 0] "
                      "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" "
                      "Material \"matte\" \"texture Kd\" \"t\" \"texture bumpmap\" \"t\"" +
                      std::string(kTexturedTriangle));
    expect_near(read.material().color, vec3(1, 0, 0));
    EXPECT_FALSE(read.material().texture);
    EXPECT_TRUE(read.material().normal_map);
}

TEST(PbrtTexture, AnEnvironmentMapIsALayerOfTheSky) {
    const TexturedScene read = read_textured(
        "AttributeBegin Rotate 90 0 0 1 LightSource \"infinite\" \"string mapname\" \"sky.exr\" "
        "\"rgb scale\" [2 2 4] AttributeEnd" +
        std::string(kTexturedTriangle));
    ASSERT_EQ(read.scene.background.layers.size(), 1u);
    const PlacedTexture& layer = read.scene.background.layers[0];
    const auto seen = [&](const dvec3& direction) {
        return color_at(read.scene.textures, layer.texture, layer.at(direction)).rgb;
    };
    const float exposure = read.scene.exposure;
    // The map's s = 0 lies at its +x, which is turned to +y of the world; t = 1 is at +z.
    expect_near(seen({-1, 0, 0}), exposure * vec3(2 * 0.25f, 2 * 0.5f, 4 * 0.5f));
    expect_near(seen({0, -1, 0}), exposure * vec3(2 * 0.5f, 2 * 0.5f, 4 * 0.5f));
    EXPECT_NEAR(seen({0, 0, 1}).y, exposure * 2, 1e-5);
    const TexturedScene v4 =
        read_textured("LightSource \"infinite\" \"string filename\" \"sky.exr\"" +
                      std::string(kTexturedTriangle));
    const PlacedTexture& map = v4.scene.background.layers.at(0);
    // The middle of an octahedral map is +z, and its first row, at v = 0, is towards -y.
    const vec3 down = color_at(v4.scene.textures, map.texture, map.at(dvec3(0, -1, 0))).rgb;
    EXPECT_NEAR(down.y, v4.scene.exposure * 1, 1e-5);
}

TEST(PbrtTexture, AGoniometricLightThrowsItsPictureAllWays) {
    const TexturedScene read = read_textured(
        "AttributeBegin Translate 1 2 3 Rotate 90 0 1 0 Scale 2 2 2 LightSource \"goniometric\" "
        "\"string mapname\" \"g.png\" \"rgb I\" [2 2 4] AttributeEnd" +
        std::string(kTexturedTriangle));
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.scene.pictures.size(), 1u);
    EXPECT_EQ(read.scene.pictures[0].file, "g.png");
    const Light& light = read.scene.lights.at(0);
    EXPECT_EQ(light.position, dvec3(1, 2, 3));
    ASSERT_TRUE(light.thrown);
    EXPECT_FALSE(light.thrown->has_window);
    const PlacedTexture& placed = light.thrown->texture;
    const auto seen = [&](const dvec3& way) {
        const dvec3 at = glm::normalize(placed.at(way));
        return color_at(read.scene.textures, placed.texture, at).rgb;
    };
    // The picture's axis is y, and its s = 0 at the light's x, which is turned to -z of the world.
    EXPECT_NEAR(seen({0, 1, 0}).y, 1, 1e-6);
    EXPECT_NEAR(seen({0, -1, 0}).y, 0, 1e-6);
    expect_near(seen({0, 0, 1}), {0.5f, 0.5f, 0.5f});
    expect_near(seen({1, 0, 0}), {0.25f, 0.5f, 0.5f});
}

TEST(PbrtTexture, AGoniometricPictureOfV4HasBrightnessAlone) {
    const TexturedScene read =
        read_textured("LightSource \"goniometric\" \"string filename\" \"g.png\"" +
                      std::string(kTexturedTriangle));
    const PlacedTexture& placed = read.scene.lights.at(0).thrown->texture;
    const vec3 seen =
        color_at(read.scene.textures, placed.texture, glm::normalize(placed.at({0.3, 0.5, 0.7})))
            .rgb;
    EXPECT_EQ(seen, vec3(seen.x));
    EXPECT_GT(seen.x, 0);
}

TEST(PbrtTexture, AProjectionLightThrowsItsPictureThroughAWindow) {
    const TexturedScene read =
        read_textured("LightSource \"projection\" \"string mapname\" \"p.png\" \"float fov\" 90" +
                      std::string(kTexturedTriangle));
    EXPECT_TRUE(read.warnings.empty());
    const Light& light = read.scene.lights.at(0);
    EXPECT_FALSE(light.cone);
    ASSERT_TRUE(light.thrown);
    EXPECT_TRUE(light.thrown->has_window);
    const dvec3 rim = light.thrown->texture.at(dvec3(3, -3, 3));
    EXPECT_NEAR(rim.x / rim.z, 1, 1e-12);
    EXPECT_NEAR(rim.y / rim.z, -1, 1e-12);
    // The first row lies below.
    const auto seen = color_at(read.scene.textures, light.thrown->texture.texture,
                               TexturePoint(dvec3(0.25, 0.125, 0)));
    expect_near(seen.rgb, {0.25f, 0.875f, 0.5f});
    const TexturedScene v4 =
        read_textured("LightSource \"projection\" \"string filename\" \"p.png\"" +
                      std::string(kTexturedTriangle));
    const dvec3 side = v4.scene.lights.at(0).thrown->texture.at(dvec3(3, -3, 3));
    EXPECT_NEAR(side.x / side.z, 1, 1e-12) << "90 degrees where the file says nothing";
    const auto upright = color_at(v4.scene.textures, v4.scene.lights[0].thrown->texture.texture,
                                  TexturePoint(dvec3(0.25, 0.125, 0)));
    expect_near(upright.rgb, {0.25f, 0.125f, 0.5f});
    const TexturedScene bare =
        read_textured("LightSource \"projection\"" + std::string(kTexturedTriangle));
    ASSERT_EQ(bare.warnings.size(), 1u);
    EXPECT_NE(bare.warnings[0].find("without a picture"), std::string::npos);
    EXPECT_FALSE(bare.scene.lights.at(0).thrown);
}

/// v4's "power" and "illuminance" count per light of the picture.
TEST(PbrtTexture, LightsWithPicturesHaveTheLightThatTheirFilesSay) {
    using Measure = ImageTexture::Measure;
    const double pi = std::numbers::pi;
    const auto lit = [](const std::string& light) {
        TexturedScene read = read_textured(light + kTexturedTriangle);
        EXPECT_TRUE(read.warnings.empty()) << read.warnings[0];
        return read;
    };
    const auto strength = [](const TexturedScene& read) { // from the distance 1
        const Light& light = read.scene.lights.at(0);
        return double(light.color.x / read.scene.exposure) * 2 * light.fade_distance *
               light.fade_distance;
    };
    const TexturedScene gonio =
        lit("LightSource \"goniometric\" \"string filename\" \"g.png\" \"float power\" 5");
    EXPECT_EQ(gonio.image(gonio.scene.lights[0].thrown->texture.texture).per, Measure::Mean);
    EXPECT_NEAR(strength(gonio), 5 / (4 * pi), 1e-4);
    const TexturedScene slide =
        lit("LightSource \"projection\" \"string filename\" \"g.png\" \"float power\" 5 "
            "\"float fov\" 60");
    const ImageTexture& thrown = slide.image(slide.scene.lights[0].thrown->texture.texture);
    EXPECT_EQ(thrown.per, Measure::ThroughWindow);
    EXPECT_NEAR(thrown.window_distance, std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(strength(slide), 5, 1e-3);
    const TexturedScene sky = lit("LightSource \"infinite\" \"string filename\" \"g.png\" "
                                  "\"float illuminance\" 3 \"float scale\" 2");
    const ImageTexture& map = sky.image(sky.scene.background.layers.at(0).texture);
    EXPECT_EQ(map.per, Measure::FromAbove);
    EXPECT_NEAR(map.scale.x / sky.scene.exposure, 2 * 3 * 2, 1e-4) << "pbrt's half texels";
    const TexturedScene screen = lit("AreaLightSource \"diffuse\" \"string filename\" "
                                     "\"g.png\" \"float power\" 3");
    ASSERT_TRUE(screen.material().maps);
    EXPECT_EQ(screen.image(screen.material().maps->emission).per, Measure::Mean);
    EXPECT_TRUE(screen.scene.textures[screen.material().maps->emission].on_uv);
    EXPECT_EQ(screen.scene.meshes[0].uv.size(), 3u);
    EXPECT_NEAR(screen.material().optics->emission.x / screen.scene.exposure, 3 / (pi * 0.5), 1e-4);
}

/// Of two skies neither hides the other.
TEST(PbrtTexture, SkiesAddUp) {
    const TexturedScene read =
        read_textured("LightSource \"infinite\" \"string filename\" \"sky.exr\" "
                      "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.3]" +
                      std::string(kTexturedTriangle));
    EXPECT_TRUE(read.scene.background.layers_add);
    expect_near(read.scene.background.zenith / read.scene.exposure, {0.1f, 0.2f, 0.3f});
    const TexturedScene one = read_textured("LightSource \"infinite\" \"string filename\" "
                                            "\"sky.exr\"" +
                                            std::string(kTexturedTriangle));
    EXPECT_FALSE(one.scene.background.layers_add);
}

TEST(PbrtTexture, AMetalHasTheColorOfItsTexture) {
    const TexturedScene metal = read_textured(
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [0.8 0.2 0.1] \"rgb tex2\" "
        "[0.2 0.4 0.7] Material \"conductor\" \"texture reflectance\" \"t\"" +
        std::string(kTexturedTriangle));
    ASSERT_TRUE(metal.material().maps);
    expect_near(metal.material().optics->reflection, vec3(1));
}

} // namespace
} // namespace ovc
