// SPDX-License-Identifier: Apache-2.0
// Reads the fuzzer's pov_seeds cut off everywhere or with changed bytes. The fuzzer does so for
// longer.
#include "importers/pov/test_parse.h"
#include "importers/readers.h"
#include "importers/test_files.h"
#include "tests/fuzz/pov.h"

#include <random>

namespace ovc {
namespace {

std::vector<std::string> pov_seeds() {
    return contents_of(OVC_SOURCE_DIR "/importers/pov/corpus");
}

void survives_pov(const std::string& text) {
    fuzz_pov(reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

TEST(PovDamage, SeedsAreScenes) {
    ASSERT_EQ(pov_seeds().size(), 5u);
    for (const std::string& text : pov_seeds())
        EXPECT_GT(triangles_of(parse_pov(text, "seed.pov", {})).size(), 1000u);
}

TEST(PovDamage, EveryBeginningIsASceneOrASentence) {
    for (const std::string& text : pov_seeds())
        for (size_t length = 0; length < text.size(); length += 5)
            survives_pov(text.substr(0, length));
}

TEST(PovDamage, AnyByteMayBeAnyOther) {
    constexpr std::string_view kOdd = "\"{}<>()[]#-.,;=9eE \n\\\0\xff/*";
    for (const std::string& text : pov_seeds()) {
        std::mt19937 random(uint32_t(text.size()));
        for (int i = 0; i < 400; ++i) {
            std::string damaged = text;
            for (uint32_t n = random() % 3; n < 3; ++n)
                damaged[random() % text.size()] = kOdd[random() % kOdd.size()];
            survives_pov(damaged);
        }
    }
}

TEST(PovDamage, LoopsRecursionAndGroupsThatDoNotEndAreStopped) {
    const struct {
        const char* text;
        const char* sentence;
    } cases[] = {
        {"#while (1) #end", "stopped after a round that changed nothing: the loop does not end"},
        {"#for (I, 1, 1e9) #end", "stopped after 100000 words: a loop or a macro does not end"},
        {"#macro M() M() #end M()", "does not end"},
        {"#macro M() #local A = M(); #end M()", "deep in each other"},
        {"#declare A = sphere { 0, 1 }\n#declare I = 0;\n#while (I < 40)\n"
         "#declare A = union { object { A } object { A } }\n#declare I = I + 1;\n#end object { A }",
         "found more than 50000 objects in the scene"},
        {"#declare A = sphere { 0, 1 }\n#while (1) #declare A = union { object { A } }\n#end",
         "found objects more than 2000 deep in each other"},
        {"#declare A = sphere { 0, 1 }\n#while (1) #declare A = sphere { 0, 1 clipped_by { A } }\n"
         "#end",
         "found objects more than 2000 deep in each other"},
        {"#if (0) #elseif (#end 0) #end", "found #end of a block within its condition"},
        {"#declare N = 0;\n#while (#declare N = N + 1; #if (N < 2) #end #end 0) #end #end",
         "found #end of a block within its condition"},
        {"#while (#if (1) #break #end 1) #end", "found #break of a block within its condition"},
        {"#declare N = 1e308 * 10;\n#declare S = spline { N - N, 1 }",
         "found a spline's clock that is not a number"},
        {"#declare F = function { x }\n#while (1) #declare F = function { F(x, y, z) + 1 }\n#end",
         "found a function of more than 4000 operations"},
        {"#declare F = function { x }\n#for (I, 1, 60) #declare F = function { F(x, y, z) + F(y, "
         "x, z) "
         "}\n#end #declare V = F(1, 2, 3);",
         "found a function that takes more than a million steps"},
        {"#declare A = array[1] { 1 }\n#while (1) #declare A = array[1] { A }\n#end",
         "found arrays more than 100 deep in each other"},
        {"#while (1) #declare A = array[20000] #end", "stopped after 100000 words"},
        {"#declare A = array[100000][100000]", "found an array of 10000000000 items"},
    };
    ImportOptions options;
    options.max_triangles = 1'000'000;
    for (const auto& c : cases) {
        const Result<Scene> scene = parse_pov(c.text, "x.pov", options, 100'000);
        ASSERT_FALSE(scene) << c.text;
        EXPECT_NE(scene.error().message.find(c.sentence), std::string::npos)
            << scene.error().message;
    }
    std::string deep = "sphere { ";
    for (int i = 0; i < 100'000; ++i)
        deep += "(";
    EXPECT_FALSE(parsed_scene(deep));
}

TEST(PovDamage, SolidsOfNothingAndOfFarPlanesAreRead) {
    for (const char* text :
         {"intersection { sphere { 0, 1 } mesh { } }", "difference { sphere { 0, 1 } mesh2 { } }",
          "intersection { plane { x, 1 } mesh { triangle { <0,1e17,1e17>, <1,1e17,1e17>, "
          "<2,1e17,1e17> } inside_vector x } }",
          "blob { threshold 0.5 sphere { 0, 1, 1 } sphere { <1e17,0,0>, 1, 1 } }",
          "#declare S = spline { 0, 1 } #declare N = 1e308 * 10; sphere { 0, S(N - N) }"})
        survives_pov(text);
}

} // namespace
} // namespace ovc
