// SPDX-License-Identifier: Apache-2.0
// The reader of PBRT: words, files, state, objects; errors and warnings by their text.
#include "importers/test_files.h"

namespace ovc {
namespace {

constexpr const char* kTriangle =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  1 0 0  0 1 0]\n";

const Triangle kFlatTriangle{dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)};

Triangle moved(const dvec3& by) {
    return {kFlatTriangle[0] + by, kFlatTriangle[1] + by, kFlatTriangle[2] + by};
}

/// Appends, because GCC 12 warns of sums of strings.
std::string numbered(const char* before, int number, const char* after) {
    return std::string(before).append(std::to_string(number)).append(after);
}

struct Reading {
    Result<Scene> scene;
    std::vector<std::string> warnings;
};

Reading read(const TestFolder& folder, const std::string& text, bool strict = false) {
    std::vector<std::string> warnings;
    ImportOptions options = gather(warnings);
    options.strict = strict;
    Result<Scene> scene = load(folder.write("a.pbrt", text), options);
    for (std::string& warning : warnings)
        warning = folder.plain(warning);
    return {std::move(scene), std::move(warnings)};
}

std::vector<Triangle> triangles(const TestFolder& folder, const std::string& text) {
    return triangles_of(read(folder, text).scene);
}

std::string failure(const TestFolder& folder, const std::string& text, bool strict = false) {
    const Reading reading = read(folder, text, strict);
    return reading.scene ? "none" : folder.plain(reading.scene.error().message);
}

TEST(Pbrt, AMeshIsReadInTheWordsOfEveryVersion) {
    const TestFolder folder;
    const struct {
        const char* name;
        std::string text;
    } cases[] = {
        {"v1", std::string("WorldBegin\n") + kTriangle + "WorldEnd\n"},
        {"v4", "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]"},
        {"no world", kTriangle},
        {"comments",
         "# x\nShape # y [\n\"trianglemesh\" \"integer indices\" [0 # 1\n1 2]#\n\"point "
         "P\" [0 0 0 1 0 0 0 1 0] # end"},
        {"CRLF",
         "Shape \"trianglemesh\"\r\n\"integer indices\" [0 1 2]\r\n\"point P\" [0 0 0 1 0 0 "
         "0 1 0]\r\n"},
        {"tight", "Shape\"trianglemesh\"\"integer indices\"[0 1 2]\"point P\"[0 0 0 1 0 0 0 1 0]"},
        {"numbers",
         "Shape \"trianglemesh\" \"integer indices\" [0 +1 2] \"point P\" [-0 0. .0 1e0 0 "
         "0 0 10e-1 0]"},
        {"last wins", "Shape \"trianglemesh\" \"integer indices\" [2 1 0] \"integer indices\" [0 1 "
                      "2] \"point P\" [0 0 0 1 0 0 0 1 0]"},
        {"byte order mark", std::string("\xef\xbb\xbf") + kTriangle},
    };
    for (const auto& test : cases) {
        const Reading reading = read(folder, test.text);
        EXPECT_EQ(triangles_of(reading.scene), std::vector<Triangle>{kFlatTriangle}) << test.name;
        EXPECT_TRUE(reading.warnings.empty()) << test.name << reading.warnings[0];
    }
    EXPECT_EQ(triangles_of(load(folder.write("b.pbrt.gz", gzip(kTriangle)))),
              std::vector<Triangle>{kFlatTriangle});
}

TEST(Pbrt, TransformsComposeAsPbrtDoes) {
    const TestFolder folder;
    const struct {
        const char* text;
        dvec3 origin; // the image of (0,0,0)
        dvec3 x;      // the image of (1,0,0)
    } cases[] = {
        {"Translate 1 2 3", {1, 2, 3}, {2, 2, 3}},
        {"Translate 1 2 3 Scale 2 1 1", {1, 2, 3}, {3, 2, 3}},
        {"Scale 2 2 2 Translate 1 2 3", {2, 4, 6}, {4, 4, 6}},
        {"Rotate 90 0 0 1", {0, 0, 0}, {0, 1, 0}},
        {"Rotate -90 0 2 0", {0, 0, 0}, {0, 0, 1}},
        {"Rotate 0 0 1 0.237271", {0, 0, 0}, {1, 0, 0}},
        {"Transform [1 0 0 0  0 1 0 0  0 0 1 0  5 6 7 1]", {5, 6, 7}, {6, 6, 7}},
        {"Translate 9 9 9 Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]", {5, 6, 7}, {6, 6, 7}},
        {"Translate 1 0 0 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]", {6, 6, 7}, {7, 6, 7}},
        {"Translate 9 9 9 Identity", {0, 0, 0}, {1, 0, 0}},
        {"LookAt 0 0 -5  0 0 0  0 1 0", {0, 0, 5}, {1, 0, 5}},
        {"AttributeBegin Translate 9 9 9 AttributeEnd Translate 1 0 0", {1, 0, 0}, {2, 0, 0}},
        {"TransformBegin Translate 9 9 9 TransformEnd", {0, 0, 0}, {1, 0, 0}},
        {"Translate 1 0 0 CoordinateSystem \"a\" Translate 9 9 9 CoordSysTransform \"a\"",
         {1, 0, 0},
         {2, 0, 0}},
        {"LookAt 1 2 3  1 2 9  0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform "
         "\"camera\"",
         {1, 2, 3},
         {2, 2, 3}},
        {"Translate 9 9 9 WorldBegin", {0, 0, 0}, {1, 0, 0}},
        {"ActiveTransform StartTime Translate 1 0 0 ActiveTransform All", {1, 0, 0}, {2, 0, 0}},
        {"ActiveTransform EndTime Translate 9 9 9 ActiveTransform All", {0, 0, 0}, {1, 0, 0}},
    };
    for (const auto& test : cases) {
        const auto found = triangles(folder, test.text + std::string("\n") + kTriangle);
        ASSERT_EQ(found.size(), 1u) << test.text;
        EXPECT_LT(glm::length(found[0][0] - test.origin), 1e-12) << test.text;
        EXPECT_LT(glm::length(found[0][1] - test.x), 1e-12) << test.text;
    }
}

TEST(Pbrt, MirrorsAndReverseOrientationTurnTrianglesRound) {
    const TestFolder folder;
    const auto outwards = [&](const std::string& text) {
        const auto t = triangles(folder, text + kTriangle);
        return t.size() == 1 ? glm::cross(t[0][1] - t[0][0], t[0][2] - t[0][0]).z : 0;
    };
    EXPECT_GT(outwards(""), 0);
    EXPECT_LT(outwards("ReverseOrientation "), 0);
    EXPECT_GT(outwards("Scale -1 1 1 "), 0);
    EXPECT_LT(outwards("Scale -1 1 1 ReverseOrientation "), 0);
    EXPECT_GT(outwards("ReverseOrientation ReverseOrientation "), 0);
}

TEST(Pbrt, FilesIncludeFilesAnywhere) {
    const TestFolder folder;
    folder.write("points.pbrt", "\"point P\" [0 0 0 1 0 0 0 1 0]");
    folder.write("numbers.pbrt", "0 0 0 1 0 0 0 1 0");
    folder.write("begin.pbrt", "Shape \"trianglemesh\" \"integer indices\" [0 1 2]");
    folder.write("move.pbrt", "Translate 5 0 0");
    folder.write("packed.pbrt.gz", gzip(kTriangle));
    const std::string points = "\"point P\" [0 0 0 1 0 0 0 1 0]";
    const struct {
        const char* name;
        std::string text;
        dvec3 by;
    } cases[] = {
        {"parameters", "Shape \"trianglemesh\" \"integer indices\" [0 1 2] Include \"points.pbrt\"",
         dvec3(0)},
        {"list goes on", "Include \"begin.pbrt\" " + points, dvec3(0)},
        {"numbers",
         "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [Include "
         "\"numbers.pbrt\"]",
         dvec3(0)},
        {"state stays", std::string("Include \"move.pbrt\"\n") + kTriangle, dvec3(5, 0, 0)},
        {"state of an import ends", std::string("Import \"move.pbrt\"\n") + kTriangle, dvec3(0)},
        {"packed, under its name", "Include \"packed.pbrt\"", dvec3(0)},
        {"backslash", "Include \".\\packed.pbrt.gz\"", dvec3(0)},
    };
    for (const auto& test : cases) {
        const Reading reading = read(folder, test.text);
        EXPECT_EQ(triangles_of(reading.scene), std::vector<Triangle>{moved(test.by)}) << test.name;
        EXPECT_TRUE(reading.warnings.empty()) << test.name << reading.warnings[0];
    }
}

TEST(Pbrt, ObjectsArePlacedByInstances) {
    const TestFolder folder;
    const std::string a = std::string("ObjectBegin \"a\" ") + kTriangle + "ObjectEnd\n";
    const struct {
        const char* name;
        std::string text;
        std::vector<Triangle> expected;
        uint64_t unique, instances;
    } cases[] = {
        {"twice",
         a + "ObjectInstance \"a\" Translate 2 0 0 ObjectInstance \"a\"",
         {kFlatTriangle, moved({2, 0, 0})},
         1,
         2},
        {"never", a, {}, 1, 0},
        {"where it was defined counts",
         "Translate 1 0 0 " + a + "Translate 4 0 0 ObjectInstance \"a\"",
         {moved({6, 0, 0})},
         1,
         1},
        {"its state ends with it",
         std::string("ObjectBegin \"a\" Translate 9 0 0 ObjectEnd ") + kTriangle,
         {kFlatTriangle},
         1,
         0},
        {"nested",
         a + "ObjectBegin \"b\" ObjectInstance \"a\" Translate 2 0 0 ObjectInstance \"a\" "
             "ObjectEnd "
             "ObjectInstance \"b\" Translate 0 4 0 ObjectInstance \"b\"",
         {kFlatTriangle, moved({2, 0, 0}), moved({0, 4, 0}), moved({2, 4, 0})},
         1,
         6},
        {"defined in each other",
         std::string("ObjectBegin \"b\" Translate 1 0 0 ") + a +
             "ObjectInstance \"a\" ObjectEnd Identity ObjectInstance \"b\"",
         {moved({2, 0, 0})},
         1,
         2},
        {"redefined",
         a + "ObjectInstance \"a\" ObjectBegin \"a\" Translate 3 0 0 " + kTriangle +
             "ObjectEnd ObjectInstance \"a\"",
         {kFlatTriangle, moved({3, 0, 0})},
         2,
         2},
        {"before it is defined, as v4 allows", "ObjectInstance \"a\" " + a, {kFlatTriangle}, 1, 1},
    };
    for (const auto& test : cases) {
        const Reading reading = read(folder, test.text);
        EXPECT_EQ(triangles_of(reading.scene), test.expected) << test.name;
        EXPECT_EQ(reading.scene->instancing->unique_triangles, test.unique) << test.name;
        EXPECT_EQ(reading.scene->instancing->instances, test.instances) << test.name;
    }
}

TEST(Pbrt, AttributeHandsParametersToWhatFollows) {
    const TestFolder folder;
    const std::string defaults = "AttributeBegin\nAttribute \"shape\" \"integer indices\" [0 1 2] "
                                 "\"point P\" [9 9 9 8 8 8 7 7 7]\nAttribute \"shape\" \"point "
                                 "P\" [0 0 0 1 0 0 0 1 0]\nAttribute \"light\" \"float P\" 1\n";
    const std::string end = "AttributeEnd\nShape \"trianglemesh\"\n";
    const std::vector<Triangle> latest{moved(dvec3(0))}, own{moved(dvec3(5, 0, 0))};
    EXPECT_EQ(triangles(folder, defaults + "Shape \"trianglemesh\"\n" + end), latest);
    EXPECT_EQ(triangles(folder, defaults +
                                    "Shape \"trianglemesh\" \"point P\" [5 0 0 6 0 0 5 1 "
                                    "0]\n" +
                                    end),
              own);
    const Result<Scene> scene =
        load(folder.write("a.pbrt", "Attribute \"material\" \"rgb Kd\" [.25 .5 .75]\nAttribute "
                                    "\"light\" \"float scale\" 2\nMaterial \"matte\"\nLightSource "
                                    "\"point\"\n" +
                                        std::string(kTriangle)));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->materials[scene->meshes.at(0).material].color, vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(scene->lights.size(), 1u);
}

TEST(Pbrt, WarningsComeOncePerKindWithTheirPlace) {
    const TestFolder folder;
    const std::string text =
        "WorldBegin\nFoo \"bar\" \"float x\" 1\nFoo 1 2\n"
        "Shape \"blob\"\nShape \"blob\"\nMaterial \"velvet\"\n"
        "NamedMaterial \"none\"\nShape \"plymesh\" \"string filename\" "
        "\"gone.ply\"\nIdentity Include \"gone.pbrt\"\nObjectInstance \"gone\"\n"
        "LightSource \"laser\"\nAttributeEnd\nCoordSysTransform \"gone\"\n"
        "Shape \"sphere\" \"money radius\" 3\n"
        "Texture \"t\" \"color\" \"ptex\"\n";
    const Reading reading = read(folder, text);
    ASSERT_TRUE(reading.scene);
    EXPECT_EQ(reading.warnings,
              (std::vector<std::string>{
                  "a.pbrt:2: directives 'Foo' left out", "a.pbrt:4: shapes 'blob' left out",
                  "a.pbrt:6: materials 'velvet' become matte",
                  "a.pbrt:7: there is no material 'none'", "a.pbrt:8: there is no file 'gone.ply'",
                  "a.pbrt:9: there is no file 'gone.pbrt'", "a.pbrt:11: lights 'laser' left out",
                  "a.pbrt:12: AttributeEnd without a beginning left out",
                  "a.pbrt:13: there is no coordinate system 'gone'",
                  "a.pbrt:14: parameters of type 'money' left out",
                  "a.pbrt:15: textures 'ptex' are shown by their mean",
                  "a.pbrt:10: there is no object 'gone'"}));
}

TEST(Pbrt, AnyNumberOfIncludesFollowEachOther) {
    const TestFolder folder;
    folder.write("leaf.pbrt", kTriangle);
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 12000; ++i)
        text += "Include \"leaf.pbrt\"\n";
    const Reading reading = read(folder, text);
    ASSERT_TRUE(reading.scene) << reading.scene.error().message;
    EXPECT_EQ(reading.scene->soup.triangle_count(), 12000u);
    EXPECT_TRUE(reading.warnings.empty()) << reading.warnings[0];
}

TEST(Pbrt, FilesThatAreNotThereMayBeMisspelt) {
    const TestFolder folder;
    folder.write("leaf.pbrt", kTriangle);
    const Reading reading = read(folder, "WorldBegin\nInclude \"laef.pbrt\"");
    ASSERT_EQ(reading.warnings.size(), 2u);
    EXPECT_EQ(reading.warnings[0],
              "a.pbrt:2: there is no file 'laef.pbrt'; did you mean 'leaf.pbrt'?");
}

TEST(Pbrt, OneOfSeveralWorldsIsRead) {
    const TestFolder folder;
    folder.write("inner.pbrt", "Scale 1 1 1\nWorldBegin Scale 3 1 1 Include \"leaf.pbrt\"\n");
    folder.write("leaf.pbrt", kTriangle);
    const std::string text =
        std::string("Translate 0 0 -1 Camera \"perspective\" WorldBegin Scale 1 1 1\n") +
        "Material \"velvet\"\n" + kTriangle +
        "\nWorldEnd\nTranslate 0 0 -2 Camera \"perspective\"\nWorldBegin Scale 2 1 1\n" +
        kTriangle + "\nWorldEnd\nInclude \"inner.pbrt\" WorldEnd";
    const char* others = "of the file left out; --world N reads another";
    const struct {
        uint64_t world;
        double width, eye;
        std::vector<std::string> warnings;
    } cases[] = {{1,
                  1,
                  1,
                  {"a.pbrt:2: materials 'velvet' become matte",
                   std::string("a.pbrt:7: all but world 1 ") + others}},
                 {2, 2, 2, {std::string("inner.pbrt:2: all but world 2 ") + others}},
                 {3, 3, 2, {}}};
    for (const auto& test : cases) {
        std::vector<std::string> warnings;
        ImportOptions options = gather(warnings);
        options.world = test.world;
        const auto scene = load(folder.write("a.pbrt", text), options);
        ASSERT_EQ(triangles_of(scene).size(), 1u) << test.world;
        double width = 0;
        for (const dvec3& corner : triangles_of(scene)[0])
            width = std::max(width, corner.x);
        EXPECT_EQ(width, test.width);
        ASSERT_TRUE(scene->camera);
        EXPECT_EQ(scene->camera->eye.z, test.eye) << test.world;
        for (std::string& warning : warnings)
            warning = folder.plain(warning);
        EXPECT_EQ(warnings, test.warnings);
    }
    ImportOptions options;
    options.world = 4;
    const auto none = load(folder / "a.pbrt", options);
    ASSERT_FALSE(none);
    EXPECT_EQ(folder.plain(none.error().message),
              "a.pbrt:11: found 3 worlds, expected 4, for --world asks for it");
}

TEST(Pbrt, LineEndsMayBeMixed) {
    const TestFolder folder;
    const std::string triangle =
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0\n0 1 0]\n# a comment\n";
    const std::string world = "WorldBegin\r" + triangle + "WorldEnd\n\n";
    for (const uint64_t number : {1, 2}) {
        ImportOptions options;
        options.world = number;
        EXPECT_EQ(triangles_of(load(folder.write("a.pbrt", world + world), options)),
                  std::vector<Triangle>{kFlatTriangle});
    }
}

TEST(Pbrt, WhatFollowsTheWorldIsSaid) {
    const TestFolder folder;
    const Reading reading =
        read(folder, std::string("WorldBegin ") + kTriangle + "\nWorldEnd\n" + kTriangle);
    EXPECT_EQ(triangles_of(reading.scene).size(), 1u);
    ASSERT_EQ(reading.warnings.size(), 1u);
    EXPECT_EQ(reading.warnings[0], "a.pbrt:4: what follows WorldEnd left out");
}

TEST(Pbrt, StrictMakesWhatIsMissingAnError) {
    const TestFolder folder;
    const char* missing[] = {"Foo 1",
                             "Shape \"blob\"",
                             "Material \"velvet\"",
                             "NamedMaterial \"none\"",
                             "Shape \"plymesh\" \"string filename\" \"gone.ply\"",
                             "Include \"gone.pbrt\"",
                             "ObjectInstance \"gone\"",
                             "LightSource \"laser\"",
                             "AttributeEnd",
                             "AttributeBegin",
                             "ObjectBegin \"x\"",
                             "Shape \"trianglemesh\"",
                             "Shape \"sphere\" \"money radius\" 3"};
    for (const char* text : missing) {
        const std::string whole = std::string(kTriangle) + "\n" + text + "\n";
        EXPECT_EQ(failure(folder, whole), "none") << text;
        const std::string message = failure(folder, whole, /* strict= */ true);
        EXPECT_EQ(message.find("a.pbrt:"), 0u) << text << message;
    }
    EXPECT_EQ(
        failure(folder, std::string("Texture \"t\" \"color\" \"imagemap\"\n") + kTriangle, true),
        "none");
}

TEST(Pbrt, ErrorsNameTheFileAndTheLine) {
    const TestFolder folder;
    folder.write("self.pbrt", "Include \"self.pbrt\"");
    folder.write("ping.pbrt", "Include \"pong.pbrt\"");
    folder.write("pong.pbrt", "\nInclude \"ping.pbrt\"");
    const struct {
        std::string text, message;
    } cases[] = {
        {"hello\n", "a.pbrt:1: found 'hello', expected a directive such as Shape"},
        {"WorldBegin\n3\n", "a.pbrt:2: found the number 3, expected a directive such as Shape"},
        {"Translate 1 2\nWorldBegin", "a.pbrt:2: found 'WorldBegin', expected number 3 of 3"},
        {"Translate [1 2 3\nWorldBegin",
         "a.pbrt:2: found 'WorldBegin', expected ']' after 3 numbers"},
        {"Scale 1 2", "a.pbrt:1: found the end of the file, expected number 3 of 3"},
        {"Shape trianglemesh", "a.pbrt:1: found 'trianglemesh', expected a name in quotes"},
        {"Shape \"sphere\n\"", "a.pbrt:1: found the string '\"sphere' without a closing quote"},
        {"Shape \"sphere\" \"float radius\" [1 2",
         "a.pbrt:1: found the list of 'radius' without its ']'"},
        {"Shape \"sphere\" \"float radius\" WorldBegin",
         "a.pbrt:1: found 'WorldBegin', expected a value of 'radius'"},
        {"Shape \"sphere\" \"radius\" 1",
         "a.pbrt:1: found the string 'radius', expected a parameter such as \"float radius\""},
        {"Scale 1 2 3x", "a.pbrt:1: found '3x', expected a number"},
        {"\nInclude \"a.pbrt\"", "a.pbrt:2: 'a.pbrt' includes itself"},
        {"Include \"self.pbrt\"", "self.pbrt:1: 'self.pbrt' includes itself"},
        {"Include \"ping.pbrt\"", "pong.pbrt:2: 'ping.pbrt' includes itself"},
        {"Include 3", "a.pbrt:1: found the number 3, expected the name of a file in quotes"},
        {"ActiveTransform Sometimes",
         "a.pbrt:1: found 'Sometimes', expected All, StartTime or EndTime"},
    };
    for (const auto& test : cases)
        EXPECT_EQ(failure(folder, test.text), test.message) << test.text;
}

TEST(Pbrt, UnusableMeshesAreLeftOutWithTheReason) {
    const TestFolder folder;
    const std::string mesh = "Shape \"trianglemesh\" ";
    const std::string points = "\"point P\" [0 0 0 1 0 0 0 1 0]";
    const struct {
        std::string text, reason;
    } cases[] = {
        {mesh, "it has no points P"},
        {mesh + "\"point P\" [1 2]", "its points P are not in triples"},
        {mesh + points + "\"integer indices\" [0 1]", "its indices do not come in groups of 3"},
        {mesh + points + "\"integer indices\" [0 1 3]", "found vertex index 3, expected 0 to 2"},
        {mesh + points + "\"integer indices\" [0 1 -1]", "found vertex index -1, expected 0 to 2"},
        {mesh + points + "\"integer indices\" [0 1 1e99]",
         "found vertex index 1e+99, expected 0 to 2"}};
    for (const auto& test : cases) {
        const Reading reading = read(folder, test.text);
        ASSERT_TRUE(reading.scene) << test.text;
        ASSERT_FALSE(reading.warnings.empty()) << test.text;
        EXPECT_EQ(reading.warnings[0], "a.pbrt:1: a shape 'trianglemesh' left out: " + test.reason);
    }
}

TEST(Pbrt, FilesThatMultiplyEndWithAnError) {
    const TestFolder folder;
    // Each file includes the next one twice, which makes 2^40 includes.
    for (int i = 0; i < 40; ++i) {
        const std::string next = numbered("Include \"n", i + 1, ".pbrt\"\n");
        folder.write(numbered("n", i, ".pbrt"), next + next);
    }
    folder.write("n40.pbrt", "");
    ImportOptions options;
    options.max_triangles = 200'000;
    const std::string message = load(folder / "n0.pbrt", options).error().message;
    EXPECT_NE(message.find("found more than 2000 includes in files that are included again"),
              message.npos)
        << message;
    // These files include each other under ever new names.
    for (int i = 0; i < 70; ++i)
        folder.write(numbered("d", i, ".pbrt"), numbered("Include \"d", i + 1, ".pbrt\""));
    EXPECT_EQ(folder.failure("d0.pbrt"), "d63.pbrt:1: found more than 64 files in each other");
}

std::string doubled(int levels) {
    std::string text = std::string("ObjectBegin \"0\" ") + kTriangle + "ObjectEnd\n";
    for (int i = 1; i <= levels; ++i) {
        const std::string one = numbered("ObjectInstance \"", i - 1, "\" ");
        text.append(numbered("ObjectBegin \"", i, "\" ")).append(one).append(one);
        text.append("ObjectEnd\n");
    }
    return text.append(numbered("ObjectInstance \"", levels, "\"\n"));
}

TEST(Pbrt, BombsAreRefusedWithTheirCount) {
    const TestFolder folder;
    EXPECT_EQ(failure(folder, doubled(30)),
              "a.pbrt: found 1073741824 triangles once 2147483647 instances of 1 are expanded, "
              "expected at most 100000000; --max-triangles allows more");
    EXPECT_EQ(failure(folder, doubled(100)).substr(0, 44),
              "a.pbrt: found more than 18446744073709551614");
    EXPECT_EQ(failure(folder,
                      "Shape \"loopsubdiv\" \"integer nlevels\" 20 \"integer indices\" [0 1 2 "
                      "0 2 1] \"point P\" [0 0 0 1 0 0 0 1 0]"),
              "a.pbrt:1: found a loopsubdiv of 2199023255552 triangles, expected at most 100000000 "
              "more; --max-triangles allows more");
    // Objects without triangles cost nothing, however many.
    const std::string empty = doubled(60);
    EXPECT_EQ(failure(folder, empty.substr(0, 16) + empty.substr(empty.find("ObjectEnd"))), "none");

    ImportOptions options;
    options.max_triangles = 8;
    EXPECT_TRUE(load(folder.write("eight.pbrt", doubled(3)), options));
    options.max_triangles = 7;
    EXPECT_FALSE(load(folder / "eight.pbrt", options));
    options.max_triangles = 4294967294;
    const auto huge = load(folder.write("huge.pbrt", doubled(31)), options);
    ASSERT_FALSE(huge);
    EXPECT_NE(huge.error().message.find("of memory are free"), std::string::npos)
        << huge.error().message;
}

TEST(Pbrt, FarInstancesKeepTheirPrecisionAndTheirSeams) {
    const TestFolder folder;
    // Tiles of 0.1 lie side by side, a million from the origin, and every other one is turned.
    std::string text =
        "ObjectBegin \"tile\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
        "\"point P\" [0 0 0 .1 0 0 .1 .1 0 0 .1 0] ObjectEnd\n" +
        std::string("ObjectBegin \"back\" Rotate 180 0 0 1 ObjectInstance \"tile\" "
                    "ObjectEnd\n") +
        kTriangle;
    for (int i = 0; i < 50; ++i)
        text += "AttributeBegin Translate " + std::to_string(1000000 + i * 0.1) +
                " 0.1 0 ObjectInstance \"" + (i % 2 ? "back" : "tile") + "\" AttributeEnd\n";
    const auto found = triangles(folder, text);
    ASSERT_EQ(found.size(), 101u);
    std::vector<dvec3> corners;
    for (size_t i = 1; i < found.size(); ++i)
        corners.insert(corners.end(), found[i].begin(), found[i].end());
    for (const dvec3& a : corners) {
        EXPECT_LT(std::abs(a.x - std::round(a.x * 10) / 10), 2e-8);
        for (const dvec3& b : corners)
            if (glm::length(a - b) < 1e-3) {
                EXPECT_EQ(a, b); // bit for bit
            }
    }
}

/// An instance whose transform is not affine is expanded; later instances still share corners of
/// the object.
TEST(Pbrt, AnInstanceThatIsExpandedLendsNobodyItsCorners) {
    const TestFolder folder;
    std::string mesh =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 "
        "0 1 0]\n";
    std::string object = "ObjectBegin \"a\"\n";
    for (int i = 0; i < 64; ++i)
        object += mesh;
    object += "ObjectEnd\n";
    const std::string projected = "AttributeBegin Transform [1 0 0 0  0 1 0 0  0 0 1 1  0 0 0 1] "
                                  "ObjectInstance \"a\" AttributeEnd\n";
    const std::string moved = "Translate 0 0 5 ObjectInstance \"a\" Translate 0 0 5 "
                              "ObjectInstance \"a\"";
    const auto found = triangles(folder, object + projected + moved);
    ASSERT_EQ(found.size(), 3 * 64u);
    EXPECT_EQ(found[64][1], dvec3(1, 0, 5));
    EXPECT_EQ(found[128][2], dvec3(0, 1, 10));
}

TEST(Pbrt, NormalsFollowInstances) {
    const TestFolder folder;
    const std::string mesh =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 "
        "0 0 0 1 0] \"normal N\" [0 0 2 0 1 1 0 0 1]";
    const auto scene =
        load(folder.write("n.pbrt", "ObjectBegin \"a\" " + mesh +
                                        " ObjectEnd ObjectInstance \"a\" Rotate 90 1 0 0 "
                                        "ObjectInstance \"a\" Scale 1 1 -1 ObjectInstance \"a\""));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->meshes.size(), 3u);
    EXPECT_EQ(scene->meshes[1].normals_from, 0u);
    EXPECT_TRUE(scene->meshes[1].normals.empty());
    const dvec3 expected[3] = {{0, 0, 1}, {0, -1, 0}, {0, 1, 0}};
    for (size_t m = 0; m < 3; ++m) {
        const MeshInfo& mesh_info = scene->meshes[m];
        const auto normals = scene->normals_of(mesh_info);
        ASSERT_EQ(normals.size(), 3u);
        const dvec3 turned = glm::normalize(mesh_info.turn * dvec3(normals.of(0)[0]));
        EXPECT_LT(glm::length(turned - expected[m]), 1e-6) << m;
    }
}

} // namespace
} // namespace ovc
