// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 through Assimp: textures, their transforms, alpha modes, lights. The files are made
// here.
#include "core/texture/pattern.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace ovc {
namespace {

std::string base64(const std::string& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t three = 0;
        for (size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63];
    }
    return text;
}

/// Returns a glTF file of one triangle with texture coordinates (0, 0), (1, 0) and (0, 1), v
/// downwards. material: its JSON; more: further members.
std::string gltf_of(const std::string& material, const std::string& more = {},
                    const std::string& nodes = "{\"mesh\":0}", const std::string& roots = "0") {
    const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, /* uv */ 0, 0, 1, 0, 0, 1};
    std::string bytes(sizeof(numbers), '\0');
    std::memcpy(bytes.data(), numbers, sizeof(numbers));
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[" + roots +
           "]}],\"nodes\":[" + nodes +
           "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},"
           "\"material\":0}]}],\"materials\":[" +
           material +
           "],\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64," +
           base64(bytes) +
           "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"
           "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],\"accessors\":["
           "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
           "\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":"
           "\"VEC2\"}],\"textures\":[{\"source\":0},{\"source\":1,\"sampler\":0}],\"samplers\":[{"
           "\"wrapS\":33071,\"wrapT\":33648}],\"images\":[{\"uri\":\"a%20b.png\"},{\"uri\":"
           "\"data:image/png;base64," +
           base64("\x89PNG not a real one") + "\"}]" + more + "}";
}

struct ReadGltf {
    Scene scene;
    std::vector<std::string> warnings;

    const Material& material() const { return scene.materials[scene.meshes.at(0).material]; }
    const ImageTexture& image(uint32_t texture) const { return *scene.textures[texture].image; }
};

ReadGltf read_gltf(const std::string& text) {
    const TestFolder folder;
    ReadGltf read;
    Result<Scene> scene = load(folder.write("a.gltf", text), gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    for (PictureFile& picture : read.scene.pictures)
        picture.file = folder.plain(picture.file);
    return read;
}

TEST(Gltf, BaseColorIsATextureTimesAFactor) {
    const ReadGltf read =
        read_gltf(gltf_of("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,0.25,1],"
                          "\"baseColorTexture\":{\"index\":0},\"metallicFactor\":0}}"));
    EXPECT_TRUE(read.warnings.empty()) << read.warnings[0];
    ASSERT_TRUE(read.material().texture);
    const ImageTexture& image = read.image(read.material().texture->texture);
    EXPECT_EQ(image.scale, vec3(0.5f, 1, 0.25f));
    EXPECT_EQ(image.gamma, 0);
    EXPECT_EQ(image.beyond_s, Beyond::Repeat);
    EXPECT_EQ(read.scene.pictures[image.picture].file, "a b.png");
    EXPECT_EQ(read.scene.meshes[0].uv, (std::vector<vec2>{{0, 1}, {1, 1}, {0, 0}}))
        << "v goes up here";
    EXPECT_EQ(read.scene.meshes[0].cutout, kNone);
}

TEST(Gltf, PicturesWithinTheFileAreKeptWithIt) {
    const ReadGltf read =
        read_gltf(gltf_of("{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1}}}"));
    ASSERT_EQ(read.scene.pictures.size(), 1u);
    const std::vector<uint8_t>& bytes = read.scene.pictures[0].contents;
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "\x89PNG not a real one");
    const ImageTexture& image = read.image(read.material().texture->texture);
    EXPECT_EQ(image.beyond_s, Beyond::Clamp);
    EXPECT_EQ(image.beyond_t, Beyond::Mirror);
}

/// KHR_texture_transform: uv' = translation x rotation x scale x uv, with v downwards.
TEST(Gltf, TextureTransformsAreThoseOfTheExtension) {
    const double angle = 0.4, c = std::cos(angle), s = std::sin(angle);
    const ReadGltf read = read_gltf(gltf_of(
        "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":{"
        "\"KHR_texture_transform\":{\"offset\":[0.3,-0.2],\"rotation\":0.4,\"scale\":[2,3]}}}}}",
        ",\"extensionsUsed\":[\"KHR_texture_transform\"]"));
    const ImageTexture& image = read.image(read.material().texture->texture);
    for (const dvec2 uv : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(0.3, 0.8)}) {
        const dvec2 scaled = dvec2(2, 3) * uv;
        const dvec2 expected(c * scaled.x + s * scaled.y + 0.3, -s * scaled.x + c * scaled.y - 0.2);
        const dvec3 ours(uv.x, 1 - uv.y, 1);
        EXPECT_NEAR(glm::dot(image.to_picture[0], ours), expected.x, 1e-5);
        EXPECT_NEAR(1 - glm::dot(image.to_picture[1], ours), expected.y, 1e-5);
    }
}

TEST(Gltf, MetalAndRoughnessAreChannelsOfOneTexture) {
    const ReadGltf read = read_gltf(gltf_of(
        "{\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0},"
        "\"metallicFactor\":0.5,\"roughnessFactor\":0.8},\"emissiveFactor\":[1,0.5,0],"
        "\"emissiveTexture\":{\"index\":0},\"normalTexture\":{\"index\":0,\"scale\":0.75}}"));
    const Material& material = read.material();
    ASSERT_TRUE(material.optics);
    EXPECT_NEAR(material.optics->width, 0.64f, 1e-6f);
    EXPECT_EQ(material.optics->emission, vec3(1, 0.5f, 0));
    ASSERT_TRUE(material.maps);
    const ImageTexture& metal = read.image(material.maps->metallic);
    EXPECT_EQ(metal.channel, ImageTexture::Channel::Blue);
    EXPECT_EQ(metal.scale, vec3(0.5f));
    EXPECT_EQ(metal.gamma, 1);
    const Texture& width = read.scene.textures[material.maps->width];
    EXPECT_EQ(width.kind, TextureKind::Product);
    EXPECT_EQ(read.image(width.stops.at(0).texture).channel, ImageTexture::Channel::Green);
    EXPECT_EQ(read.image(material.maps->emission).gamma, 0);
    ASSERT_TRUE(material.normal_map);
    EXPECT_EQ(material.normal_map->scale, 0.75);
    EXPECT_EQ(material.normal_map->kind, NormalMap::Kind::Tangent);
    EXPECT_EQ(read.scene.meshes[0].uv.size(), 3u);
}

TEST(Gltf, AlphaModesMakeHoles) {
    const auto cutout = [](const std::string& mode) {
        const ReadGltf read =
            read_gltf(gltf_of("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5],"
                              "\"baseColorTexture\":{\"index\":0}}" +
                              mode + "}"));
        const uint32_t number = read.scene.meshes[0].cutout;
        if (number == kNone)
            return std::optional<Cutout>();
        const ImageTexture& image = read.image(read.scene.cutouts[number].texture);
        EXPECT_EQ(image.channel, ImageTexture::Channel::Opacity);
        EXPECT_EQ(image.scale, vec3(0.5f));
        EXPECT_EQ(read.material().transmission, 0) << "the holes let light through";
        return std::optional(read.scene.cutouts[number]);
    };
    EXPECT_FALSE(cutout(""));
    EXPECT_EQ(cutout(",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25").value().threshold, 0.25f);
    EXPECT_EQ(cutout(",\"alphaMode\":\"MASK\"").value().threshold, 0.5f);
    EXPECT_EQ(cutout(",\"alphaMode\":\"BLEND\"").value().threshold, 0);
}

TEST(Gltf, AlphaWithoutATextureFollowsItsMode) {
    const auto of_mode = [](const std::string& mode) {
        return read_gltf(gltf_of("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.25]}" +
                                 mode + "}"))
            .scene;
    };
    EXPECT_EQ(of_mode("").materials[0].transmission, 0) << "OPAQUE has no use for alpha";
    EXPECT_EQ(of_mode(",\"alphaMode\":\"BLEND\"").materials[0].transmission, 0.75f);
    EXPECT_EQ(of_mode(",\"alphaMode\":\"MASK\"").soup.triangle_count(), 0u);
    const Scene kept = of_mode(",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.2");
    EXPECT_EQ(kept.soup.triangle_count(), 1u);
    EXPECT_EQ(kept.materials[0].transmission, 0);
}

TEST(Gltf, WhatLetsLightThroughMaySendSomeOut) {
    const ReadGltf veil =
        read_gltf(gltf_of("{\"alphaMode\":\"BLEND\",\"emissiveFactor\":[1,0.5,0],"
                          "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,1,0.25]}}"));
    ASSERT_TRUE(veil.material().optics);
    const Optics& optics = *veil.material().optics;
    EXPECT_EQ(optics.emission, vec3(1, 0.5f, 0));
    EXPECT_EQ(optics.through, vec3(0.75f));
    EXPECT_EQ(optics.diffuse, 0.25f * vec3(0.5f, 1, 1));
    EXPECT_EQ(optics.boundary, Optics::Boundary::None);
    const ReadGltf pane = read_gltf(
        gltf_of("{\"emissiveFactor\":[1,0.5,0],\"pbrMetallicRoughness\":{\"baseColorTexture\":{"
                "\"index\":0}},\"extensions\":{\"KHR_materials_transmission\":{"
                "\"transmissionFactor\":0.5}}}"));
    ASSERT_TRUE(pane.material().texture && pane.material().optics);
    EXPECT_EQ(pane.material().optics->emission, vec3(1, 0.5f, 0));
    EXPECT_EQ(pane.material().optics->through, vec3(0.5f));
}

TEST(Gltf, PunctualLightsStandWhereTheirNodesDo) {
    const ReadGltf read = read_gltf(gltf_of(
        "{}",
        ",\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
        "\"lights\":[{\"type\":\"point\",\"intensity\":3,\"color\":[1,0.5,0]},"
        "{\"type\":\"directional\",\"intensity\":2},{\"type\":\"spot\",\"intensity\":1,\"spot\":{"
        "\"innerConeAngle\":0.2,\"outerConeAngle\":0.5}}]}}",
        "{\"mesh\":0},{\"name\":\"p\",\"translation\":[1,2,3],\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":0}}},"
        "{\"name\":\"d\",\"rotation\":[-0.70710678,0,0,0.70710678],\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":1}}},"
        "{\"name\":\"s\",\"translation\":[0,0,5],\"extensions\":{\"KHR_lights_punctual\":{"
        "\"light\":2}}}",
        "0,1,2,3"));
    ASSERT_EQ(read.scene.lights.size(), 3u);
    EXPECT_EQ(read.scene.background.horizon, vec3(0));
    EXPECT_EQ(read.scene.background.zenith, vec3(0));
    EXPECT_EQ(read_gltf(gltf_of("{}")).scene.background.zenith, Background{}.zenith);
    const Light& point = read.scene.lights[0];
    EXPECT_EQ(point.position, dvec3(1, 2, 3));
    // Its intensity over the square of the distance.
    const double fall = 2 / (1 + std::pow(4 / point.fade_distance, point.fade_power));
    EXPECT_NEAR(point.color.x * fall / read.scene.exposure, 3.0 / 16, 1e-4);
    EXPECT_NEAR(point.color.y * fall / read.scene.exposure, 1.5 / 16, 1e-4);
    const Light& sun = read.scene.lights[1];
    EXPECT_TRUE(sun.parallel && sun.distant);
    EXPECT_LT(glm::length(sun.direction - dvec3(0, -1, 0)), 1e-5);
    EXPECT_NEAR(sun.color.x / read.scene.exposure, 2, 1e-5);
    const Light& spot = read.scene.lights[2];
    ASSERT_TRUE(spot.cone);
    EXPECT_NEAR(spot.cone->radius_cosine, std::cos(0.2), 1e-6);
    EXPECT_NEAR(spot.cone->falloff_cosine, std::cos(0.5), 1e-6);
    EXPECT_LT(glm::length(spot.direction - dvec3(0, 0, -1)), 1e-5);
    EXPECT_THAT(read.warnings, testing::Not(testing::Contains(testing::HasSubstr("light"))));
}

/// Returns the error's sentence, or how many triangles there are.
std::string failure_of(const std::string& text, const std::string& name = "a.gltf") {
    const TestFolder folder;
    folder.write(name, text);
    return folder.failure(name);
}

/// Replaces the first `from`; the test fails if there is none.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return at == text.npos ? text : text.replace(at, from.size(), to);
}

/// data: a multiple of 4 bytes.
std::string binary_gltf(std::string json, const std::string& data) {
    json.append((4 - json.size() % 4) % 4, ' ');
    const auto number = [](size_t n) {
        return std::string{char(n), char(n >> 8), char(n >> 16), char(n >> 24)};
    };
    return "glTF" + number(2) + number(28 + json.size() + data.size()) + number(json.size()) +
           "JSON" + json + number(data.size()) + std::string("BIN\0", 4) + data;
}

/// Assimp 5 crashes on skins without what is optional in them.
TEST(Gltf, WhatIsDeformedIsShownAtRestAndSaid) {
    const ReadGltf read = read_gltf(with(
        gltf_of("{}", ",\"skins\":[{\"joints\":[0]}],\"animations\":[{}]",
                "{\"mesh\":0,\"skin\":0,\"weights\":[0.5]}"),
        "\"TEXCOORD_0\":1}", "\"TEXCOORD_0\":1,\"JOINTS_0\":99},\"targets\":[{\"POSITION\":77}]"));
    EXPECT_EQ(read.scene.soup.triangle_count(), 1u);
    EXPECT_THAT(read.warnings,
                testing::ElementsAre(
                    testing::HasSubstr("1 animation left out: what moves is shown at rest"),
                    testing::HasSubstr("1 skin left out: meshes are shown in their rest form"),
                    testing::HasSubstr(
                        "1 set of morph weights left out: meshes are shown in their rest form")));
}

/// Assimp keeps one place for a light, by the name of its node.
TEST(Gltf, NodesOfOneNameMayShareALight) {
    const std::string light =
        "\"name\":\"x\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}";
    const ReadGltf read = read_gltf(
        gltf_of("{}",
                ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}},"
                "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,"
                "\"aspectRatio\":0.5,\"znear\":1}}]",
                "{\"mesh\":0,\"name\":\"x\"},{\"translation\":[0,0,2]," + light +
                    ",{\"translation\":[0,0,3]," + light +
                    ",{\"translation\":[0,0,5],\"name\":\"x\",\"camera\":0}",
                "0,1,2,3"));
    ASSERT_EQ(read.scene.lights.size(), 2u);
    EXPECT_EQ(read.scene.lights[0].position, dvec3(0, 0, 2));
    EXPECT_EQ(read.scene.lights[1].position, dvec3(0, 0, 3));
    ASSERT_TRUE(read.scene.camera);
    EXPECT_EQ(read.scene.camera->eye, dvec3(0, 0, 5));
    // The shorter side of a picture that is twice as high as wide.
    EXPECT_NEAR(read.scene.camera->fov_degrees,
                2 * std::atan(std::tan(0.5) / 2) * 180 / std::numbers::pi, 1e-4);
    EXPECT_TRUE(read.warnings.empty());
}

TEST(Gltf, TheAngleOfACameraIsUprightWhereItTellsNoShape) {
    for (const bool has_shape : {false, true}) {
        const ReadGltf read = read_gltf(gltf_of(
            "{}",
            std::string(",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,") +
                (has_shape ? "\"aspectRatio\":2," : "") + "\"znear\":1}}]",
            "{\"mesh\":0},{\"camera\":0}", "0,1"));
        ASSERT_TRUE(read.scene.camera);
        EXPECT_NEAR(read.scene.camera->fov_degrees, 180 / std::numbers::pi, 1e-4);
        EXPECT_EQ(read.scene.camera->fov_is_upright, !has_shape);
    }
}

TEST(Gltf, AMirroredMeshKeepsItsFront) {
    const ReadGltf read = read_gltf(gltf_of("{}", "",
                                            "{\"children\":[1],\"translation\":[5,0,0]},"
                                            "{\"mesh\":0,\"scale\":[-1,1,1]}"));
    const Triangle t = read.scene.soup.chunks.at(0).triangle(0);
    EXPECT_EQ(t[0], dvec3(5, 0, 0));
    EXPECT_EQ(t[1], dvec3(5, 1, 0));
    EXPECT_EQ(t[2], dvec3(4, 0, 0));
}

TEST(Gltf, DataThatLiesElsewhereIsAnError) {
    const std::string sound = gltf_of("{}");
    EXPECT_EQ(failure_of(sound), "1 triangles");
    EXPECT_EQ(failure_of(with(sound, "\"count\":3", "\"count\":4")),
              "a.gltf: found accessors[0] up to byte 48, expected no more than the 36 of its view");
    EXPECT_EQ(failure_of(with(sound, "\"byteOffset\":36", "\"byteOffset\":40")),
              "a.gltf: found bufferViews[1] at bytes 40 to 64, expected no more than the 60 of its "
              "buffer");
    EXPECT_EQ(failure_of(with(sound, "\"count\":3", "\"sparse\":{\"count\":1},\"count\":3")),
              "a.gltf: found no indices in accessors[0].sparse");
    EXPECT_EQ(failure_of(with(sound, "\"componentType\":5126", "\"componentType\":5121")),
              "a.gltf: found POSITION in accessors[0], which is no VEC3 of floats");
    EXPECT_EQ(failure_of(gltf_of("{}", "", "{\"mesh\":0,\"children\":[0]}")),
              "a.gltf: found nodes[0] among its own descendants");
}

TEST(Gltf, ExtensionsThatAreNotShownAreNamed) {
    const std::string required = ",\"extensionsRequired\":[\"KHR_texture_transform\",\"X_y\"]";
    EXPECT_EQ(failure_of(gltf_of("{}", required)),
              "a.gltf: found the required extension 'X_y', expected none but "
              "KHR_draco_mesh_compression, KHR_lights_punctual, KHR_materials_emissive_strength, "
              "KHR_materials_ior, KHR_materials_transmission, KHR_texture_transform");
    const ReadGltf read =
        read_gltf(gltf_of("{\"extensions\":{\"KHR_materials_ior\":{},\"KHR_materials_unlit\":{}}}",
                          ",\"extensionsRequired\":[\"KHR_materials_unlit\"]"));
    EXPECT_THAT(read.warnings, testing::ElementsAre(testing::HasSubstr(
                                   "the extension 'KHR_materials_unlit' left out")));
}

TEST(Gltf, LightMayBeStrongerThanItsFactor) {
    const ReadGltf read =
        read_gltf(gltf_of("{\"emissiveFactor\":[1,0.5,0],\"extensions\":{"
                          "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":5}}}"));
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_TRUE(read.material().optics);
    EXPECT_EQ(read.material().optics->emission, vec3(5, 2.5f, 0));
}

TEST(Gltf, NamesOfFilesAreUris) {
    const TestFolder folder;
    folder.write("a b.bin", std::string(60, '\0'));
    std::string text = gltf_of("{}");
    const size_t data = text.find("data:application");
    text.replace(data, text.find('"', data) - data, "a%20b.bin");
    folder.write("a.gltf", text);
    EXPECT_EQ(folder.failure("a.gltf"), "1 triangles");
}

TEST(Gltf, AFileWithoutASceneShowsAllItsNodes) {
    const std::string nodes = "{\"mesh\":0},{\"children\":[0]},{\"mesh\":0}";
    EXPECT_EQ(failure_of(with(gltf_of("{}", "", nodes), "\"scenes\"", "\"no\"")), "2 triangles");
    const ReadGltf read = read_gltf(with(gltf_of("{}", "", nodes), "\"scenes\":[",
                                         "\"scenes\":[{\"nodes\":[1,2]},{\"nodes\":[2]},"));
    EXPECT_EQ(read.scene.soup.triangle_count(), 2u);
    EXPECT_THAT(read.warnings, testing::ElementsAre(testing::HasSubstr("2 more scenes left out")));
}

/// The data is that of draco_encoder for a triangle. Assimp may have been built without Draco.
TEST(Gltf, DracoIsUnpackedWithIndicesOf32Bits) {
    const std::string text =
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],"
        "\"buffers\":[{\"byteLength\":61,\"uri\":\"data:application/octet-stream;base64,"
        "RFJBQ08CAgEAAAABAwEAAQIBAQAJAwAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
        "AAAAAA==\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":61}],\"accessors\":["
        "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"componentType\":5125,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2},"
        "\"indices\":1,\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
        "\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1}}}}]}],"
        "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}";
    const TestFolder folder;
    const Result<Scene> scene = load(folder.write("a.gltf", text));
    if (!scene && scene.error().message.ends_with("Draco mesh compression not supported."))
        GTEST_SKIP() << "this Assimp has no Draco";
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->soup.triangle_count(), 1u);
    Box bounds;
    for (const dvec3& corner : scene->soup.triangle({0, 0}))
        bounds.add(corner);
    EXPECT_EQ(bounds.lo, dvec3(0));
    EXPECT_EQ(bounds.hi, dvec3(1, 1, 0));
}

TEST(Gltf, VertexColorsAndUnevenTextureCoordinatesAreSaid) {
    const ReadGltf read =
        read_gltf(with(with(gltf_of("{}"), "\"TEXCOORD_0\":1", "\"TEXCOORD_0\":1,\"COLOR_0\":0"),
                       "5126,\"count\":3,\"type\":\"VEC2\"", "5123,\"count\":3,\"type\":\"VEC2\""));
    EXPECT_THAT(
        read.warnings,
        testing::ElementsAre(testing::HasSubstr("1 set of vertex colors left out"),
                             testing::HasSubstr("1 set of texture coordinates left out: they are "
                                                "no floats")));
}

TEST(Gltf, BrokenFilesSayWhere) {
    const std::string sound = gltf_of("{}");
    EXPECT_EQ(failure_of("{\n \"asset\": nonsense}"),
              "a.gltf, line 2: found 'o' in column 12, expected JSON to go on");
    EXPECT_EQ(failure_of("{\"asset\":{}"), "a.gltf, line 1: found the end of the file in column "
                                           "12, expected JSON to go on");
    EXPECT_EQ(failure_of("[]"), "a.gltf: found JSON that is no object, expected a glTF file");
    EXPECT_EQ(failure_of("{}"), "a.gltf: found no version, expected glTF of version 2.0");
    EXPECT_EQ(failure_of("{\"a\":" + std::string(300, '[') + std::string(300, ']') + "}"),
              "a.gltf: found JSON more than 200 levels deep, expected fewer");
    const size_t uri = sound.find(",\"uri\":\"data:application");
    std::string without = sound;
    without.erase(uri, sound.find('"', uri + 10) + 1 - uri);
    const std::string binary = binary_gltf(without, std::string(60, '\0'));
    EXPECT_EQ(failure_of(binary, "a.glb"), "1 triangles");
    EXPECT_EQ(failure_of(gzip(binary), "a.glb.gz"), "1 triangles");
    EXPECT_EQ(failure_of(binary.substr(0, 100), "a.glb"), "a.glb: found 100 bytes, expected " +
                                                              std::to_string(binary.size()) +
                                                              ", as its header says");
}

} // namespace
} // namespace ovc
