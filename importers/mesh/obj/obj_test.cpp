// SPDX-License-Identifier: Apache-2.0
// The readers of OBJ and MTL: statements, meshes, materials, errors by their text, damage.
#include "importers/test_files.h"

#include <sys/stat.h>

namespace ovc {
namespace {

constexpr const char* kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n";

const dvec3 kA(0, 0, 0), kB(1, 0, 0), kC(1, 1, 0), kD(0, 1, 0.5);
const std::vector<Triangle> kSquare = {{kA, kB, kC}, {kA, kC, kD}};

TEST(Obj, CornersAreReadInEveryForm) {
    const TestFolder folder;
    const std::string corners = kCorners;
    const std::string more = corners + "vt 0 0\nvn 0 0 1\n";
    const struct {
        const char* name;
        std::string contents;
    } cases[] = {
        {"plain", corners + "f 1 2 3\nf 1 3 4\n"},
        {"quad", corners + "f 1 2 3 4\n"},
        {"no line end", corners + "f 1 2 3 4"},
        {"negative", corners + "f -4 -3 -2 -1\nv 7 7 7\n"},
        {"texture", more + "f 1/1 2/1 3/1 4/1\n"},
        {"normal", more + "f 1//1 2//1 3//1 4//1\n"},
        {"all", more + "f 1/1/1 2/1/1 3/1/1 4/1/1\n"},
        {"mixed", more + "f 1 2/1 3//1 4/1/-1\n"},
        {"texture out of range", corners + "f 1/9 2/9 3/9 4/9\n"},
        {"tabs and blanks", "v\t0 0  0 \nv 1 0 0\t\n  v 1 1 0\nv 0 1 .5e+0\nf \t1  2 3 4  # end\n"},
        {"CRLF", "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0.5\r\nf 1 2 3 4\r\n"},
        {"CR", "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0.5\rf 1 2 3 4\r"},
        {"continued", "v 0 0 \\\n 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2\\\n3 \\\n4\n"},
        {"continued at the end", corners + "f 1 2 3 4\\"},
        {"weights and colors", "v 0 0 0 1\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0.5 2\nf 1 2 3 4\n"},
        {"byte order mark", "\xef\xbb\xbf" + corners + "f 1 2 3 4\n"},
        {"a NUL at the end", corners + "f 1 2 3 4\n" + std::string(1, '\0')},
        {"NULs at the end of the last line", corners + "f 1 2 3 4" + std::string(5000, '\0')},
        {"Ctrl-Z", corners + "f 1 2 3 4\n\x1a"},
        {"Ctrl-Z in a line", corners + "f 1 2 3 4\r\n\x1a\r\n" + std::string(2, '\0')},
        {"comments and smoothing", "# x\n\n" + corners + "s 1\ns off\nf 1 2 3 4\n#"},
    };
    for (const auto& test : cases) {
        SCOPED_TRACE(test.name);
        std::vector<std::string> warnings;
        EXPECT_EQ(triangles_of(load(folder.write("a.obj", test.contents), gather(warnings))),
                  kSquare);
        const bool is_reduced = test.contents.find("vn") != test.contents.npos ||
                                std::string_view(test.name) == "weights and colors";
        EXPECT_TRUE(warnings.empty() || is_reduced) << warnings[0];
    }
}

TEST(Obj, ConcaveFacesAreCutWithoutOverlap) {
    const TestFolder folder;
    const auto triangles = triangles_of(
        load(folder.write("arrow.obj", "v 0 3 0\nv -2 -1 0\nv 0 0 0\nv 2 -1 0\nf 1 2 3 4\n")));
    ASSERT_EQ(triangles.size(), 2u);
    for (const Triangle& t : triangles)
        EXPECT_GT(glm::cross(t[1] - t[0], t[2] - t[0]).z, 0);
}

TEST(Obj, OneMeshForEachObjectGroupAndMaterial) {
    const TestFolder folder;
    folder.write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    const auto scene = load(folder.write(
        "meshes.obj",
        std::string("mtllib two.mtl\n") + kCorners +
            "f 1 2 3\no box\nusemtl red\nf 1 2 3\ng lid\nf 1 2 4\nusemtl blue\nf 1 3 4\n"
            "usemtl red\nf 2 3 4\no other box\nf 1 2 3\n"));
    ASSERT_TRUE(scene);
    const struct {
        const char* name;
        const char* material;
        uint32_t triangles;
    } expected[] = {{"meshes", "", 1},
                    {"box", "red", 1},
                    {"box/lid", "red", 2},
                    {"box/lid", "blue", 1},
                    {"other box", "red", 1}};
    ASSERT_EQ(scene->meshes.size(), std::size(expected));
    for (size_t m = 0; m < std::size(expected); ++m) {
        EXPECT_EQ(scene->meshes[m].name, expected[m].name);
        EXPECT_EQ(scene->materials[scene->meshes[m].material].name, expected[m].material);
        EXPECT_EQ(scene->soup.chunks[m].size(), expected[m].triangles);
    }
    EXPECT_EQ(scene->soup.triangle({2, 1})[0], kB) << "in file order";
}

TEST(Obj, CommentsStandBehindAnyStatement) {
    const TestFolder folder;
    folder.write("c.mtl", "newmtl red # paint\nKd 1 0 0 # all red\nKa 1 # \nnewmtl grey#1 #x\n"
                          "Kd 0.25 # one number\nnewmtl Material #25\nKd 0 0 1\n"
                          "newmtl a # b\nKd 0 1 0\n");
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("c.obj", "# c\nmtllib c.mtl # paints\nv 0 0 0 # a\nv 1 0 0 #b\n"
                                   "v 1 1 0\t# c\nv 0 1 0.5\n"
                                   "o box # a box\nusemtl red # paint\nf 1 2 3 # f\n"
                                   "g lid\t#x\nusemtl grey#1 # again\nf 1 2 3\n"
                                   "o part #3\nusemtl Material #25\nf 1 2 3\n"
                                   "g part #4 # four\nusemtl a #\ns 0 # flat\nf 1 2 3\n"),
             gather(warnings));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_TRUE(warnings.empty()) << folder.plain(warnings[0]);
    const struct {
        const char* mesh;
        const char* material;
        vec3 color;
    } expected[] = {{"box", "red", {1, 0, 0}},
                    {"box/lid", "grey#1", vec3(0.25f)},
                    {"part #3", "Material #25", {0, 0, 1}},
                    {"part #3/part #4", "a", {0, 1, 0}}};
    ASSERT_EQ(scene->meshes.size(), std::size(expected));
    for (size_t m = 0; m < std::size(expected); ++m) {
        const Material& material = scene->materials[scene->meshes[m].material];
        EXPECT_EQ(scene->meshes[m].name, expected[m].mesh);
        EXPECT_EQ(material.name, expected[m].material);
        EXPECT_EQ(material.color, expected[m].color);
    }
}

TEST(Obj, MaterialsTakeColorAndMirror) {
    const TestFolder folder;
    folder.write(
        "all kinds.mtl",
        "Kd 9 9 9\nnewmtl matt\n\tKd 0.25 0.5 2\nKs 1 1 1\nillum 2\nnewmtl mirror\nKs 0.2 0.4 0.6\n"
        "illum 3\nnewmtl grey\nKd 0.5\nKs 0 0 0\nillum 5\nnewmtl shadow\nKs 1 1 1\nillum "
        "10\n");
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("m.obj",
                          std::string(kCorners) + "usemtl matt\nf 1 2 3\nmtllib all kinds.mtl\n"),
             gather(warnings));
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 5u);
    EXPECT_EQ(scene->materials[1], (Material{"matt", {0.25f, 0.5f, 1}, 0}));
    EXPECT_EQ(scene->materials[2].name, "mirror");
    EXPECT_EQ(scene->materials[2].color, Material{}.color);
    EXPECT_NEAR(scene->materials[2].mirror, 0.4f, 1e-6f);
    EXPECT_EQ(scene->materials[3], (Material{"grey", vec3(0.5f), 0}));
    EXPECT_EQ(scene->materials[4].mirror, 0);
    EXPECT_EQ(scene->meshes[0].material, 1u);
}

TEST(Obj, WhatALibraryAsksForInVainIsSaidOrRefused) {
    const TestFolder folder;
    const std::string obj = std::string("mtllib m.mtl\n") + kCorners + "usemtl a\nf 1 2 3\n";
    const auto read = [&](const std::string& statements, std::vector<std::string>& warnings) {
        folder.write("m.mtl", "newmtl a\n" + statements);
        const auto scene = load(folder.write("a.obj", obj), gather(warnings));
        for (std::string& warning : warnings)
            warning = folder.plain(warning);
        return scene ? "" : folder.plain(scene.error().message);
    };
    std::vector<std::string> warnings;
    EXPECT_EQ(read("Ka 1\nNs 9\nFoo 1\nFoo 2\nKs spectral a.rfl\nd -halo 0.5\n", warnings), "");
    EXPECT_EQ(warnings, (std::vector<std::string>{
                            "m.mtl, line 4: statements 'Foo' left out",
                            "m.mtl, line 6: colors 'spectral' left out",
                            "m.mtl, line 7: the option '-halo' left out",
                        }));
    EXPECT_EQ(read("Kd a b c\n", warnings), "m.mtl, line 2: found 'a', expected a number of Kd");
    EXPECT_EQ(read("Kd 1 1\n", warnings),
              "m.mtl, line 2: found the end of the line, expected a number of Kd");
    EXPECT_EQ(read("d nan\n", warnings), "m.mtl, line 2: found 'nan', expected a number of d");
    EXPECT_EQ(read("illum x\n", warnings), "m.mtl, line 2: found 'x', expected a number of illum");
}

TEST(Obj, VertexColorsAreSaidOnce) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("a.obj", "v 0 0 0 1\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"),
             gather(warnings));
    ASSERT_TRUE(scene);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]), "a.obj, line 2: vertex colors left out");
}

TEST(Obj, TexturesAndLightOfMaterialsInUseAreSaidOnce) {
    const TestFolder folder;
    folder.write(
        "m.mtl",
        "newmtl a\nKd 1 0 0\nmap_Kd wood floor.png\nmap_aat on\nKe 0 0 0\n"
        "newmtl b\nmap_Kd wood floor.png\ndisp -bm 0.5 bumps.png\n"
        "Ke 4 4 2\nKs 0.5\nd 0.5\nillum 4\nnewmtl c\nrefl -type sphere sky.png\nmap_d leaf.png\n"
        "norm n.png\nnewmtl unused\nmap_Kd unused.png\nKe 1\n");
    folder.write("plain.mtl", "newmtl d\nKd 1 1 1\n");
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("a.obj", std::string("mtllib m.mtl\nmtllib m.mtl\n") +
                                       "mtllib plain.mtl\n" + kCorners +
                                       "usemtl c\nf 1 2 3 4\nusemtl a\nf 1 2 3\nusemtl "
                                       "b\nf 1 2 3\n"),
             gather(warnings));
    EXPECT_EQ(triangles_of(scene).size(), 4u);
    for (std::string& warning : warnings)
        warning = folder.plain(warning);
    EXPECT_EQ(warnings,
              (std::vector<std::string>{"a.obj: 2 textures of its materials left out: disp "
                                        "'bumps.png', refl 'sky.png'",
                                        "a.obj: light from 1 material (Ke) left out: 'b'"}));
}

/// Returns the material that an MTL file with these statements gives.
Material mtl_material(const std::string& statements) {
    const TestFolder folder;
    folder.write("g.mtl", "newmtl glass\n" + statements);
    const auto scene = load(folder.write("g.obj", std::string("mtllib g.mtl\n") + kCorners +
                                                      "usemtl glass\nf 1 2 3\n"));
    EXPECT_TRUE(scene);
    return scene->materials[scene->meshes[0].material];
}

TEST(Obj, GlassLetsThroughWhatItDoesNotMirror) {
    struct {
        const char* statements;
        float mirror, transmission;
        vec3 filter;
        double ior;
    } const kCases[] = {
        {"illum 6\nNi 1.5", 0, 1, vec3(1), 1.5},
        {"illum 7\nNi 1.000000000001\nKs 0.25\nTf 1 0.5 0.25\n",
         0.25f,
         0.75f,
         {1, 0.5f, 0.25f},
         1.000000000001},
        {"illum 7\nNi 1.5\nd 1\nTf 1 1 1\n", 0, 1, vec3(1), 1.5},
        {"illum 7\nNi 1.5\nd 1\n", 0, 0, vec3(1), 1.5},
        {"illum 6\nd 0.25\nTr 1\nTf 0.5\n", 0, 0.75f, vec3(0.5f), 1},
        {"illum 6\nTr 0.25\n", 0, 0.25f, vec3(1), 1},
        {"illum 4\nNi 1.5\nKs 0.5\nd 0.5\n", 0.5f, 0.25f, vec3(1), 1},
        {"illum 9\nNi 1.5\nKs 0.5\nd 0.5\n", 0, 0.5f, vec3(1), 1},
        {"illum 6\nd -3\nNi 0\n", 0, 1, vec3(1), 1},
        // 3ds Max writes this for an opaque material.
        {"illum 2\nNi 1.5\nd 1\nTr 1\nTf 1 1 1\n", 0, 0, vec3(1), 1},
        // The format dissolves surfaces in all models.
        {"illum 3\nKs 0.5\nd 0.5\nNi 1.5\n", 0.5f, 0.25f, vec3(1), 1},
        {"d 0.25\n", 0, 0.75f, vec3(1), 1},
        {"illum 2\nTr 0.25\nNi 1.5\nTf 0.5\n", 0, 0.25f, vec3(1), 1},
        {"illum 2\nTr 1\n", 0, 0, vec3(1), 1},
    };
    for (const auto& expected : kCases) {
        const Material found = mtl_material(expected.statements);
        EXPECT_EQ(found.mirror, expected.mirror) << expected.statements;
        EXPECT_EQ(found.transmission, expected.transmission) << expected.statements;
        EXPECT_EQ(found.filter, expected.filter) << expected.statements;
        EXPECT_EQ(found.ior, expected.ior) << expected.statements;
    }
}

TEST(Obj, SmoothingAndTurbulenceAreSaid) {
    const TestFolder folder;
    folder.write("m.mtl", "newmtl a\nmap_Kd -t 1 1 a.png\nnewmtl b\n");
    std::vector<std::string> warnings;
    const auto read = [&](const std::string& text) {
        warnings.clear();
        EXPECT_TRUE(load(folder.write("a.obj", kCorners + text), gather(warnings)));
        for (std::string& warning : warnings)
            warning = folder.plain(warning);
        return warnings;
    };
    EXPECT_TRUE(read("s off\nf 1 2 3\ns 0\nf 1 2 3\nvn 0 0 1\ns 1\nf 1//1 2//1 3//1\n").empty());
    EXPECT_EQ(read("s 1\nf 1 2 3\n"),
              (std::vector<std::string>{
                  "a.obj, line 6: smoothing groups left out: faces without normals are flat"}));
    EXPECT_EQ(read("usemtl a\nmtllib m.mtl\nf 1 2 3\nusemtl b\nf 1 2 3\n"),
              (std::vector<std::string>{"m.mtl, line 2: the option '-t' left out"}))
        << "a library may come behind its materials";
}

TEST(Obj, LibrariesAreFoundUnderEveryKindOfName) {
    const TestFolder folder;
    std::filesystem::create_directories(folder / "sub");
    for (const char* name : {"a b.mtl", "c.mtl", "sub/d.mtl"})
        folder.write(name, "newmtl red\nKd 1 0 0\n");
    for (const char* statement : {"a b.mtl", "missing.mtl c.mtl", "missing.mtl a\\ b.mtl",
                                  "sub/d.mtl", "sub\\d.mtl", ".\\sub\\d.mtl  "}) {
        std::vector<std::string> warnings;
        const auto scene = load(folder.write("a.obj", std::string("mtllib ") + statement + "\n" +
                                                          kCorners + "usemtl red\nf 1 2 3\n"),
                                gather(warnings));
        ASSERT_TRUE(scene);
        EXPECT_EQ(scene->materials[scene->meshes[0].material].color, vec3(1, 0, 0)) << statement;
        EXPECT_TRUE(warnings.empty()) << warnings[0];
    }
}

TEST(Obj, LibrariesThatAreNoRegularFilesAreMissing) {
    const TestFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe.mtl").c_str(), 0600), 0);
    std::filesystem::create_directories(folder / "folder.mtl");
    std::filesystem::create_symlink("/dev/zero", folder / "zero.mtl");
    for (const std::string name : {"/dev/zero", "zero.mtl", "pipe.mtl", "folder.mtl", "."}) {
        std::vector<std::string> warnings;
        const auto scene =
            load(folder.write("a.obj", "mtllib " + name + "\n" + kCorners + "f 1 2 3 4\n"),
                 gather(warnings));
        EXPECT_EQ(triangles_of(scene), kSquare) << name;
        ASSERT_EQ(warnings.size(), 1u) << name;
        EXPECT_EQ(folder.plain(warnings[0]),
                  "a.obj, line 1: no material library '" + name + "': its materials become grey");
    }
}

TEST(Obj, NormalsAreReadPerMeshWhereAllCanBeUsed) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("n.obj", std::string(kCorners) +
                                       "vn 0 0 2\nvn 1 0 0\nvn 0 0 0\ng all\nf 1//1 2//2 3//-3\n"
                                       "g some\nf 1//1 2//1 3\ng zero\nf 1//1 2//1 3//3\n"
                                       "g wrong\nf 1//1 2//1 3//4\ng none\nf 1 2 3\n"),
             gather(warnings));
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->meshes.size(), 5u);
    EXPECT_EQ(scene->meshes[0].normals, (std::vector<vec3>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}}));
    for (size_t m = 1; m < 5; ++m)
        EXPECT_TRUE(scene->meshes[m].normals.empty()) << m;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]), "n.obj, line 11: normals left out where a corner of the "
                                         "mesh has none that can be used");
}

TEST(Obj, CoordinatesFarFromTheOriginKeepTheirPrecision) {
    const TestFolder folder;
    const auto scene =
        load(folder.write("far.obj", "v 500000.125 4100000.0625 10\nv 500001.125 4100000.0625 10\n"
                                     "v 500000.125 4100001.0625 10.5\nf 1 2 3\n"));
    EXPECT_EQ(triangles_of(scene)[0],
              (Triangle{dvec3(500000.125, 4100000.0625, 10), dvec3(500001.125, 4100000.0625, 10),
                        dvec3(500000.125, 4100001.0625, 10.5)}));
}

TEST(Obj, NonFiniteVerticesAreKept) {
    const TestFolder folder;
    const auto triangles = triangles_of(
        load(folder.write("nan.obj", "v nan -nan inf\nv -1.#IND 1.#QNAN0 -1.#INF\nf 1 2 1\n")));
    ASSERT_EQ(triangles.size(), 1u);
    EXPECT_TRUE(std::isnan(triangles[0][0].y) && std::isnan(triangles[0][1].x));
    EXPECT_TRUE(triangles[0][0].z > 0 && std::isinf(triangles[0][0].z));
    EXPECT_TRUE(triangles[0][1].z < 0 && std::isinf(triangles[0][1].z));
}

TEST(Obj, WhatIsLeftOutIsSaidOncePerKind) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("left.obj", std::string(kCorners) +
                                          "l 1 2\nl 2 3\np 1\nf 1 2\nf\nusemtl missing\n"
                                          "mtllib gone.mtl\nusemtl also\nf 1 2 3\n"),
             gather(warnings));
    EXPECT_EQ(triangles_of(scene).size(), 1u);
    for (std::string& warning : warnings)
        warning = folder.plain(warning);
    EXPECT_EQ(warnings,
              (std::vector<std::string>{
                  "left.obj, line 5: statements 'l' left out",
                  "left.obj, line 7: statements 'p' left out",
                  "left.obj, line 8: faces with fewer than three corners left out",
                  "left.obj, line 11: no material library 'gone.mtl': its materials become grey",
                  "left.obj, line 10: no material 'missing': it becomes grey, and so do others "
                  "that are missing"}));
}

TEST(Obj, ErrorsNameThePlaceAndWhatWasExpected) {
    const std::string corners = kCorners;
    const struct {
        const char* name;
        std::string contents;
        const char* message;
    } invalid[] = {
        {"empty", "", "bad.obj: the file is empty, expected a model"},
        {"word", "v 0 x 0\n", "bad.obj, line 1: found 'x', expected a coordinate"},
        {"two coordinates", "v 0 0\n",
         "bad.obj, line 1: found the end of the line, expected a coordinate"},
        {"no coordinate", "v", "bad.obj, line 1: found the end of the line, expected a coordinate"},
        {"short normal", "vn 0 0 \n",
         "bad.obj, line 1: found the end of the line, expected a coordinate"},
        {"no vertices", "f 1 2 3\n",
         "bad.obj, line 1: found vertex 1, expected none, for none is above this line"},
        {"one vertex", "v 0 0 0\nf 1 2 3\n",
         "bad.obj, line 2: found vertex 2, expected the one above this line"},
        {"normal", "vn 0 0 up\n", "bad.obj, line 1: found 'up', expected a coordinate"},
        {"index too large", corners + "f 1 2 5\n",
         "bad.obj, line 5: found vertex 5, expected one of the 4 above this line"},
        {"index too small", corners + "f 1 2 -5\n",
         "bad.obj, line 5: found vertex -5, expected one of the 4 above this line"},
        {"zero", corners + "f 0 1 2\n",
         "bad.obj, line 5: found vertex 0, expected one of the 4 above this line"},
        {"largest", corners + "f 1 2 -9223372036854775808\n",
         "bad.obj, line 5: found vertex -9223372036854775808, expected one of the 4 above this "
         "line"},
        {"corner", corners + "f 1 2 3x\n",
         "bad.obj, line 5: found corner '3x', expected v, v/vt, v//vn or v/vt/vn"},
        {"no vertex", corners + "f 1 2 /1/1\n",
         "bad.obj, line 5: found corner '/1/1', expected v, v/vt, v//vn or v/vt/vn"},
        {"normal index", corners + "f 1 2 3//n\n",
         "bad.obj, line 5: found corner '3//n', expected v, v/vt, v//vn or v/vt/vn"},
        {"continued line", "v 0 0 \\\n0\nv 0 \\\n y 0\n",
         "bad.obj, line 4: found 'y', expected a coordinate"},
        {"UTF-16",
         std::string("\xff\xfe"
                     "v\0",
                     4),
         "bad.obj, line 1: found UTF-16 text, expected ASCII or UTF-8"},
        {"binary", std::string("\x89PNG\r\n\x1a\n"),
         "bad.obj, line 1: found '\\x89PNG', expected v, vn, vt, f, o, g, usemtl, mtllib or "
         "another "
         "statement of the OBJ format"},
    };
    const TestFolder folder;
    for (const auto& test : invalid) {
        folder.write("bad.obj", test.contents);
        EXPECT_EQ(folder.failure("bad.obj"), test.message) << test.name;
    }
}

TEST(Obj, SurvivesTruncationAndFlippedBits) {
    const TestFolder folder;
    folder.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    folder.write("small.obj",
                 std::string("mtllib m.mtl\no a\n") + kCorners +
                     "vn 0 0 1\nusemtl red\nf 1//1 2//1 3//1 4//1\nf -1 -2 \\\n-3\nl 1 2\n");
    survive_damage(folder, "small.obj");
}

} // namespace
} // namespace ovc
