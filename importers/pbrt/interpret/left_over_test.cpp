// SPDX-License-Identifier: Apache-2.0
// A parameter that nothing asks for is named, and one with too many values is refused.
#include "importers/test_files.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

using testing::ElementsAre;

struct Said {
    std::vector<std::string> warnings;
    std::string error; // empty: there is a scene
};

Said said_of(const std::string& text, bool strict = false) {
    const TestFolder folder;
    Said said;
    ImportOptions options = gather(said.warnings);
    options.strict = strict;
    const Result<Scene> scene = load(folder.write("a.pbrt", text), options);
    for (std::string& warning : said.warnings)
        warning = folder.plain(warning);
    if (!scene)
        said.error = folder.plain(scene.error().message);
    return said;
}

TEST(PbrtLeftOver, AMisspeltParameterIsNamedAndStrictRefusesIt) {
    const std::string text =
        "Shape \"sphere\" \"float radus\" 2\nShape \"sphere\" \"float radus\" 2";
    EXPECT_THAT(said_of(text).warnings,
                ElementsAre("a.pbrt:1: the parameter 'radus' of shapes 'sphere' left out: it is "
                            "unknown"));
    EXPECT_EQ(said_of(text, true).error,
              "a.pbrt:1: the parameter 'radus' of shapes 'sphere' left out: it is unknown");
}

TEST(PbrtLeftOver, WhatPbrtHasAndWeDoNotShowIsAWarningOnly) {
    const Said said = said_of("Camera \"perspective\" \"float yon\" 9 \"float shutteropen\" 0\n"
                              "Film \"rgb\" \"string filename\" \"a.exr\" \"string sensor\" \"x\"\n"
                              "WorldBegin\nMaterial \"matte\" \"float sigma\" 20\n"
                              "LightSource \"point\" \"integer nsamples\" 4\n"
                              "Shape \"sphere\" \"color Kd\" [1 0 0]\n",
                              true);
    EXPECT_EQ(said.error, "");
    EXPECT_THAT(said.warnings,
                ElementsAre("a.pbrt:2: the parameter 'sensor' of films 'rgb' left out",
                            "a.pbrt:4: the parameter 'sigma' of materials 'matte' left out",
                            "a.pbrt:6: the parameter 'Kd' of shapes 'sphere' left out",
                            "a.pbrt:1: the parameter 'yon' of cameras 'perspective' left out"));
}

TEST(PbrtLeftOver, TexturesAreAskedWhereTheyAreUsed) {
    const Said said = said_of("Texture \"unused\" \"color\" \"marble\" \"float a\" 1\n"
                              "Texture \"t\" \"color\" \"marble\" \"float varation\" 1\n"
                              "Texture \"c\" \"color\" \"constant\" \"color valu\" [1 1 1]\n"
                              "Material \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\"\n");
    EXPECT_THAT(said.warnings,
                ElementsAre("a.pbrt:3: the parameter 'valu' of textures 'constant' left out: it is "
                            "unknown",
                            "a.pbrt:2: the parameter 'varation' of textures 'marble' left out: it "
                            "is unknown"));
}

TEST(PbrtLeftOver, CountsAndRangesThatAreWrongAreErrors) {
    const struct {
        const char* text;
        const char* error;
    } cases[] = {
        {"Shape \"sphere\" \"float radius\" [1 2]",
         "a.pbrt:1: found 2 values of 'radius', expected 1"},
        {"Shape \"sphere\"\n\"float radius\" []",
         "a.pbrt:2: found 0 values of 'radius', expected 1"},
        {"LightSource \"point\" \"point from\" [1 2]",
         "a.pbrt:1: found 2 values of 'from', expected 3"},
        {"Material \"diffuse\" \"rgb reflectance\" [1 2]",
         "a.pbrt:1: found 2 values of 'reflectance', expected 3"},
        {"Material \"diffuse\" \"rgb reflectance\" []",
         "a.pbrt:1: found 0 values of 'reflectance', expected 3"},
        {"AreaLightSource \"diffuse\" \"bool twosided\" \"yes\"",
         "a.pbrt:1: found the string 'yes' as 'twosided', expected true or false"},
        {"Shape \"trianglemesh\" \"integer indices\" [0 1.5 2]",
         "a.pbrt:1: found 1.5 among the values of 'indices', expected integers"},
        {"Film \"rgb\" \"integer xresolution\" -5",
         "a.pbrt:1: found xresolution -5, expected 1 to 65535"},
        {"Film \"rgb\" \"float cropwindow\" [0 1]",
         "a.pbrt:1: found 2 values of 'cropwindow', expected 4"},
        {"Film \"rgb\" \"float cropwindow\" [0.5 0.5 0 1]",
         "a.pbrt:1: found cropwindow without a pixel in it"},
        {"Camera \"perspective\" \"float fov\" 180",
         "a.pbrt:1: found an angle of view of 180, expected more than 0 and less than 180"},
        {"Camera \"perspective\" \"float screenwindow\" [-1 1 -1]",
         "a.pbrt:1: found 3 values of 'screenwindow', expected 4"},
        {"Camera \"perspective\" \"float fov\" 0",
         "a.pbrt:1: found an angle of view of 0, expected more than 0 and less than 180"},
    };
    for (const auto& test : cases)
        EXPECT_EQ(said_of(test.text).error, test.error);
}

TEST(PbrtLeftOver, DefaultsByAttributeNeedNoUse) {
    EXPECT_THAT(said_of("Attribute \"shape\" \"float radius\" 0.5\nShape \"sphere\"\n"
                        "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]\n")
                    .warnings,
                ElementsAre());
    EXPECT_THAT(said_of("Attribute \"shapes\" \"float radius\" 0.5\nShape \"sphere\"").warnings,
                ElementsAre("a.pbrt:1: defaults of 'shapes' left out"));
    std::string many = "Attribute \"shape\" \"float P\" [";
    for (int i = 0; i < 1001; ++i)
        many += "1 ";
    EXPECT_EQ(said_of(many + "]").error,
              "a.pbrt:1: found more than 1000 values of defaults by Attribute");
}

} // namespace
} // namespace ovc
