// SPDX-License-Identifier: Apache-2.0
// Alpha and shadowalpha of PBRT's shapes become cutouts with texture coordinates, or masks.
#include "importers/test_files.h"

#include <algorithm>

namespace ovc {
namespace {

/// A triangle whose parameters go on.
constexpr const char* kTriangleMesh =
    " Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0  1 0 0  0 1 0] ";

struct Read {
    Scene scene;
    std::vector<std::string> warnings;

    const MeshInfo& mesh() const { return scene.meshes.at(0); }
};

/// Reads the text with these pictures beside it: a.pgm is black and white, gray.pgm is as light as
/// 188 on a screen, which is half of white, and a.png has opacities 0 and 255.
Read read(const std::string& text) {
    const TestFolder folder;
    folder.write("a.pgm", "P2\n2 1\n255\n0 255\n");
    folder.write("gray.pgm", "P2\n1 1\n255\n188\n");
    folder.write("a.png", png_of(2, 1, {255, 255, 255, 0, 0, 0, 0, 255}));
    folder.write("square.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                               "property float y\nproperty float z\nproperty float u\n"
                               "property float v\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n"
                               "0 0 0 0 0\n1 0 0 0.5 0\n1 1 0 0.5 0.25\n0 1 0 0 0.25\n4 0 1 2 3\n");
    Read read;
    Result<Scene> scene = load(folder.write("a.pbrt", text), gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    for (std::string& warning : read.warnings)
        warning = folder.plain(warning);
    return read;
}

Read read_texture(const std::string& texture) {
    return read("WorldBegin Texture \"t\" \"float\" " + texture + kTriangleMesh +
                "\"texture alpha\" \"t\"");
}

/// The picture a.pgm as pbrt places it without any parameters.
Cutout black_and_white() {
    return {.width = 2, .height = 1, .opacity = {0, 255}, .smooth = true};
}

TEST(PbrtAlpha, TexturesBecomeCutouts) {
    Cutout clamped = black_and_white(), placed = clamped, inverted = clamped, point = clamped;
    clamped.beyond = Cutout::Beyond::Clamp;
    placed.beyond = Cutout::Beyond::Hole;
    placed.uv_scale = {2, 3};
    placed.uv_offset = {0.25, 0.5};
    inverted.opacity = {255, 0};
    inverted.scale = 0.5f;
    point.smooth = false;
    const Cutout half{.width = 1, .height = 1, .opacity = {128}, .smooth = true};
    Cutout linear = half;
    linear.opacity = {188};
    const Cutout board{.width = 2,
                       .height = 2,
                       .opacity = {0, 255, 255, 0},
                       .uv_scale = dvec2(2),
                       .uv_offset = dvec2(0)};
    const std::pair<std::string, Cutout> cases[] = {
        {"\"imagemap\" \"string filename\" \"a.pgm\"", black_and_white()},
        {"\"imagemap\" \"string filename\" \"a.pgm\" \"string wrap\" \"clamp\"", clamped},
        {"\"imagemap\" \"string filename\" \"a.pgm\" \"string wrap\" \"black\" \"float uscale\" 2 "
         "\"float vscale\" 3 \"float udelta\" 0.25 \"float vdelta\" 0.5",
         placed},
        {"\"imagemap\" \"string filename\" \"a.pgm\" \"bool invert\" true \"float scale\" 0.5",
         inverted},
        {"\"imagemap\" \"string filename\" \"a.pgm\" \"string filter\" \"point\"", point},
        {"\"imagemap\" \"string filename\" \"a.png\"", black_and_white()},
        {"\"imagemap\" \"string filename\" \"gray.pgm\"", half},
        {"\"imagemap\" \"string filename\" \"gray.pgm\" \"string encoding\" \"linear\"", linear},
        {"\"imagemap\" \"string filename\" \"gray.pgm\" \"bool gamma\" false", linear},
        {"\"checkerboard\" \"float uscale\" 4 \"float vscale\" 4", board}};
    for (const auto& [text, expected] : cases) {
        const Read found = read_texture(text);
        ASSERT_EQ(found.scene.cutouts.size(), 1u) << text;
        EXPECT_EQ(found.scene.cutouts[0], expected) << text;
        EXPECT_EQ(found.mesh().cutout, 0u) << text;
        EXPECT_EQ(found.mesh().shadow_cutout, kNone) << text;
        EXPECT_TRUE(found.warnings.empty()) << text << found.warnings[0];
    }
}

TEST(PbrtAlpha, ScaledTexturesAreScaledCutouts) {
    const std::string picture = "\"imagemap\" \"string filename\" \"a.pgm\" ";
    Cutout quarter = black_and_white();
    quarter.scale = 0.25f;
    for (const char* scale : {"\"scale\" \"texture tex\" \"t\" \"float scale\" 0.25",
                              "\"scale\" \"texture tex1\" \"t\" \"float tex2\" 0.25",
                              "\"scale\" \"float tex1\" 0.25 \"texture tex2\" \"t\"",
                              "\"scale\" \"texture tex\" \"half\" \"float scale\" 0.5"}) {
        const Read found =
            read_texture(picture +
                         "Texture \"half\" \"float\" \"scale\" \"texture tex\" \"t\" \"float "
                         "scale\" 0.5 Texture \"s\" \"float\" " +
                         scale + kTriangleMesh + "\"texture alpha\" \"s\"");
        // The first mesh has the texture s, the second t.
        ASSERT_EQ(found.scene.cutouts.size(), 2u) << scale;
        EXPECT_EQ(found.scene.cutouts[found.scene.meshes[0].cutout], quarter) << scale;
        EXPECT_EQ(found.scene.cutouts[found.scene.meshes[1].cutout], black_and_white()) << scale;
        EXPECT_TRUE(found.warnings.empty()) << scale << found.warnings[0];
    }
}

TEST(PbrtAlpha, ConstantsCutByChance) {
    for (const char* alpha :
         {"\"float alpha\" 0.25", "\"texture alpha\" \"t\"", "\"texture alpha\" \"u\""}) {
        const Read found =
            read("WorldBegin Texture \"t\" \"float\" \"constant\" \"float value\" "
                 "0.25 Texture \"u\" \"float\" \"scale\" \"texture tex\" \"t\"" +
                 std::string(kTriangleMesh) + alpha + kTriangleMesh + "\"float alpha\" 0.25");
        ASSERT_EQ(found.scene.cutouts.size(), 1u) << alpha;
        EXPECT_EQ(found.scene.cutouts[0],
                  (Cutout{.width = 1, .height = 1, .opacity = {255}, .scale = 0.25f}));
    }
    EXPECT_TRUE(read(kTriangleMesh + std::string("\"float alpha\" 1")).scene.cutouts.empty());
    EXPECT_TRUE(read(kTriangleMesh + std::string("\"float alpha\" 0")).scene.meshes.empty());
}

TEST(PbrtAlpha, ALampThatIsNotSeenStillShines) {
    const Read found = read("AreaLightSource \"diffuse\" \"rgb L\" [5 6 7]" +
                            std::string(kTriangleMesh) + "\"float alpha\" 0");
    EXPECT_EQ(found.scene.soup.chunks.at(0).mask(), kSeenByNone);
    EXPECT_EQ(found.scene.materials[found.mesh().material].optics->emission, vec3(5, 6, 7));
    EXPECT_FALSE(found.scene.lights.empty()) << "Whitted's model has its light too";
}

TEST(PbrtAlpha, IsTestedForZeroBeforeVersion4) {
    const std::string shape = kTriangleMesh + std::string("\"float alpha\" 0.25 ");
    EXPECT_TRUE(read("WorldBegin " + shape).scene.cutouts.at(0).partial);
    EXPECT_FALSE(read("WorldBegin " + shape + "WorldEnd").scene.cutouts.at(0).partial);
}

TEST(PbrtAlpha, ShadowsMayHaveTheirOwn) {
    const Read found = read("WorldBegin Texture \"t\" \"float\" \"imagemap\" \"string filename\" "
                            "\"a.pgm\"" +
                            std::string(kTriangleMesh) + "\"texture shadowalpha\" \"t\" WorldEnd");
    EXPECT_EQ(found.mesh().cutout, kNone);
    EXPECT_EQ(found.mesh().shadow_cutout, 0u);
    EXPECT_EQ(found.mesh().uv.size(), 3u);
    const Read none = read(kTriangleMesh + std::string("\"float shadowalpha\" 0"));
    EXPECT_EQ(none.scene.soup.chunks.at(0).mask(), kSeenByCamera | kSeenInReflections);
    EXPECT_TRUE(none.scene.cutouts.empty());
}

TEST(PbrtAlpha, WhatIsNotEvaluatedIsSaid) {
    const Read dots = read_texture("\"dots\"");
    EXPECT_EQ(dots.mesh().cutout, kNone);
    EXPECT_EQ(dots.warnings, (std::vector<std::string>{"a.pbrt:1: a texture 'dots' as alpha is not "
                                                       "evaluated, and makes no holes"}));
    EXPECT_EQ(
        read_texture("\"imagemap\" \"string filename\" \"a.pgm\" \"string mapping\" "
                     "\"spherical\"")
            .warnings,
        (std::vector<std::string>{
            "a.pbrt:1: a mapping 'spherical' as alpha is not evaluated, and makes no holes"}));
    EXPECT_EQ(read_texture("\"imagemap\" \"string filename\" \"zzzzzz\"").warnings,
              (std::vector<std::string>{"a.pbrt:1: there is no file 'zzzzzz'"}));
    // A picture that is no alpha is still shown by its mean.
    EXPECT_EQ(read("WorldBegin Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.pgm\"" +
                   std::string(kTriangleMesh))
                  .warnings,
              (std::vector<std::string>{"a.pbrt:1: textures 'imagemap' are shown by their mean"}));
}

/// Reads a shape with an alpha, and returns its texture coordinates.
std::vector<vec2> uv_of(const std::string& shape) {
    const Read found = read("WorldBegin " + shape + " \"float alpha\" 0.5");
    EXPECT_EQ(found.mesh().uv.size(), 3 * found.scene.soup.chunks.at(0).size()) << shape;
    EXPECT_EQ(found.mesh().texture_coordinates_left_out, 0u) << shape;
    return found.mesh().uv;
}

TEST(PbrtAlpha, TrianglesHaveTextureCoordinates) {
    using Uv = std::vector<vec2>;
    const std::string mesh = kTriangleMesh;
    EXPECT_EQ(uv_of(mesh), (Uv{{0, 0}, {1, 0}, {1, 1}}));
    EXPECT_EQ(uv_of(mesh + "\"point2 uv\" [.5 0 1 .25 0 1]"), (Uv{{0.5f, 0}, {1, 0.25f}, {0, 1}}));
    EXPECT_EQ(uv_of(mesh + "\"float st\" [.5 0 1 .25 0 1]"), (Uv{{0.5f, 0}, {1, 0.25f}, {0, 1}}));
    EXPECT_EQ(uv_of("ReverseOrientation " + mesh + "\"float uv\" [.5 0 1 .25 0 1]"),
              (Uv{{0.5f, 0}, {0, 1}, {1, 0.25f}}));
    EXPECT_EQ(uv_of("Scale 1 1 -1 " + mesh + "\"float uv\" [.5 0 1 .25 0 1]"),
              (Uv{{0.5f, 0}, {0, 1}, {1, 0.25f}}));
    EXPECT_EQ(uv_of("Shape \"plymesh\" \"string filename\" \"square.ply\""),
              (Uv{{0, 0}, {0.5f, 0}, {0.5f, 0.25f}, {0, 0}, {0.5f, 0.25f}, {0, 0.25f}}));
    EXPECT_EQ(uv_of("Shape \"loopsubdiv\" \"integer levels\" 0 \"integer indices\" [0 1 2] "
                    "\"point3 P\" [0 0 0  1 0 0  0 1 0]"),
              (Uv{{0, 0}, {1, 0}, {1, 1}}));
    EXPECT_EQ(uv_of("Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [0 0 0 "
                    "0]"),
              (Uv{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}));
    const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]";
    EXPECT_EQ(uv_of(patch), (Uv{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(uv_of(patch + "\"point2 uv\" [0 0 .5 0 0 .5 .5 .5]"),
              (Uv{{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0}, {0.5f, 0.5f}, {0, 0.5f}}));
}

TEST(PbrtAlpha, QuadricsHaveTextureCoordinates) {
    const struct {
        const char* shape;
        vec2 (*uv)(const dvec3& p, double turns);
    } cases[] = {{"\"sphere\"", [](const dvec3& p,
                                   double u) { return vec2(u, 1 - std::acos(p.z) / 3.14159265); }},
                 {"\"cylinder\" \"float zmin\" 0 \"float zmax\" 2",
                  [](const dvec3& p, double u) { return vec2(u, p.z / 2); }},
                 {"\"disk\" \"float innerradius\" 0.5",
                  [](const dvec3& p, double u) { return vec2(u, 2 - 2 * glm::length(p)); }},
                 {"\"cone\"", [](const dvec3& p, double u) { return vec2(u, p.z); }},
                 {"\"paraboloid\"", [](const dvec3& p, double u) { return vec2(u, p.z); }}};
    for (const auto& [shape, uv] : cases) {
        const Read found = read("WorldBegin Shape " + std::string(shape) + " \"float alpha\" 0.5");
        for (uint32_t prim = 0; prim < found.scene.soup.chunks.at(0).size(); ++prim) {
            float before = found.mesh().uv[3 * prim].x;
            for (size_t i = 0; i < 3; ++i) {
                const dvec3 corner = found.scene.soup.triangle({0, prim})[i];
                const vec2 at = found.mesh().uv[3 * prim + i];
                ASSERT_LT(std::abs(at.x - before), 0.1f) << shape << " wraps around in a triangle";
                double turns = std::atan2(corner.y, corner.x) / 6.2831853071795864;
                turns += turns < -1e-9 ? 1 : 0;
                const bool at_seam = turns < 1e-6 && at.x > 0.5f;
                const bool at_pole = glm::length(dvec2(corner)) < 1e-6;
                const vec2 expected = uv(corner, at_pole ? double(at.x) : at_seam ? 1 : turns);
                ASSERT_NEAR(at.x, expected.x, 1e-5) << shape;
                ASSERT_NEAR(at.y, expected.y, 1e-5) << shape;
                before = at.x;
            }
        }
    }
}

TEST(PbrtAlpha, InstancesShareTextureCoordinates) {
    const std::string many = "Shape \"sphere\" \"float alpha\" 0.5 ";
    for (const std::string& shape : {kTriangleMesh + std::string("\"float alpha\" 0.5 "), many}) {
        const Scene scene = read("WorldBegin ObjectBegin \"o\" " + shape +
                                 "ObjectEnd ObjectInstance \"o\" Translate 3 0 0 ObjectInstance "
                                 "\"o\" Scale -1 1 1 ObjectInstance \"o\"")
                                .scene;
        ASSERT_EQ(scene.meshes.size(), 3u);
        EXPECT_EQ(scene.meshes[0].uv_from, kNone);
        EXPECT_EQ(scene.meshes[1].uv_from, 0u);
        EXPECT_TRUE(scene.meshes[1].uv.empty());
        ASSERT_EQ(scene.meshes[2].uv.size(), scene.meshes[0].uv.size());
        EXPECT_EQ(scene.meshes[2].uv[0], scene.meshes[0].uv[0]);
        EXPECT_EQ(scene.meshes[2].uv[1], scene.meshes[0].uv[2]) << "turned round";
        for (const MeshInfo& mesh : scene.meshes)
            EXPECT_EQ(mesh.cutout, 0u);
    }
}

TEST(PbrtAlpha, CostsNothingWhereThereIsNone) {
    const Scene scene =
        read("WorldBegin " + std::string(kTriangleMesh) + "\"point2 uv\" [0 0 1 0 0 1]").scene;
    EXPECT_TRUE(scene.cutouts.empty());
    EXPECT_TRUE(scene.meshes.at(0).uv.empty());
    EXPECT_EQ(scene.meshes[0].texture_coordinates_left_out, 3u);
}

TEST(PbrtAlpha, ShapesOfOneAlphaBecomeOneMesh) {
    const std::string half = kTriangleMesh + std::string("\"float alpha\" 0.5 ");
    EXPECT_EQ(read(half + half).scene.meshes.size(), 1u);
    EXPECT_EQ(read(half + half).mesh().uv.size(), 6u);
    EXPECT_EQ(read(half + kTriangleMesh).scene.meshes.size(), 2u);
}

} // namespace
} // namespace ovc
