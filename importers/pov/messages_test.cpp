// SPDX-License-Identifier: Apache-2.0
// Tests errors and warnings: their words, and the place that they name.
#include "importers/pov/test_parse.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ovc {
namespace {

TEST(PovErrors, NameTheLineAndShowIt) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"sphere { 0 1 }\nbox { 0, Side }",
         "x.pov:2:10: found 'Side', which is not declared\n    box { 0, Side }\n             ^"},
        {"\n  polynomial { 4, <0, 0, 0> }", "x.pov:2:3: polynomial is not supported\n      "
                                            "polynomial { 4, <0, 0, 0> }\n      ^"},
        {"#if (1)", "x.pov:1:1: found no #end to this\n    #if (1)\n    ^"},
        {"#include \"none.inc\"",
         "x.pov:1:1: there is no file 'none.inc', neither beside the scene nor among POV-Ray's "
         "include files\n    #include \"none.inc\"\n    ^"},
        {"#error concat(\"bad \", str(2, 0, 0))",
         "x.pov:1:1: the scene stops with #error: bad 2\n    #error concat(\"bad \", str(2, 0, "
         "0))\n    ^"},
        {"sphere { 0, 1", "x.pov:1:14: found the end of the file, expected '}' or a modifier of "
                          "sphere\n    sphere { 0, 1\n                 ^"},
    };
    for (const auto& c : cases) {
        const Result<Scene> scene = parsed_scene(c.text);
        ASSERT_FALSE(scene) << c.text;
        EXPECT_EQ(scene.error().message, c.message);
    }
}

TEST(PovErrors, TellWhichLineOfTheSceneLedThere) {
    const Result<Scene> called = parsed_scene("#macro In(R) sphere { 0, R + Z } #end\n"
                                              "#macro Out(R)\n  In(R)\n#end\nOut(2)");
    ASSERT_FALSE(called);
    EXPECT_EQ(called.error().message, "x.pov:1:30: found 'Z', which is not declared\n"
                                      "    #macro In(R) sphere { 0, R + Z } #end\n"
                                      "                                 ^\n"
                                      "    called at x.pov:5:1:\n"
                                      "    Out(2)\n"
                                      "    ^");
    const TestFolder folder;
    folder.write("odd.inc", "\npolynomial { 1 }");
    const auto included = load(folder.write("main.pov", "sphere { 0, 1 }\n#include \"odd.inc\""));
    ASSERT_FALSE(included);
    EXPECT_EQ(folder.plain(included.error().message),
              "odd.inc:2:1: polynomial is not supported\n    polynomial { 1 }\n    ^\n"
              "    included at main.pov:2:1:\n    #include \"odd.inc\"\n    ^");
}

TEST(PovErrors, WhatIsDeclaredAndNotSeenMayBeUnsupported) {
    EXPECT_TRUE(parsed_scene("#declare D = polynomial { 4, <0, 0, 0> } sphere { 0, 1 }"));
}

TEST(PovWarnings, ComeOncePerKind) {
    std::vector<std::string> messages;
    const auto scene =
        parse_pov("sphere { 0, 1 pigment { tiling 26 } }\nsphere { 0, 1 pigment { tiling 25 } }\n"
                  "sphere { 0, 1 normal { pavement } }",
                  "x.pov", gather(messages));
    EXPECT_TRUE(scene);
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_EQ(messages[0], "x.pov:1:25: the pattern 'tiling' is drawn by its average color\n"
                           "    sphere { 0, 1 pigment { tiling 26 } }\n"
                           "                            ^");
}

TEST(PovWarnings, TellOfDivisionsByZero) {
    std::vector<std::string> messages;
    const auto scene = parse_pov("#declare A = -1 / 0; #declare V = <1, 2, 3> / <0, 1, 2>; "
                                 "box { 0, (A > 1e300) + (V.x > 1e300) + V.z }",
                                 "x.pov", gather(messages));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(triangles_of(scene).size(), 12u);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(messages[0].starts_with("x.pov:1:17: found a division by zero")) << messages[0];
}

TEST(PovWarnings, AreCountedOrErrors) {
    const std::string text = "sphere { 0, 1 pigment { tiling 26 } }\n"
                             "sphere { 0, 1 pigment { tiling 25 } }\nphotons { }";
    const Result<Scene> scene = parsed_scene(text);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->omissions, (std::vector<Omission>{
                                    {"the pattern 'tiling' is drawn by its average color", 2},
                                    {"photons is left out", 1},
                                }));
    const Result<Scene> refused = parse_pov(text, "x.pov", {.strict = true});
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().message.starts_with(
        "x.pov:3:1: photons is left out, which --strict makes an error"))
        << refused.error().message;
    EXPECT_TRUE(parse_pov("#warning \"so\" sphere { 0, 1 }", "x.pov", {.strict = true}));
}

TEST(PovErrors, NamesOfNothingAreNotPassedOver) {
    for (const char* look : {"texture { Banana }", "pigment { Banana }", "finish { Banana }",
                             "interior { Banana }", "texture { pigment { rgb 1 } O }"}) {
        const Result<Scene> scene =
            parsed_scene("#declare O = sphere { 0, 1 }\nbox { 0, 1 " + std::string(look) + " }");
        ASSERT_FALSE(scene) << look;
        EXPECT_TRUE(scene.error().message.starts_with("x.pov:2:")) << scene.error().message;
    }
}

/// povray 3.7.0.10 refuses each of them.
TEST(PovErrors, WordsThatABlockDoesNotHaveAreNotPassedOver) {
    for (const char* scene :
         {"camera { fov 60 }", "camera { location 1 radius 2 }", "global_settings { fov 60 }",
          "global_settings { look_at 1 }", "radiosity { sphere 1 }", "sphere { 0, 1 look_at 0 }",
          "sphere { 0, 1 pigment { rgb 1 location 2 } }", "sphere { 0, 1 texture { angle 2 } }",
          "sphere { 0, 1 normal { bumps look_at 2 } }", "sphere { 0, 1 finish { look_at 0.1 } }",
          "sphere { 0, 1 interior { diffuse 1 } }", "fog { distance 1 diffuse 2 }",
          "light_source { 1, 1 location 2 }", "media { diffuse 1 }",
          "sphere { 0, 1 pigment { image_map { png \"none.png\" sharp } } }",
          "sphere_sweep { linear_spline 2, 0, 1, x, 1 look_at 0 }"}) {
        const Result<Scene> read = parsed_scene(scene);
        ASSERT_FALSE(read) << scene;
        EXPECT_NE(read.error().message.find(": found '"), std::string::npos)
            << read.error().message;
    }
    EXPECT_TRUE(
        parsed_scene("camera { locatoin 1 }")
            .error()
            .message.starts_with(
                "x.pov:1:10: found 'locatoin', expected '}' or a part of a camera; did you mean "
                "'location'?\n"));
}

TEST(PovErrors, FlatCamerasSeeLessThanHalfOfEverything) {
    EXPECT_EQ(parsed_scene("camera { angle 200 }").error().message,
              "x.pov:1:16: found a camera's angle of 200, expected one above 0 and below 180\n"
              "    camera { angle 200 }\n                   ^");
    EXPECT_FALSE(parsed_scene("camera { orthographic angle 180 }"));
    EXPECT_TRUE(parsed_scene("camera { fisheye angle 360 }"));
    EXPECT_FALSE(parsed_scene("camera { fisheye angle 361 }"));
}

} // namespace
} // namespace ovc
