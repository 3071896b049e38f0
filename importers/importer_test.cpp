// SPDX-License-Identifier: Apache-2.0
// load() and save() choose readers, unpack gz, ask Assimp, make round trips, and replace no file in
// vain.
#include "importers/importer.h"

#include "importers/readers.h"
#include "importers/test_files.h"
#include "tests/file_size_limit.h"

#include <gmock/gmock.h>

#include <sys/stat.h>

#include <bit>
#include <numbers>
#include <random>

namespace ovc {
namespace {

namespace fs = std::filesystem;

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* kStl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                             "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const std::vector<Triangle> kOne = {{dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)}};

TEST(Importer, TheExtensionChoosesTheReader) {
    const TestFolder folder;
    const struct {
        const char* name;
        std::string contents;
    } cases[] = {{"a.obj", kObj},
                 {"a.OBJ", kObj},
                 {"a.b.Obj", kObj},
                 {"a.obj.gz", gzip(kObj)},
                 {"a.OBJ.GZ", gzip(kObj)},
                 {"packed.obj", gzip(kObj)},
                 {"plain.obj.gz", kObj},
                 {"two.obj.gz", gzip("v 0 0 0\nv 1 0 0\n") + gzip("v 0 1 0\nf 1 2 3\n")},
                 {"a.off", kOff},
                 {"a.off.gz", gzip(kOff)},
                 {"a.stl", kStl},
                 {"a.STL.gz", gzip(kStl)}};
    for (const auto& test : cases)
        EXPECT_EQ(triangles_of(load(folder.write(test.name, test.contents))), kOne) << test.name;
}

#ifndef __SANITIZE_ADDRESS__ // which maps far more memory than there is
TEST(Importer, SaysThatAModelIsLargerThanTheMemory) {
    const TestFolder folder;
    folder.write("claims.off", "OFF\n1000000000 1 0\n0 0 0\n");
    EXPECT_THAT(folder.failure("claims.off"),
                testing::HasSubstr("claims.off: found a model that takes more memory than is free, "
                                   "or than its files can hold"));
}
#endif

TEST(Importer, ErrorsNameTheFileAndWhatWasExpected) {
    const TestFolder folder;
    fs::create_directories(folder / "folder.ply");
    for (const char* name : {"a.plyx", "a.xyzw", "none", "a.gz", ".obj"})
        folder.write(name, "x");
    folder.write("empty.stl", "");
    const std::string reads = ", expected .obj, .ovc, .pbrt, .ply, .pov or one that Assimp reads, "
                              "such as .stl, .off, .glb";
    EXPECT_EQ(folder.failure("gone.ply"), "gone.ply: no such file");
    EXPECT_EQ(folder.failure("gone.plyx"), "gone.plyx: no such file");
    EXPECT_EQ(folder.failure("gone.abc"), "gone.abc: no such file");
    EXPECT_EQ(folder.failure("nonne"), "nonne: no such file; did you mean 'none'?");
    EXPECT_EQ(folder.failure("Empty.slt"), "Empty.slt: no such file; did you mean 'empty.stl'?");
    EXPECT_EQ(folder.failure("no folder/gone.ply"), "no folder/gone.ply: no such file");
    EXPECT_EQ(folder.failure("a.obj/b.ply"), "a.obj/b.ply: no such file");
    EXPECT_EQ(folder.failure("a.plyx"),
              "a.plyx: found extension .plyx" + reads + "; did you mean .ply?");
    EXPECT_EQ(folder.failure("a.xyzw"), "a.xyzw: found extension .xyzw" + reads);
    EXPECT_EQ(folder.failure("none"), "none: found no extension" + reads);
    EXPECT_EQ(folder.failure("a.gz"), "a.gz: found no extension" + reads);
    EXPECT_EQ(folder.failure("empty.stl"), "empty.stl: the file is empty, expected a model");
}

TEST(Importer, OnlyRegularFilesAreOpened) {
    const TestFolder folder;
    fs::create_directories(folder / "folder.ply");
    folder.write("one.obj", kObj);
    const struct {
        const char* name;
        const char* target; // of the link; null: a pipe that nobody writes to
        const char* message;
    } cases[] = {
        {"pipe.obj", nullptr, "pipe.obj: found a pipe, which is no regular file"},
        {"to pipe.ply", "pipe.obj", "to pipe.ply: found a pipe, which is no regular file"},
        {"zero.ply", "/dev/zero", "zero.ply: found a device, which is no regular file"},
        {"zero.stl", "/dev/zero", "zero.stl: found a device, which is no regular file"},
        {"to folder.obj", "folder.ply",
         "to folder.obj: found a directory, which is no regular file"},
        {"nowhere.obj", "gone", "nowhere.obj: no such file"},
        {"to file.obj", "one.obj", "1 triangles"},
    };
    for (const auto& test : cases) {
        if (test.target)
            fs::create_symlink(test.target, folder / test.name);
        else
            ASSERT_EQ(mkfifo((folder / test.name).c_str(), 0600), 0);
        EXPECT_EQ(folder.failure(test.name), test.message) << test.name;
    }
    EXPECT_EQ(folder.failure("folder.ply"),
              "folder.ply: found a directory, which is no regular file");
}

TEST(Importer, NormalsAndTextureCoordinatesThatAreNotKeptAreCounted) {
    const TestFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto ply = [](const std::string& properties, const std::string& rest,
                        const std::string& in_face, const std::string& face_rest) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\n" +
               properties + "element face 1\nproperty list uchar int vertex_indices\n" + in_face +
               "end_header\n0 0 0" + rest + "\n1 0 0" + rest + "\n0 1 0" + rest + "\n3 0 1 2" +
               face_rest + "\n";
    };
    const std::string pbrt = "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";
    const struct {
        const char* name;
        std::string contents;
        uint64_t normals, texture_coordinates; // corners
    } cases[] = {
        {"plain.obj", corners + "f 1 2 3\n", 0, 0},
        {"none given.obj", corners + "vt 0 0\nf 1 2 3\n", 0, 0},
        {"none there.obj", corners + "f 1/1 2/1 3/1\n", 0, 0},
        {"textured.obj", corners + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3//1\n", 0, 2},
        {"textured corners.obj", corners + "vt 0 0\nf 1/1 2/1/ 3\n", 0, 2},
        {"useless normals.obj", corners + "vn 0 0 0\nf 1//1 2//1 3\n", 2, 0},
        {"plain.ply", ply("", "", "", ""), 0, 0},
        {"textured.ply", ply("property float s\nproperty float t\n", " 0 1", "", ""), 0, 3},
        {"faces.ply", ply("", "", "property list uchar float texcoord\n", " 6 0 0 0 1 1 1"), 0, 3},
        {"half.ply", ply("property float u\n", " 0", "", ""), 0, 0},
        {"useless.ply",
         ply("property float nx\nproperty float ny\nproperty float nz\n", " 0 0 0", "", ""), 3, 0},
        {"plain.pbrt", pbrt, 0, 0},
        {"textured.pbrt", pbrt + "\"point2 uv\" [0 0 1 0 1 1]", 0, 3},
        {"useless.pbrt", pbrt + "\"normal N\" [0 0 1]", 3, 0},
        {"plain.off", kOff, 0, 0},
        {"flat.stl", kStl, 3, 0},
    };
    for (const auto& test : cases) {
        const auto scene = load(folder.write(test.name, test.contents));
        EXPECT_EQ(triangles_of(scene), kOne) << test.name;
        uint64_t normals = 0, texture_coordinates = 0;
        for (const MeshInfo& mesh : scene->meshes) {
            normals += mesh.normals_left_out;
            texture_coordinates += mesh.texture_coordinates_left_out;
        }
        EXPECT_EQ(normals, test.normals) << test.name;
        EXPECT_EQ(texture_coordinates, test.texture_coordinates) << test.name;
    }
}

TEST(Importer, LongLinesAreReadWholeOrRefused) {
    const TestFolder folder;
    const std::string mebibyte = gzip(std::string(size_t(1) << 20, ' '));
    const auto padded = [&](const std::string& before, int mebibytes, const std::string& after) {
        std::string packed = gzip(before);
        for (int i = 0; i < mebibytes; ++i)
            packed += mebibyte;
        return packed + gzip(after);
    };
    const struct {
        const char* name;
        const char* before; // blanks in a line
        const char* after;
    } cases[] = {
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ", "3\n"},
        {"a.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty char x\nproperty char y\n"
         "property char z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 ",
         "2\n"},
        {"a.pbrt", "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 ", "0]"}};
    for (const auto& test : cases) {
        EXPECT_EQ(triangles_of(load(folder.write(test.name, padded(test.before, 65, test.after)))),
                  kOne)
            << test.name;
        folder.write(test.name, padded(test.before, 257, test.after));
        EXPECT_NE(folder.failure(test.name).find("found a line of more than 256 MiB"),
                  std::string::npos)
            << folder.failure(test.name);
    }
}

TEST(Importer, DamagedCompressionIsSaid) {
    const TestFolder folder;
    std::string text = kObj;
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i)
        text += "v " + std::to_string(random()) + " 0 0\n";
    const std::string packed = gzip(text);
    folder.write("cut.obj.gz", packed.substr(0, packed.size() / 2));
    EXPECT_NE(folder.failure("cut.obj.gz").find("the compressed data ends early"),
              std::string::npos)
        << folder.failure("cut.obj.gz");
    std::string flipped = packed;
    flipped[packed.size() - 6] ^= 1; // in the checksum
    folder.write("flipped.obj.gz", flipped);
    EXPECT_EQ(folder.failure("flipped.obj.gz"),
              "flipped.obj.gz, byte " + std::to_string(text.size()) +
                  ": the compressed data is damaged: incorrect checksum");
}

/// Returns a zip archive of files, by name and contents, that are not compressed.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
    const auto number = [](uLong n, int bytes) {
        std::string digits;
        for (int i = 0; i < bytes; ++i)
            digits += char(n >> (8 * i));
        return digits;
    };
    std::string all, entries;
    for (const auto& [name, contents] : files) {
        const uLong sum =
            crc32(0, reinterpret_cast<const Bytef*>(contents.data()), uInt(contents.size()));
        const std::string about = number(10, 2) + number(0, 8) + number(sum, 4) +
                                  number(contents.size(), 4) + number(contents.size(), 4) +
                                  number(name.size(), 2);
        entries += "PK\1\2" + number(10, 2) + about + number(0, 12) + number(all.size(), 4) + name;
        all += "PK\3\4" + about + number(0, 2) + name + contents;
    }
    return all + entries + "PK\5\6" + number(0, 4) + number(files.size(), 2) +
           number(files.size(), 2) + number(entries.size(), 4) + number(all.size(), 4) +
           number(0, 2);
}

/// Returns a 3MF file of one triangle, with a thumbnail.
std::string small_3mf() {
    const std::string relation =
        "<Relationship Id=\"r\" Target=\"/3D/3dmodel.model\" Type=\"http://"
        "schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>";
    const std::string mesh =
        "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
        "<vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>"
        "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";
    return zip_of({{"_rels/.rels", "<Relationships>" + relation + "</Relationships>"},
                   {"3D/3dmodel.model",
                    "<model><resources><object id=\"1\">" + mesh +
                        "</object></resources><build><item objectid=\"1\"/></build></model>"},
                   {"Metadata/thumbnail.png", std::string(1000, 'x')}});
}

TEST(Importer, ReadsA3mfFileWithAThumbnail) {
    const TestFolder folder;
    folder.write("a.3mf", small_3mf());
    EXPECT_EQ(folder.failure("a.3mf"), "1 triangles");
}

TEST(Importer, AssimpsFormatsSurviveDamage) {
    const TestFolder folder;
    folder.write("a.off", kOff);
    folder.write("rubbish.stl", "solid\nfacet");
    folder.write("rubbish.glb", "glTF");
    // Assimp's own way to cut polygons ends the process here.
    folder.write("no corners.off", "OFF\n4 2 0\n0 0 0\n1 0 2 3-13 0 2 3-1");
    EXPECT_THAT(
        folder.failure("no corners.off"),
        testing::AnyOf("0 triangles", // Assimp 5.4 refuses the file
                       testing::HasSubstr("The number of faces in the header is incorrect")));
    // Assimp asserts that the part is there.
    const char* const part = "<Relationships><Relationship Id=\"r\" Target=\"/3D/none.model\" Type="
                             "\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
                             "</Relationships>";
    folder.write("no part.3mf", zip_of({{"_rels/.rels", part}}));
    EXPECT_TRUE(folder.failure("no part.3mf").starts_with("no part.3mf: Assimp found: "))
        << folder.failure("no part.3mf");
    for (const char* name : {"rubbish.stl", "rubbish.glb"}) {
        const std::string message = folder.failure(name);
        EXPECT_TRUE(message.starts_with(std::string(name) + ": ") || message == "0 triangles")
            << message;
    }
}

/// Returns triangles whose corners are few, so that they share vertices; among them NaN, infinity,
/// -0, denormals.
Scene awkward_scene(dvec3 origin) {
    const float kValues[] = {0.f, -0.f, 1.f, 1e-45f, 3.4e38f, -0.1f, 16777217.f, 1 / 3.f};
    std::mt19937 random(7);
    Scene scene;
    scene.materials.emplace_back();
    for (int m = 0; m < 3; ++m) {
        std::vector<vec3> corners;
        for (int i = 0; i < 3 * (5 + m); ++i)
            corners.emplace_back(kValues[random() % 8], kValues[random() % 8],
                                 kValues[random() % 8]);
        scene.add_mesh("mesh " + std::to_string(m), 0, Chunk::owning(origin, std::move(corners)));
    }
    return scene;
}

std::vector<uint64_t> bits_of(const std::vector<Triangle>& triangles) {
    std::vector<uint64_t> bits;
    for (const Triangle& t : triangles)
        for (const dvec3& corner : t)
            for (int axis = 0; axis < 3; ++axis)
                bits.push_back(std::bit_cast<uint64_t>(
                    corner[axis] + 0.0)); // 0.0: the chunk's origin takes the sign off -0
    return bits;
}

TEST(Save, GivesBackEveryBit) {
    const TestFolder folder;
    const Result<Scene> scene = awkward_scene(dvec3(0));
    for (const char* name : {"a.ply", "a.obj", "A.PLY"}) {
        ASSERT_TRUE(save(*scene, folder / name));
        const auto back = load(folder / name);
        EXPECT_EQ(bits_of(triangles_of(back)), bits_of(triangles_of(scene))) << name;
    }
    const auto meshes = load(folder / "a.obj");
    ASSERT_EQ(meshes->meshes.size(), 3u);
    EXPECT_EQ(meshes->meshes[2].name, "mesh 2");
}

TEST(Save, KeepsWhatOnlyDoublesHold) {
    const TestFolder folder;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<vec3> corners;
    for (int i = 0; i < 300; ++i)
        corners.emplace_back(unit(random), unit(random), unit(random));
    Scene made;
    made.materials.emplace_back();
    made.add_mesh("far", 0, Chunk::owning(dvec3(1e6, -3e5, 7e6), corners));
    const Result<Scene> scene = std::move(made);
    ASSERT_TRUE(save(*scene, folder / "far.ply"));
    EXPECT_NE(folder.read("far.ply").find("property double x"), std::string::npos);
    const auto first = load(folder / "far.ply");
    EXPECT_EQ(triangles_of(first).size(), 100u);
    // Offsets from the new origin are rounded to floats once, by half a unit in their last place.
    for (size_t i = 0; i < 100; ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_LT(glm::distance(triangles_of(first)[i][c], triangles_of(scene)[i][c]), 1.1e-7);
    for (const char* name : {"again.ply", "again.obj"}) {
        ASSERT_TRUE(save(*first, folder / name));
        EXPECT_EQ(bits_of(triangles_of(load(folder / name))), bits_of(triangles_of(first))) << name;
    }
}

TEST(Save, SharesVerticesThatAgreeInEveryBit) {
    const TestFolder folder;
    const Result<Scene> square =
        load(folder.write("in.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
    ASSERT_TRUE(save(*square, folder / "out.obj"));
    EXPECT_EQ(folder.read("out.obj"),
              "o in\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    ASSERT_TRUE(save(*square, folder / "out.ply"));
    EXPECT_NE(folder.read("out.ply").find("element vertex 4\n"), std::string::npos);
}

TEST(Save, EmptyScenesComeBackEmpty) {
    const TestFolder folder;
    for (const char* name : {"e.ply", "e.obj"}) {
        ASSERT_TRUE(save(Scene{}, folder / name));
        if (fs::file_size(folder / name) > 0) {
            EXPECT_TRUE(triangles_of(load(folder / name)).empty());
        }
    }
}

TEST(Save, ErrorsNameTheFileAndWhatWasExpected) {
    const TestFolder folder;
    fs::create_directories(folder / "folder.ply");
    const auto failure = [&](const std::string& name) {
        const auto done = save(Scene{}, folder / name);
        return done ? "saved" : folder.plain(done.error().message);
    };
    EXPECT_EQ(failure("gone/a.ply"), "gone/a.ply: the folder does not exist");
    EXPECT_EQ(failure("folder.ply"), "folder.ply: found a directory, expected a file to write");
    EXPECT_EQ(failure("a.stl"), "a.stl: found extension .stl, expected .obj, .ovc, .ply");
    EXPECT_EQ(failure("a.ply.gz"), "a.ply.gz: found extension .gz, expected .obj, .ovc, .ply");
    EXPECT_EQ(failure("a"), "a: found no extension, expected .obj, .ovc, .ply");
}

TEST(Save, AFailedWriteLeavesTheOldFileAndNothingElse) {
    const TestFolder folder;
    folder.write("kept.obj", kObj);
    std::vector<vec3> corners(300000, vec3(0.5f));
    for (size_t i = 0; i < corners.size(); ++i)
        corners[i].x = float(i);
    Scene scene;
    scene.materials.emplace_back();
    scene.add_mesh("large", 0, Chunk::owning(dvec3(0), std::move(corners)));
    const auto done = [&] {
        const test::FileSizeLimit limit(1 << 20);
        return save(scene, folder / "kept.obj");
    }();
    ASSERT_FALSE(done);
    EXPECT_EQ(folder.plain(done.error().message), "kept.obj: cannot be written: File too large");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()), 1);
    EXPECT_EQ(folder.read("kept.obj"), kObj);
}

/// Returns a glTF file of one triangle whose material is the JSON object `material`.
std::string gltf_with(const std::string& material) {
    return R"({"asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_transmission", "KHR_materials_ior"],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "materials": [)" +
           material + R"(],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})";
}

TEST(Assimp, GlassLetsLightThrough) {
    const TestFolder folder;
    const auto material = [&](const std::string& json) {
        const auto scene = load(folder.write("a.gltf", gltf_with(json)));
        EXPECT_TRUE(scene) << scene.error().message;
        return scene->materials[scene->meshes[0].material];
    };
    const std::string green = R"("pbrMetallicRoughness": {"baseColorFactor": [0.25, 1, 0.5, 1]})";
    const Material glass = material("{" + green + R"(, "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 0.75}}})");
    EXPECT_EQ(glass.transmission, 0.75f);
    EXPECT_EQ(glass.filter, vec3(0.25f, 1, 0.5f));
    EXPECT_EQ(material("{" + green + "}").transmission, 0);
    const Material veil = material(R"({"alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [0.25, 1, 0.5, 0.25]}})");
    EXPECT_EQ(veil.transmission, 0.75f);
    EXPECT_EQ(veil.filter, vec3(1));
    EXPECT_EQ(veil.ior, 1);
}

TEST(Assimp, TheFirstCameraIsTheScenes) {
    const TestFolder folder;
    std::string file = gltf_with("{}");
    const auto replace = [&](const std::string& what, const std::string& with) {
        file.replace(file.find(what), what.size(), with);
    };
    // Turned by a quarter about y, the camera looks along -x; its parent moves it.
    replace(R"("nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}])",
            R"("cameras": [{"type": "orthographic",
                            "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9}},
                           {"type": "perspective",
                            "perspective": {"yfov": 0.5, "aspectRatio": 2, "znear": 0.1}}],
               "nodes": [{"mesh": 0}, {"camera": 0},
                         {"children": [3], "translation": [1, 2, 3], "scale": [2, 2, 2]},
                         {"camera": 1, "translation": [0, 0, 1],
                          "rotation": [0, 0.70710678, 0, 0.70710678]}],
               "scenes": [{"nodes": [0, 1, 2]}])");
    std::vector<std::string> warnings;
    const auto scene = load(folder.write("a.gltf", file), gather(warnings));
    ASSERT_TRUE(scene && scene->camera);
    const Camera& camera = *scene->camera;
    EXPECT_EQ(camera.eye, dvec3(1, 2, 5));
    const dvec3 view = glm::normalize(camera.target - camera.eye);
    EXPECT_LT(glm::distance(view, dvec3(-1, 0, 0)), 1e-6);
    EXPECT_LT(glm::distance(glm::normalize(camera.up), dvec3(0, 1, 0)), 1e-6);
    EXPECT_NEAR(camera.fov_degrees, 0.5 * 180 / std::numbers::pi, 1e-5);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]), "a.gltf: 1 more camera left out");
}

TEST(Assimp, WhatIsLeftOutIsSaid) {
    const TestFolder folder;
    std::string file = gltf_with(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                                     "occlusionTexture": {"index": 1}},
                                    {"emissiveTexture": {"index": 0}})");
    const std::string nodes = R"("nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}])";
    file.replace(file.find(nodes), nodes.size(), R"(
        "images": [{"uri": "wood.png"}, {"uri": "bumps.png"}],
        "textures": [{"source": 0}, {"source": 1}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                        "samplers": [{"input": 1, "output": 0}]}],
        "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "scenes": [{"nodes": [0, 1]}])");
    const std::string materials = R"(}],
        "materials")";
    file.replace(file.find(materials), 1, R"(}, {"bufferView": 0, "componentType": 5126, "count": 3,
                                               "type": "SCALAR"})");
    const std::string used = R"("extensionsUsed": [)";
    file.insert(file.find(used) + used.size(), R"("KHR_lights_punctual", )");
    std::vector<std::string> warnings;
    const auto scene = load(folder.write("a.gltf", file), gather(warnings));
    EXPECT_EQ(triangles_of(scene), kOne);
    for (std::string& warning : warnings)
        warning = folder.plain(warning);
    EXPECT_EQ(warnings, (std::vector<std::string>{
                            "a.gltf: 1 texture left out: 'bumps.png'",
                            "a.gltf: 1 animation left out: what moves is shown at rest"}));
}

/// Returns a COLLADA file of a triangle, whose materials have these elements.
std::string collada_of(const std::vector<std::string>& materials) {
    std::string effects, names, triangles, bindings;
    for (size_t i = 0; i < materials.size(); ++i) {
        const std::string n = std::to_string(i);
        effects += "<effect id=\"e" + n + "\"><profile_COMMON><technique sid=\"c\"><lambert>" +
                   materials[i] + "</lambert></technique></profile_COMMON></effect>";
        names += "<material id=\"m" + n + "\"><instance_effect url=\"#e" + n + "\"/></material>";
        triangles += "<triangles count=\"1\" material=\"s" + n +
                     "\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>"
                     "</triangles>";
        bindings += "<instance_material symbol=\"s" + n + "\" target=\"#m" + n + "\"/>";
    }
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/"
           "COLLADASchema\" version=\"1.4.1\"><asset><up_axis>Y_UP</up_axis></asset>"
           "<library_effects>" +
           effects + "</library_effects><library_materials>" + names +
           "</library_materials><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
           "<float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common>"
           "<accessor source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
           "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
           "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
           "source=\"#p\"/></vertices>" +
           triangles +
           "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">"
           "<node id=\"n\"><instance_geometry url=\"#g\"><bind_material><technique_common>" +
           bindings +
           "</technique_common></bind_material></instance_geometry></node></visual_scene>"
           "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

TEST(Assimp, ColladasTransparencyIsReadBothWays) {
    const TestFolder folder;
    const auto passes = [&](const std::vector<std::string>& numbers) {
        std::vector<std::string> materials;
        for (const std::string& number : numbers)
            materials.push_back("<transparent><color>1 1 1 1</color></transparent><transparency>"
                                "<float>" +
                                number + "</float></transparency>");
        const auto scene = load(folder.write("a.dae", collada_of(materials)));
        EXPECT_TRUE(scene) << scene.error().message;
        std::vector<float> shares;
        for (const MeshInfo& mesh : scene->meshes)
            shares.push_back(scene->materials[mesh.material].transmission);
        return shares;
    };
    EXPECT_EQ(passes({"1", "0.25"}), (std::vector<float>{0, 0.75f}));
    EXPECT_EQ(passes({"0", "0.25"}), (std::vector<float>{0, 0.25f}))
        << "a file does not mean what nobody sees";
}

TEST(Assimp, OtherFormatsThanGltfSendOutLight) {
    const TestFolder folder;
    const auto scene = load(folder.write(
        "a.dae", collada_of({"<emission><color>0.5 2 0 1</color></emission><diffuse><color>1 0 0 1"
                             "</color></diffuse>",
                             "<diffuse><color>1 0 0 1</color></diffuse>"})));
    ASSERT_TRUE(scene) << scene.error().message;
    const auto& optics = scene->materials[scene->meshes.at(0).material].optics;
    ASSERT_TRUE(optics);
    EXPECT_EQ(optics->emission, vec3(0.5f, 2, 0));
    EXPECT_EQ(optics->diffuse, vec3(1, 0, 0));
    EXPECT_FALSE(scene->materials[scene->meshes.at(1).material].optics);
}

TEST(Assimp, SkinsOfOtherFormatsThanGltfAreSaid) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene = load(
        folder.write("a.x", "xof 0303txt 0032\nFrame Root { Mesh m { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; "
                            "3;0,1,2;; SkinWeights { \"Root\"; 3; 0,1,2; 1.0,1.0,1.0; 1.0,0.0,0.0,"
                            "0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; } } }\n"),
        gather(warnings));
    EXPECT_EQ(triangles_of(scene).size(), 1u);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]),
              "a.x: 1 skin left out: meshes are shown in their rest form");
}

TEST(Assimp, AgreesOnPlyAndObj) {
    const TestFolder folder;
    folder.write(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n");
    const auto ours = load(folder / "a.obj");
    ASSERT_TRUE(save(*ours, folder / "a.ply"));
    EXPECT_EQ(triangles_of(read_assimp(folder / "a.obj", {})), triangles_of(ours));
    EXPECT_EQ(triangles_of(read_assimp(folder / "a.ply", {})), triangles_of(ours));
}

} // namespace
} // namespace ovc
