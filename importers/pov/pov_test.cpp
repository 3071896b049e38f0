// SPDX-License-Identifier: Apache-2.0
// Tests POV-Ray's scene language: values, directives and errors. importers/pov/compare.py and
// tests/povray_test.cpp compare with POV-Ray itself.
#include "core/system/stopwatch.h"
#include "importers/readers.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ovc {
namespace {

Result<Scene> parse(const std::string& text) {
    return parse_pov(text, "x.pov", {});
}

/// Returns an expression's value, which the upper corner of a box tells.
dvec3 value(const std::string& expression, const std::string& before = "") {
    const Result<Scene> scene = parse(before + "\nbox { -1e6, (" + expression + ") * <1, 1, 1> }");
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return dvec3(0);
    }
    dvec3 hi(-1e9);
    for (const Triangle& t : triangles_of(scene))
        for (const dvec3& corner : t)
            hi = glm::max(hi, corner);
    return hi;
}

#define EXPECT_VALUE(expected, ...)                                                                \
    do {                                                                                           \
        const dvec3 found_value = value(__VA_ARGS__), expected_value(expected);                    \
        EXPECT_LT(glm::length(found_value - expected_value),                                       \
                  1e-7 * (1 + glm::length(expected_value)))                                        \
            << found_value.x << " " << found_value.y << " " << found_value.z;                      \
    } while (false)

/// As povray 3.7.0.10 draws them: the lights of the innermost group count, and the global_lights of
/// the outermost.
TEST(PovLights, ShineInTheirGroup) {
    const Result<Scene> scene = parse_pov(
        "light_source { <0, 9, 0> rgb 1 } sphere { 0, 1 pigment { rgb 1 } } "
        "light_group { light_source { <9, 9, 0> rgb 1 } sphere { 1, 1 pigment { rgb x } } "
        "light_group { light_source { <0, 9, 9> rgb 1 } box { 3, 4 pigment { rgb y } } "
        "global_lights off } global_lights on }",
        "x.pov", {});
    ASSERT_TRUE(scene) << scene.error().message;
    const std::vector<std::vector<bool>> lit = {
        {true, false, false}, {true, true, false}, {true, false, true}};
    ASSERT_EQ(scene->meshes.size(), lit.size());
    for (size_t m = 0; m < lit.size(); ++m)
        for (size_t l = 0; l < scene->lights.size(); ++l)
            EXPECT_EQ(scene->meshes[m].lit_by.includes(scene->lights[l].group), lit[m][l])
                << scene->meshes[m].name << " " << l;
}

/// As measured of povray 3.7.0.10.
TEST(PovLights, AreOfTheKindNamedLast) {
    const auto light = [](const std::string& words) {
        const Result<Scene> scene = parse("light_source { 1, 1 " + words + " }");
        return scene && scene->lights.size() == 1 ? scene->lights[0] : Light{};
    };
    EXPECT_TRUE(light("spotlight shadowless").shadowless);
    EXPECT_FALSE(light("spotlight shadowless").cone);
    EXPECT_FALSE(light("shadowless").lights_media);
    EXPECT_FALSE(light("shadowless spotlight").shadowless);
    EXPECT_TRUE(light("shadowless spotlight").lights_media);
    EXPECT_TRUE(light("shadowless spotlight").cone);
    EXPECT_TRUE(light("spotlight cylinder").beam);
    EXPECT_FALSE(light("spotlight cylinder").cone);
    EXPECT_TRUE(light("cylinder shadowless").parallel);
    const Light narrow = light("spotlight radius 20 falloff 10");
    ASSERT_TRUE(narrow.cone);
    EXPECT_EQ(narrow.cone->falloff_cosine, narrow.cone->radius_cosine);
    const Light even = light("cylinder radius 0 falloff 2");
    ASSERT_TRUE(even.beam);
    EXPECT_EQ(even.beam->radius, 2);
}

TEST(PovExpression, FollowsTheOrderOfOperations) {
    EXPECT_VALUE(7, "1 + 2 * 3");
    EXPECT_VALUE(-3, "-(1 + 2)");
    EXPECT_VALUE(dvec3(3, 4, 6), "<1, 2, 4> + 2");
    EXPECT_VALUE(dvec3(2, 3, 4), "2*x + 3*y + 4*z");
    EXPECT_VALUE(4, "<1, 2, 4>.z");
    EXPECT_VALUE(1, "(1 < 2 & !(3 >= 4)) | 0");
    EXPECT_VALUE(5, "(2 > 3 ? 4 : 5)");
    EXPECT_VALUE(0.25, "rgbf <1, 1, 1, 0.25>.filter");
}

TEST(PovExpression, ComparesAsPovrayDoes) {
    EXPECT_VALUE(7, "(1 < 1+1e-11) + 2*(1+1e-11 > 1) + 4*(1+1e-11 <= 1)");
    EXPECT_VALUE(3, "(1-1e-11 >= 1) + 2*(1 = 1+1e-11) + 4*(1 != 1+1e-11)");
    EXPECT_VALUE(4, "(1 = 1+1e-9) + 2*(1+1e-9 <= 1) + 4*(1 != 1+1e-9)");
    EXPECT_VALUE(11, "N",
                 "#declare I = 0; #declare N = 0;"
                 "#while (I < 1) #declare I = I + .1; #declare N = N + 1; #end");
}

TEST(PovExpression, KnowsTheFunctions) {
    EXPECT_VALUE(5, "vlength(<3, 4, 0>)");
    EXPECT_VALUE(dvec3(0, 0, 1), "vcross(x, y)");
    EXPECT_VALUE(dvec3(0, 1, 0), "vrotate(x, 90*z)");
    EXPECT_VALUE(dvec3(0, 1, 0), "vaxis_rotate(x, z, 90)");
    EXPECT_VALUE(-1, "min(3, -1, 2)");
    EXPECT_VALUE(3, "int(3.7)");
    EXPECT_VALUE(12, "strlen(concat(\"a\", str(1.5, 8, 3), chr(65), \"\\\"z\"))");
    EXPECT_VALUE(2.5, "val(substr(\"x2.5y\", 2, 3))");
    EXPECT_VALUE(
        2014,
        "val(\"1e3x\") + val(\" +12 \") + val(\"1e\") + val(\"1,5\") + val(\"1e3\") + val(\"x1\")");
    EXPECT_VALUE(3, "select(-1, 3, 4, 5)");
    EXPECT_VALUE(8, "F(2, 3)", "#declare F = function (a, b) { a * b + select(b - 3, 0, 2, 0) }");
    EXPECT_VALUE(2, "max_extent(S).y", "#declare S = sphere { y, 1 scale <3, 1, 1> };");
    EXPECT_VALUE(dvec3(5, 0, 0), "T(0, 1, 0)",
                 "#declare T = function { transform { rotate -90*z scale 5 } }");
}

/// povray 3.7.0.10 prints these values, of a pigment with float32 in its colors.
TEST(PovExpression, PatternsAndPigmentsAreFunctions) {
    const std::string functions =
        "#declare F = function { pattern { marble turbulence 0.4 scale 0.5 } };"
        "#declare G = function { pigment { gradient x color_map { [0 rgb <0.2, 0.4, 0.6>] "
        "[1 rgbt 1] } scale 3 } };"
        "#declare H = function(x, y, z) { pow(G(x, y, z).red, 2) + F(x, y, z) };"
        "#declare K = function { G(x, y, z).gray };"
        "#declare N = function { internal(76) }; #declare M = function { internal(78) };"
        "#declare C = G(1, 0, 0);";
    EXPECT_NEAR(value("F(0.3, 0.7, 0.1)", functions).x, 0.204942349, 2e-5);
    EXPECT_NEAR(value("C.green", functions).x, 0.6, 1e-6);
    EXPECT_NEAR(value("C.transmit", functions).x, 0.333333343, 1e-6);
    EXPECT_NEAR(value("H(1, 0.2, 0.3)", functions).x, 0.689955851, 4e-5);
    EXPECT_NEAR(value("K(1, 0, 0)", functions).x, 0.575600025, 1e-6);
    EXPECT_NEAR(value("N(0.3, 0.7, 0.1)", functions).x, 0.395001395, 1e-7);
    EXPECT_NEAR(value("M(0.3, 0.7, 0.1, 1)", functions).x, 0.253942565, 1e-7);
    const std::string fractals =
        "#declare R = function { internal(59) }; #declare H = function { internal(29) };";
    EXPECT_NEAR(value("R(0.3, 0.7, 0.15, 0.8, 2, 4, 0.9, 1.5, 2)", fractals).x, 0.902440869, 1e-6);
    EXPECT_NEAR(value("R(0.3, 0.7, 0.15, 0.8, 2, 1, 0.9, 1.5, 1)", fractals).x, 0.20826027, 1e-6);
    EXPECT_NEAR(value("H(0.3, 0.7, 0.15, 0.8, 2, 3, 0.9, 0.6, 2)", fractals).x, 1.581838639, 1e-6);
    EXPECT_NEAR(value("H(0.3, 0.7, 0.15, 0.8, 2, 3, 0.9, 2, 2)", fractals).x, 1.314912804, 1e-6);
    const dvec3 turbulence = value("vturbulence(2.1, 0.4, 5, <0.3, 0.7, 0.1>)");
    EXPECT_LT(glm::length(turbulence - dvec3(-0.206909763, -0.414561417, -0.09054023)), 1e-6);
}

/// povray 3.7.0.10 prints these values.
TEST(PovExpression, FunctionsLookAtPictures) {
    const TestFolder folder;
    folder.write("a.png", png_of(2, 1, {255, 0, 0, 255, 0, 0, 255, 51}));
    const auto red_of = [&](const std::string& function, const std::string& call) {
        const Result<Scene> scene = load(folder.write(
            "a.pov", "#version 3.7; global_settings { assumed_gamma 1 }\n#declare F = function { " +
                         function + " }; #declare V = " + call +
                         "; sphere { 0, 1 pigment { rgb <V, 0, 0> } }"));
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        return scene ? scene->materials.at(0).color.x : -1;
    };
    const auto pattern = [](const std::string& words) {
        return "pattern { image_pattern { png \"a.png\" " + words + " } }";
    };
    EXPECT_NEAR(red_of(pattern(""), "F(0.2, 0.5, 0)"), 0.297, 1e-6);
    EXPECT_NEAR(red_of(pattern(""), "F(-0.3, 0.5, 0)"), 0.114, 1e-6);
    EXPECT_NEAR(red_of(pattern("once"), "F(-0.3, 0.5, 0)"), 0, 1e-6);
    EXPECT_NEAR(red_of(pattern("interpolate 2"), "F(0.45, 0.5, 0)"), 0.2238, 1e-4);
    EXPECT_NEAR(red_of(pattern("interpolate 2 once"), "F(0.2, 0.5, 0)"), 0.297, 1e-4);
    EXPECT_NEAR(red_of(pattern("use_alpha"), "F(0.7, 0.5, 0)"), 0.8, 1e-6);
    const std::string map = "pigment { image_map { png \"a.png\" interpolate 2 } }";
    EXPECT_NEAR(red_of(map, "F(0.45, 0.5, 0).red"), 0.6, 1e-4);
    EXPECT_NEAR(red_of(map, "F(0.7, 0.5, 0).transmit"), 0.72, 1e-4);
}

/// povray 3.7.0.10 prints these values. Ours may differ on julia_fractal because of facets.
TEST(PovExpression, TraceMeetsSurfacesWherePovRayDoes) {
    const std::string box =
        "#declare N = x; #declare S = box { -1, 1 rotate 90*y scale <1, 1, -2> }";
    EXPECT_VALUE(dvec3(0, 0, -2), "trace(S, -5*z, z, N) + 0 * N", box);
    EXPECT_VALUE(dvec3(0, 0, -1), "N", box + "#declare P = trace(S, -5*z, 3*z, N);");
    EXPECT_VALUE(dvec3(0), "trace(S, -5*z, x, N)", box);
    EXPECT_VALUE(dvec3(0), "N", box + "#declare P = trace(S, -5*z, x, N);");
    EXPECT_VALUE(dvec3(1, 2, 0), "trace(P, <1, 9, 0>, -y)", "#declare P = plane { y, 2 no_image }");
    EXPECT_VALUE(dvec3(0, 1, 0), "N",
                 "#declare P = plane { y, 2 }; #declare V = trace(P, <1, 9, 0>, -y, N);");
    const std::string c = "<-0.08, 0.1, -0.83, -0.03>";
    const std::pair<std::string, double> kJuliaSets[] = {
        {c + " quaternion max_iteration 3 slice <0, 0.3, 0.1, 1>, 0.2", -1.039884},
        {c + " hypercomplex max_iteration 3", -1.247108}};
    for (const auto& [set, depth] : kJuliaSets)
        EXPECT_NEAR(
            value("trace(J, <0.1, 0.2, -5>, z)", "#declare J = julia_fractal { " + set + " }").z,
            depth, 0.002)
            << set;
    const std::string balls = "#declare S = union { #for (I, 0, 40) sphere { I * x, 0.5 } #end }";
    const double height = std::sqrt(0.25 - 0.04 - 0.01);
    EXPECT_VALUE(dvec3(30.2, height, 0.1), "trace(S, <30.2, 5, 0.1>, -y)", balls);
    EXPECT_VALUE(2.0 * dvec3(0.2, height, 0.1), "N",
                 balls + "#declare P = trace(S, <30.2, 5, 0.1>, -y, N);");
}

TEST(PovExpression, TraceMeetsRoundShapesExactly) {
    const std::string shapes = "#declare N = x; #declare C = cone { 0, 2, 2 * y, 1 };"
                               "#declare O = cone { 0, 2, 2 * y, 1 open };"
                               "#declare Y = cylinder { 0, y, 1 rotate -90 * z scale <3, 1, 1> };"
                               "#declare I = sphere { 0, 1 inverse };";
    EXPECT_VALUE(dvec3(1.5, 1, 0), "trace(C, <9, 1, 0>, -x)", shapes);
    EXPECT_VALUE(dvec3(2, 1, 0) / std::sqrt(5.0), "N",
                 shapes + "#declare P = trace(C, <9, 1, 0>, -x, N);");
    EXPECT_VALUE(dvec3(0.5, 2, 0), "trace(C, <0.5, 9, 0>, -y)", shapes);
    EXPECT_VALUE(dvec3(0), "trace(O, <0.5, 9, 0>, -y)", shapes);
    EXPECT_VALUE(dvec3(2.5, 0.8, 0.6), "trace(Y, <2.5, 9, 0.6>, -y)", shapes);
    EXPECT_VALUE(dvec3(3, 0.1, 0.2), "trace(Y, <9, 0.1, 0.2>, -x)", shapes);
    EXPECT_VALUE(1, "vlength(N) * (N.y < 0)",
                 shapes + "#declare P = trace(I, <0.3, 9, 0.2>, -y, N);");
    EXPECT_VALUE(3,
                 "inside(C, <1.4, 1, 0>) + inside(Y, <2.9, 0, 0.9>) + inside(O, 0.1 * y) +"
                 "inside(C, <1.6, 1, 0>) + inside(Y, <3.1, 0, 0>)",
                 shapes);
}

TEST(PovExpression, InsideKnowsSolidsGroupsAndHalfSpaces) {
    const std::string shapes = "#declare P = plane { y, 2 }; #declare B = box { -1, 1 scale 2 };"
                               "#declare D = difference { object { B } sphere { 0, 1 } };"
                               "#declare U = union { object { B } sphere { 1.5 * x, 1 } };";
    const std::pair<const char*, int> kAsked[] = {
        {"P, 1", 1},       {"P, 3", 0},           {"B, <1.9, -1.9, 0>", 1}, {"B, <2.1, 0, 0>", 0},
        {"D, 0", 0},       {"D, <1.2, 0, 0>", 1}, {"U, 1.2 * x", 1},        {"U, 2.4 * x", 1},
        {"U, 2.6 * x", 0}, {"U, -1.9", 1}};
    for (const auto& [asked, expected] : kAsked)
        EXPECT_EQ(value("inside(" + std::string(asked) + ")", shapes).x, expected) << asked;
}

/// povray 3.7.0.10 prints these values for #debug str(rand(seed(1)), 0, 9) and the next number.
TEST(PovExpression, RandomNumbersAreThoseOfPovRay) {
    const std::string stream = "#declare R = seed(1);";
    EXPECT_VALUE((1812433253u * 1u + 12345u) / 4294967295.0, "rand(R)", stream);
    EXPECT_VALUE((1812433253u * (1812433253u + 12345u) + 12345u) / 4294967295.0, "rand(R)",
                 stream + "#declare Q = rand(R);");
}

/// povray 3.7.0.10 prints these values.
TEST(PovExpression, SplinesAreThoseOfPovRay) {
    const auto spline = [](const std::string& kind) {
        return "#declare S = spline { " + kind +
               " 0, <0, 0, 0>, 1, <1, 2, 0>, 2, <0, 3, 0>, 3, <4, 4, 0> }";
    };
    EXPECT_VALUE(dvec3(0.3125, 2.5625, 0), "S(1.5)", spline("cubic_spline"));
    EXPECT_VALUE(dvec3(0.275, 2.575, 0), "S(1.5)", spline("natural_spline"));
    EXPECT_VALUE(dvec3(0.75, 2.625, 0), "S(1.5)", spline("quadratic_spline"));
    EXPECT_VALUE(dvec3(0.5, 2.5, 0), "S(1.5)", spline("linear_spline"));
    for (const char* before : {"S(-1)", "S(0.4)", "S(1)"})
        EXPECT_VALUE(dvec3(1, 2, 0), before, spline("cubic_spline"));
    for (const char* behind : {"S(2)", "S(2.6)", "S(9)"})
        EXPECT_VALUE(dvec3(0, 3, 0), behind, spline("cubic_spline"));
    EXPECT_VALUE(dvec3(0.5, 1, 0), "S(0.9)",
                 "#declare S = spline { cubic_spline 0, <0, 0, 0>, 1, <1, 2, 0> }");
    // Clocks that lie apart unevenly, and the same points by splines of other kinds.
    const std::string uneven =
        "#declare S = spline { cubic_spline -1, 0, 0, 0, 1, 1, 3, 0.5, 4, 2, 7, 1 }";
    EXPECT_VALUE(0.515625, "S(0.5)", uneven);
    EXPECT_VALUE(0.879125, "S(3.3)", uneven);
    EXPECT_VALUE(0.95, "S(3.3, linear_spline)", uneven);
    EXPECT_VALUE(0.8275, "S(3.3, quadratic_spline)", uneven);
    EXPECT_VALUE(-0.125, "S(-0.5, quadratic_spline)", uneven);
    EXPECT_LT(std::abs(value("S(2, natural_spline)", uneven).x - 0.66894019), 1e-8);
    EXPECT_FALSE(parse(uneven + " box { 0, S(2, linear) }"));
}

TEST(PovDirectives, MacrosTakeValuesAndVariables) {
    EXPECT_VALUE(5, "Less(7, 2)", "#macro Less(A B) (A - B) #end");
    EXPECT_VALUE(6, "Twice(3)", "#macro Twice(A) (2 * A) #end");
    EXPECT_VALUE(9, "Out", "#macro Set(A, B) #declare A = B * B; #end Set(Out, 3)");
    EXPECT_VALUE(3, "I", "#declare I = 3; #macro M() #local I = 7; #end M()");
    // Five() still runs when its value is known, and has a Q of its own.
    EXPECT_VALUE(6, "M()",
                 "#macro Five() #local Q = 5; #if (1) Q; #else 0; #end #end\n"
                 "#macro M() #local Q = 1; #local P = Five() #local Q = Five() (P + 1) #end");
    EXPECT_VALUE(24, "Factorial(4)",
                 "#macro Factorial(N) #if (N <= 1) 1 #else (N * Factorial(N - 1)) #end #end");
}

/// povray 3.7.0.10 prints these values.
TEST(PovDirectives, MacrosGiveTheirOwnVariablesAsArguments) {
    const std::string macros = "#macro Own(X) #local Q = X; Q #end #macro Of() G #end\n"
                               "#macro Tell(A, B) #declare T = A * B; #end\n"
                               "#macro Set(A) #declare A = 7; #end #declare G = 1;\n";
    EXPECT_VALUE(15, "T", macros + "Tell(Own(3), Own(5))");
    EXPECT_VALUE(20, "T", macros + "Tell(Own(3) + 1, Own(Own(5)))");
    EXPECT_VALUE(7, "G", macros + "Set(Of())");
    // The macros end as the word behind A is looked at.
    EXPECT_VALUE(8, "B[1]",
                 "#macro In() #local A = array[2] { 7, 8 } A #end #macro Out() In() #end\n"
                 "#declare B = Out()");
}

TEST(PovDirectives, LoopsAndConditionsNest) {
    EXPECT_VALUE(10, "Sum", "#declare Sum = 0; #for (I, 1, 4) #declare Sum = Sum + I; #end");
    EXPECT_VALUE(3, "N",
                 "#declare N = 0; #while (1) #declare N = N + 1; #if (N = 3) #break #end #end");
    EXPECT_VALUE(20, "V",
                 "#switch (3) #case (1) #declare V = 10; #break #range (2, 4) #declare V = 20; "
                 "#break #else #declare V = 30; #end");
    EXPECT_VALUE(2, "V",
                 "#ifdef (Nothing) #declare V = 1; #elseif (0) #error \"no\" #else #declare V = 2; "
                 "#end");
    EXPECT_VALUE(7, "A[1][0]", "#declare A = array[2][2]; #declare A[1][0] = 7;");
    EXPECT_VALUE(4, "dimension_size(A, 1)", "#declare A = array[4] { 1, 2, 3, 4 }");
}

TEST(PovDirectives, FilesAreReadAndWhatIsWrittenIsReadAgain) {
    const TestFolder folder;
    const std::string data = folder.write("data.txt", "1.5, -2e0 <3, 4, 5>,\n \"six\"\n").string();
    EXPECT_VALUE(dvec3(4.5, 6, 7.5), "V * A",
                 "#fopen F \"" + data + "\" read #read (F, A, B, V) #read (F, S) #fclose F");
    EXPECT_VALUE(-2 + 3, "N[1] + strlen(S)",
                 "#declare N = array[2] #fopen F \"" + data +
                     "\" read #read (F, N[0], N[1]) #read (F, V, S)");
    EXPECT_VALUE(
        6, "Sum",
        "#fopen F \"new.txt\" write #write (F, 1, \",\", 2, \", \\n\", 3, \"\\n\") #fclose F\n"
        "#declare Sum = 0; #fopen G \"new.txt\" read\n"
        "#while (defined(G)) #read (G, X) #declare Sum = Sum + X; #end");
    EXPECT_FALSE(std::filesystem::exists("new.txt"));
}

TEST(PovDirectives, DeclarationsNeedNoSemicolon) {
    EXPECT_VALUE(5, "B", "#declare A = 5\n#declare B = A\n");
    EXPECT_VALUE(5, "B", "#\n#declare A = 5 #; #\n # declare B = A # \n");
    EXPECT_VALUE(1, "1", "declare Old = 3 /* a /* nested */ comment */");
}

TEST(PovDirectives, MacrosTakeTheVariableThatEndsBeforeThem) {
    // The macro is found while the texture's next layer is looked for.
    const Result<Scene> scene = parse("#macro M(Look) sphere { 0, 1 texture { Look } } #end\n"
                                      "#declare T = texture { pigment { rgb x } }\nM(T)");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->materials.at(0).color, vec3(1, 0, 0));
}

TEST(PovDirectives, WhatStandsBehindANameMayChangeIt) {
    // A macro that ends with a declaration has ended before the value is assigned.
    EXPECT_VALUE(10, "A[1]",
                 "#macro Set(To, I) #declare To[I] = I * 10 #end #declare A = array[2]; Set(A, 1)");
    EXPECT_VALUE(3, "3", "#macro M() #local A = array[2] #declare A[1] = 7 #end M()");
    EXPECT_VALUE(4, "A[1]",
                 "#macro M() #declare A = array[2] { 3, 4 } 0 #end #declare A = array[1] { 9 }\n"
                 "#declare A[M()] = 5;");
    EXPECT_VALUE(7, "B[0]", "#declare A = array[1] { 7 } #declare B = A #declare A[0] = 8;");
    const char* const kLost[] = {
        "#macro M() #declare A = 5; 0 #end #declare A = array[2] { 1, 2 } #declare V = A[M()];",
        "#macro M() #declare A = array[1] 1 #end #declare A = array[2] { 1, 2 }\n"
        "#declare V = A[M()];",
        "#macro M() #declare F = 5; 0 #end #declare F = function { x }\n#declare V = F(M(), 0, 0);",
        "#macro M() #declare S = 5; 0 #end #declare S = spline { 0, 1 }\n#declare V = S(M());",
        "#macro M() #declare F = 5; 0 #end #fopen F \"f.txt\" write #write (F, M())"};
    for (const char* text : kLost) {
        const Result<Scene> scene = parse(text);
        ASSERT_FALSE(scene) << text;
        EXPECT_TRUE(scene.error().message.find("changes") != std::string::npos ||
                    scene.error().message.find("closes") != std::string::npos)
            << scene.error().message;
    }
}

/// povray 3.7.0.10 gives these values with `#version 3.1`.
TEST(PovDirectives, EndDeclarationsWithoutSemicolon) {
    EXPECT_VALUE(5, "X", "#declare X = 0 #while (X < 5) #declare X = X + 1 #end");
    EXPECT_VALUE(3, "X",
                 "#declare X = 1\n#declare X = 1 + X #while (X = 2) #declare X = X + 1 #end");
    EXPECT_VALUE(7, "Y", "#declare X = 5 #if (X = 5) #declare Y = 7 #else #declare Y = 8 #end");
    EXPECT_VALUE(7, "Y", "#declare X = 5 #switch (X) #case (5) #declare Y = 7 #break #end");
    EXPECT_VALUE(6, "Y", "#declare Y = 0; #declare X = 3 #for (I, 1, X) #declare Y = Y + I #end");
    EXPECT_VALUE(4, "Y", "#declare Y = (1 #if (1) + 3 #else + 4 #end);");
    EXPECT_VALUE(5, "V.y", "#declare V = <1, 2 #if (1) + 3 #else + 4 #end, 3>;");
    EXPECT_VALUE(3, "Y", "#declare Y = (1 #local Z = 2; + Z);");
    EXPECT_VALUE(8, "max_extent(O).y",
                 "#declare O = sphere { 0, 1 translate 3*y #if (1) + 4*y #end scale 1 }");
    EXPECT_VALUE(3, "Y", "#declare Y = #if (1) 3 #else 4 #end;");
    EXPECT_VALUE(4, "Y", "#macro M() #if (1) 3 #else 4 #end #end #declare Y = M() + 1;");
}

TEST(PovDirectives, IncludesMayBeEmpty) {
    const TestFolder folder;
    folder.write("nothing.inc", "");
    const auto scene = load(folder.write("main.pov", "#include \"nothing.inc\"\nsphere { 0, 1 }"));
    EXPECT_GT(triangles_of(scene).size(), 100u);
}

TEST(PovDirectives, LoopsWithoutAnEndAreRefusedAtOnce) {
    const std::pair<const char*, const char*> cases[] = {
        {"#while (1) #end", "x.pov:2:1: stopped after a round that changed nothing"},
        {"#while (X < 3) sphere { X*x, 1 } #end", "x.pov:2:1: stopped after a round that changed"},
        {"#while (X < 3) #declare Y = X; #end", "x.pov:2:1: stopped after "},
        {"#for (I, 0, 1e15) #end", "x.pov:2:1: stopped after "},
        {"#while (X < 3) #declare X = X - 1; #end", "x.pov:2:1: stopped after "},
        {"#while (X > -1) sphere { X*x, 1 } #declare X = X + 1; #end", "x.pov:2:"}};
    for (const auto& [loop, message] : cases) {
        const Stopwatch watch;
        const Result<Scene> scene = parse("#declare X = 0;\n" + std::string(loop));
        ASSERT_FALSE(scene) << loop;
        EXPECT_TRUE(scene.error().message.starts_with(message)) << scene.error().message;
        std::printf("%-60s %.2f s\n", loop, watch.seconds());
    }
    EXPECT_VALUE(1, "X",
                 "#declare X = 0; #declare R = seed(3);\n"
                 "#while (X = 0) #if (rand(R) < .001) #declare X = 1; #end #end");
}

TEST(PovDirectives, IncludesAreFoundWhateverTheirLettersAndSlashes) {
    const TestFolder folder;
    std::filesystem::create_directories(folder / "Geom");
    folder.write("Geom/Ball.INC", "#local R = 2; #declare Ball = sphere { 0, R }");
    const auto scene =
        load(folder.write("main.pov", "#include \"geom\\ball\"\nobject { Ball }\n#ifdef (R) #error "
                                      "\"a #local of an include is seen outside\" #end"));
    EXPECT_GT(triangles_of(scene).size(), 100u);
    std::filesystem::remove_all(folder / "Geom");
}

/// Some of the files need the names of colors.inc and shapes.inc, for povray too.
TEST(PovDirectives, AllIncludeFilesOfPovRayAreRead) {
    const std::filesystem::path library = "/usr/share/povray-3.7/include";
    if (!std::filesystem::exists(library / "colors.inc"))
        GTEST_SKIP() << "povray-includes is not installed";
    for (const auto& entry : std::filesystem::directory_iterator(library)) {
        if (entry.path().extension() != ".inc")
            continue;
        const Result<Scene> scene =
            parse("#include \"colors.inc\"\n#include \"shapes.inc\"\n#include \"" +
                  entry.path().filename().string() + "\"\nsphere { 0, 1 }");
        EXPECT_TRUE(scene) << entry.path() << "\n" << scene.error().message;
    }
}

/// povray 3.7.0 prints these values for #debug str(f_sphere(.3, .4, 1.2, .5), 0, 12) and the like.
TEST(PovExpression, KnowsInternalFunctions) {
    const std::string functions =
        "#declare E = function { internal(17) } #declare P = function { internal(47) } "
        "#declare R = function { internal(57) } #declare B = function { internal(60) } "
        "#declare S = function { internal(61) } #declare Q = function { internal(68) } "
        "#declare T = function { internal(69) } #declare O = function { internal(70) }";
    const std::pair<const char*, double> cases[] = {{"E(.3, .4, 1.2, 2, 3, 4)", 4.983974317751},
                                                    {"P(.3, -.4, 1.2)", 1.883563048736},
                                                    {"R(.3, .4, 1.2)", 1.3},
                                                    {"B(1.3, .4, 1.2, .1, 1, 1, 1)", 0.399999},
                                                    {"B(.3, .95, .97, .1, 1, 1, 1)", -0.013978},
                                                    {"B(-.3, -1.95, .97, .2, 1, 2, 1)", 0.026715},
                                                    {"S(.3, .4, 1.2, .5)", 0.8},
                                                    {"Q(1.3, .4, .5, .7, .4)", -0.317592936919},
                                                    {"T(-.3, .4, -1.2)", -2.896613990463},
                                                    {"O(.3, .4, 1.2, 1, .2)", 0.264904963008}};
    for (const auto& [call, expected] : cases) // a rounded box is 1e-6 larger in POV-Ray
        EXPECT_NEAR(value(call, functions).x, expected, 2e-6) << call;
}

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
        const Result<Scene> scene = parse(c.text);
        ASSERT_FALSE(scene) << c.text;
        EXPECT_EQ(scene.error().message, c.message);
    }
}

TEST(PovErrors, TellWhichLineOfTheSceneLedThere) {
    const Result<Scene> called = parse("#macro In(R) sphere { 0, R + Z } #end\n"
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
    EXPECT_TRUE(parse("#declare D = polynomial { 4, <0, 0, 0> } sphere { 0, 1 }"));
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

TEST(PovScene, ReadsLightsCameraAndSettings) {
    const Result<Scene> scene = parse(
        "camera { location <0, 0, -5> direction 2*z right -x*2 up y }\n"
        "light_source { <1, 2, 3> rgb <0.5, 1, 1> spotlight point_at <1, 0, 3> radius 10 falloff "
        "20 }\n"
        "global_settings { max_trace_level 9 ambient_light 2 }\nbackground { rgb <0, 0, 1> }\n"
        "sphere { 0, 1 pigment { rgbt <1, 0, 0, 0.5> } finish { ambient 0.1 diffuse 0.8 reflection "
        "0.3 } interior { ior 1.4 } no_shadow }");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->camera->eye, dvec3(0, 0, -5));
    EXPECT_EQ(scene->camera->window->right, dvec3(-2, 0, 0));
    EXPECT_EQ(scene->camera->window->direction, dvec3(0, 0, 2));
    ASSERT_EQ(scene->lights.size(), 1u);
    EXPECT_LT(glm::length(scene->lights[0].direction - dvec3(0, -1, 0)), 1e-12);
    EXPECT_NEAR(scene->lights[0].cone->falloff_cosine, std::cos(20 * 3.14159265358979 / 180), 1e-9);
    EXPECT_EQ(scene->max_depth, 8u); // the camera's ray is the first
    EXPECT_EQ(scene->background.zenith, vec3(0, 0, 1));
    ASSERT_EQ(scene->materials.size(), 1u);
    const Material& material = scene->materials[0];
    EXPECT_NEAR(material.finish->diffuse, 0.4, 1e-6) << "half of the light goes through";
    EXPECT_NEAR(material.finish->ambient.x, 0.1, 1e-6);
    EXPECT_EQ(material.finish->reflection, vec3(0.3f));
    EXPECT_NEAR(material.transmission, 0.5, 1e-6);
    EXPECT_EQ(material.ior, 1.4);
    EXPECT_EQ(scene->soup.chunks[0].mask(), kSeenByCamera | kSeenInReflections);
}

TEST(PovScene, FocalBlurIsALens) {
    const std::string camera = "sphere { 0, 1 } camera { location -5*z direction 2*z right 4*x "
                               "aperture 0.5 focal_point <7, 1, 1> ";
    const Result<Scene> scene = parse(camera + "blur_samples 4, 30 }");
    ASSERT_TRUE(scene && scene->camera->lens);
    EXPECT_EQ(*scene->camera->lens, (Lens{dvec3(0.125, 0, 0), dvec3(0, 0.125, 0), 3}));
    EXPECT_EQ(scene->samples, 30u);
    EXPECT_FALSE(parse(camera + "}")->camera->lens) << "as povray, without blur_samples";
}

TEST(PovScene, MeshCamerasHaveFaces) {
    const std::string mesh =
        "#declare M = mesh { triangle { 0, x, y } triangle { 0, y, z uv_vectors <0, 0>, <0, 1>, "
        "<1, 1> } } sphere { 0, 1 }";
    const Result<Scene> scene = parse(mesh + "camera { mesh_camera { 2 1 mesh { M translate 5*x } "
                                             "mesh { M } } location -0.5*z direction -z }");
    ASSERT_TRUE(scene && scene->faces) << scene.error().message;
    EXPECT_TRUE(scene->camera->by_faces);
    EXPECT_EQ(scene->samples, 2u);
    EXPECT_EQ(scene->faces->order, FaceCamera::Order::OneAfterAnother);
    EXPECT_EQ(scene->faces->ahead, -0.5);
    EXPECT_TRUE(scene->faces->backwards);
    ASSERT_EQ(scene->faces->meshes.size(), 2u);
    EXPECT_EQ(scene->faces->meshes[0].corners[0],
              (std::array<dvec3, 3>{dvec3(5, 0, 0), dvec3(6, 0, 0), dvec3(5, 1, 0)}));
    EXPECT_TRUE(scene->faces->meshes[0].uv.empty() && scene->faces->meshes[0].normals.empty());
    const Result<Scene> baking =
        parse(mesh + "camera { mesh_camera { 1 3 mesh { M } smooth } location 0.01*z }");
    EXPECT_EQ(baking->faces->meshes[0].uv[1],
              (std::array<vec2, 3>{vec2(0, 0), vec2(0, 1), vec2(1, 1)}));
    EXPECT_EQ(baking->faces->meshes[0].normals[0][2], vec3(0, 0, -1));
    EXPECT_FALSE(parse("camera { mesh_camera { 1 0 } }"));
}

TEST(PovScene, InteriorsHaveMedia) {
    const std::string media =
        "#declare D = density { spherical };"
        "#declare F = media { emission 0.1 intervals 2 samples 20 density { D translate x } };"
        "#declare S = sphere { 0, 1 pigment { rgbt 1 } interior { media { F } "
        "media { scattering { 5, 0.2 eccentricity 0.4 extinction 0 } absorption <1, 2, 3> } } };"
        "light_source { 9, 1 media_interaction off media_attenuation on } ";
    const Result<Scene> scene = parse(media + "object { S scale 3 hollow } media { absorption 2 }");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->materials.at(0).media.size(), 2u);
    const Medium &glow = scene->materials[0].media[0], &fog = scene->materials[0].media[1];
    EXPECT_EQ(glow.samples, 11u) << "half as many, and one more";
    EXPECT_EQ(glow.intervals, 2u);
    EXPECT_EQ(fog.samples, 6u) << "povray's default";
    ASSERT_EQ(glow.densities.size(), 1u);
    EXPECT_LT(glm::length(glow.densities[0].at(dvec3(3, 0, 0))), 1e-12) << "it moves along";
    EXPECT_EQ(fog.phase, Medium::Phase::HenyeyGreenstein);
    EXPECT_EQ(fog.extinction, 0);
    EXPECT_EQ(fog.absorption, vec3(1, 2, 3));
    EXPECT_FALSE(scene->lights[0].lights_media);
    EXPECT_TRUE(scene->lights[0].fades_in_air);
    EXPECT_TRUE(scene->materials[0].hollow);
    EXPECT_EQ(scene->background.media.at(0).absorption, vec3(2));
    EXPECT_TRUE(parse(media + "object { S }")->materials.at(0).media.empty()) << "not hollow";
    EXPECT_FALSE(parse(media + "object { S }")->materials.at(0).hollow);
    EXPECT_TRUE(scene->omissions.empty());
}

TEST(PovScene, LightsAreProjectedThroughObjects) {
    const Result<Scene> scene = parse("#declare S = sphere { y, 1 pigment { rgb 1 } } light_source "
                                      "{ 5*y, 1 projected_through { S } translate x }");
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->meshes.empty()) << "it is not seen";
    const std::optional<Region>& projector = scene->lights.at(0).projector;
    ASSERT_TRUE(projector);
    EXPECT_NEAR(projector->first_crossing({1, -3, 0}, {0, 1, 0}, 0), 3, 1e-9);
    EXPECT_TRUE(std::isinf(projector->first_crossing({-0.5, -3, 0}, {0, 1, 0}, 0)));
    EXPECT_TRUE(scene->omissions.empty());
    EXPECT_FALSE(parse("light_source { y, 1 projected_through { 3 } }"));
}

TEST(PovScene, AreaLightsAreGrids) {
    const Result<Scene> scene =
        parse("sphere { 0, 1 } light_source { y, rgb 6 area_light 4*x, 2*z, "
              "3, 2 adaptive 1 translate 5*y }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->lights.size(), 6u);
    for (const Light& light : scene->lights)
        EXPECT_EQ(light.position, dvec3(0, 6, 0)) << "all of them shine from the middle";
    EXPECT_EQ(scene->lights[0].shadow_offset, dvec3(-2, 0, -1));
    EXPECT_EQ(scene->lights[5].shadow_offset, dvec3(2, 0, 1));
    EXPECT_FLOAT_EQ(scene->lights[0].color.x, std::numbers::pi_v<float>);
    EXPECT_TRUE(scene->omissions.empty());
    const std::string spot = "light_source { 5*y, 1 spotlight point_at 0 area_light 10*x, z, 2, 1 ";
    EXPECT_EQ(parse(spot + "translate x }")->lights.at(0).direction, dvec3(0, -1, 0));
    const Result<Scene> spots = parse(spot + "area_illumination on translate x }");
    EXPECT_EQ(spots->lights.at(0).position, dvec3(-4, 5, 0));
    EXPECT_LT(glm::length(spots->lights.at(0).direction - glm::normalize(dvec3(5, -5, 0))), 1e-12);
    const Result<Scene> round = parse("light_source { 0, 1 area_light 2*x, 2*y, 3, 3 circular }");
    EXPECT_NEAR(glm::length(round->lights.at(0).shadow_offset), 1, 1e-12) << "a corner";
    EXPECT_EQ(round->lights.at(1).shadow_offset, dvec3(-1, 0, 0));
    const Result<Scene> facing =
        parse("light_source { 0, 1 area_light 2*x, y, 2, 2 orient translate z }");
    EXPECT_TRUE(facing->lights.at(0).faces_places);
    EXPECT_NEAR(glm::length(facing->lights.at(0).shadow_offset), 1, 1e-12) << "as wide as long";
    EXPECT_EQ(facing->lights.at(0).area_points, 4u);
}

TEST(PovScene, DefaultsAreOfObjectsThatEndBehindThem) {
    const Result<Scene> scene =
        parse("#default { pigment { rgb y } } sphere { 0, 1 } "
              "#declare Mesh = mesh { triangle { 0, x, y } } #declare Ball = sphere { 0, 1 } "
              "#declare Bright = sphere { 0, 1 finish { ambient 1 } } "
              "#default { pigment { rgb x } } object { Mesh } union { object { Ball } } "
              "object { Bright } union { sphere { 9, 1 } #default { pigment { rgb z } } }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 4u);
    EXPECT_EQ(scene->materials[0].color, vec3(0, 1, 0));
    EXPECT_EQ(scene->materials[1].color, vec3(1, 0, 0)) << "those that were declared before";
    EXPECT_EQ(scene->materials[2].color, vec3(0, 1, 0)) << "the rest of a texture, as it was read";
    EXPECT_EQ(scene->materials[3].color, vec3(0, 0, 1));
}

/// Many lights are drawn by fewer, which lie as far from the middle as those do on average.
TEST(PovScene, LargeAreaLightsAreDrawnByFewer) {
    const auto moment = [](const std::string& words) {
        const Result<Scene> scene = parse("light_source { y, 1 area_light 10*x, z, " + words + "}");
        double sum = 0;
        for (const Light& light : scene->lights)
            sum += light.shadow_offset.x * light.shadow_offset.x / double(scene->lights.size());
        return std::pair(scene->lights.size(), sum);
    };
    const double of_17 = 100.0 / 12 * 18 / 16, cell = 100.0 / 12 / (16 * 16);
    EXPECT_EQ(moment("17, 1").first, 17u);
    EXPECT_EQ(moment("17, 17").first, 144u);
    EXPECT_EQ(moment("1000, 4").first, 144u);
    EXPECT_NEAR(moment("17, 1").second, of_17, 1e-9);
    EXPECT_NEAR(moment("17, 17").second, of_17, 1e-9);
    EXPECT_NEAR(moment("17, 17 jitter").second, of_17 + cell, 1e-9);
}

TEST(PovWarnings, AreCountedOrErrors) {
    const std::string text = "sphere { 0, 1 pigment { tiling 26 } }\n"
                             "sphere { 0, 1 pigment { tiling 25 } }\nphotons { }";
    const Result<Scene> scene = parse(text);
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

TEST(PovScene, GetsNoLightThatItDoesNotHave) {
    const Result<Scene> scene = parse("sphere { 0, 1 finish { ambient 0.2 } }");
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->lights.empty());
    EXPECT_FALSE(scene->may_add_light);
}

/// Returns the material of a box with this look, which povray 3.7.0.10 accepts as well.
Material material_of_box(const std::string& look) {
    const Result<Scene> scene =
        parse("#declare P = pigment { rgb <1, 0.5, 0> }; #declare F = finish { ambient 0.3 };"
              "#declare N = normal { bumps 1 }; #declare T = texture { pigment { rgb z } finish { "
              "ambient 0.7 } }\nbox { -1, 1 " +
              look + " }");
    if (!scene || scene->meshes.size() != 1) {
        ADD_FAILURE() << look << ": " << (scene ? "no single mesh" : scene.error().message);
        return {};
    }
    return scene->materials[scene->meshes[0].material];
}

TEST(PovScene, TexturesTakePigmentsAndFinishesByName) {
    const vec3 orange(1, 0.5f, 0);
    EXPECT_EQ(material_of_box("texture { P }").color, orange);
    EXPECT_EQ(material_of_box("texture { P F }").finish->ambient, vec3(0.3f));
    EXPECT_EQ(material_of_box("texture { F P }").color, orange);
    EXPECT_EQ(material_of_box("texture { P N F }").finish->ambient, vec3(0.3f));
    EXPECT_EQ(material_of_box("texture { P finish { ambient 0.2 } }").finish->ambient, vec3(0.2f));
    const Material changed = material_of_box("texture { T P }");
    EXPECT_EQ(changed.color, orange);
    EXPECT_EQ(changed.finish->ambient, vec3(0.7f));
}

TEST(PovErrors, NamesOfNothingAreNotPassedOver) {
    for (const char* look : {"texture { Banana }", "pigment { Banana }", "finish { Banana }",
                             "interior { Banana }", "texture { pigment { rgb 1 } O }"}) {
        const Result<Scene> scene =
            parse("#declare O = sphere { 0, 1 }\nbox { 0, 1 " + std::string(look) + " }");
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
        const Result<Scene> read = parse(scene);
        ASSERT_FALSE(read) << scene;
        EXPECT_NE(read.error().message.find(": found '"), std::string::npos)
            << read.error().message;
    }
    EXPECT_TRUE(
        parse("camera { locatoin 1 }")
            .error()
            .message.starts_with(
                "x.pov:1:10: found 'locatoin', expected '}' or a part of a camera; did you mean "
                "'location'?\n"));
}

TEST(PovErrors, FlatCamerasSeeLessThanHalfOfEverything) {
    EXPECT_EQ(parse("camera { angle 200 }").error().message,
              "x.pov:1:16: found a camera's angle of 200, expected one above 0 and below 180\n"
              "    camera { angle 200 }\n                   ^");
    EXPECT_FALSE(parse("camera { orthographic angle 180 }"));
    EXPECT_TRUE(parse("camera { fisheye angle 360 }"));
    EXPECT_FALSE(parse("camera { fisheye angle 361 }"));
}

/// Words that stand elsewhere than usual, or that POV-Ray 3.8 added.
TEST(PovScene, WordsThatABlockHasAreTaken) {
    for (const char* scene :
         {"global_settings { charset utf8 assumed_gamma 1 }",
          "isosurface { function { y } contained_by { sphere { 0, 1 } } open max_gradient 4 }",
          "sphere { 0, 1 finish { specular 1 fresnel on } }",
          "sphere { 0, 1 pigment { pavement number_of_sides 3 number_of_tiles 1 pattern 1 } }"}) {
        const Result<Scene> read = parse(scene);
        EXPECT_TRUE(read) << scene << ": " << read.error().message;
    }
}

TEST(PovScene, LightMayComeFromBehind) {
    const auto finish = [](const std::string& object) {
        return *parse("#version 3.7; " + object)->materials.at(0).finish;
    };
    EXPECT_EQ(finish("box { 0, 1 finish { diffuse 0.6, 0.4 } }").diffuse_back, 0.4f);
    EXPECT_EQ(finish("union { box { 0, 1 } double_illuminate }").diffuse_back, 0.6f);
    EXPECT_EQ(finish("box { 0, 1 double_illuminate off }").diffuse_back, 0);
}

TEST(PovScene, TransmitsBelowZeroTurnColorsRound) {
    const Result<Scene> scene = parse("#version 3.7; box { 0, 1 pigment { rgb 0.5 transmit -1 } "
                                      "finish { ambient 1 diffuse 0.5 } }");
    const Material& material = scene->materials.at(0);
    EXPECT_EQ(material.transmission * material.filter, vec3(-1));
    EXPECT_EQ(material.finish->diffuse, 1);
}

/// povray 3.7.0.10 draws `finish { ior 1.2 }` and `interior { ior 1.2 }` alike, with any version.
TEST(PovScene, OldFinishesRefract) {
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } finish { ior 1.5 refraction 1 }").ior, 1.5);
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } interior { ior 1.2 } finish { ior 1.5 }").ior,
              1.5);
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } finish { refraction 0.5 }").transmission, 0.5f);
    EXPECT_EQ(material_of_box("texture { pigment { rgbf 1 } finish { ior 1.2 } } "
                              "texture { pigment { rgbf 1 } finish { ior 1.5 } }")
                  .ior,
              1.5)
        << "the uppermost layer's";
}

TEST(PovScene, FontsThatAreNotThereHaveAStandIn) {
    std::vector<std::string> messages;
    const auto scene =
        parse_pov("text { ttf \"no such font.ttf\" \"A\", 1, 0 }", "x.pov", gather(messages));
    if (!scene)
        GTEST_SKIP() << "no font is installed: " << scene.error().message;
    EXPECT_GT(triangles_of(scene).size(), 10u);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(messages[0].starts_with("x.pov:1:8: found no font 'no such font.ttf'; "))
        << messages[0];
}

TEST(PovScene, VersionsMayComeFromOutside) {
    ImportOptions options;
    options.pov_version = 3.1;
    const std::string ball = "sphere { version*x, 0.1 }";
    EXPECT_NEAR(triangles_of(parse_pov(ball, "x.pov", options))[0][0].x, 3.1, 0.11);
    EXPECT_EQ(parse_pov(ball, "x.pov", {})->gamma, kSrgbGamma);
    options.pov_version = 3.7;
    EXPECT_EQ(parse_pov(ball, "x.pov", options)->gamma, 1) << "colors are light from 3.7 on";
    EXPECT_EQ(parse_pov("#version 3.5;" + ball, "x.pov", options)->gamma, kSrgbGamma);
}

/// povray 3.7.0.10 shows this much of a plane at z = 0.
TEST(PovScene, OrthographicCamerasShowAsMuchAsPovRay) {
    const struct {
        const char* camera;
        double width, height;
    } cases[] = {
        {"location -z*10 look_at 0", 13.3, 10},
        {"location -z*20 look_at 0", 26.6, 20},
        {"location -z*10", 14.63, 11},
        {"location -z*10 direction 2*z look_at 0", 6.65, 5},
        {"location -z*10 look_at 0 right 3*x up 2*y", 3, 2},
        {"location -z*10 look_at 0 direction 2*z right 3*x", 3, 1},
        {"location -z*10 look_at 0 angle 40", 7.279, 5.473},
        {"location -z*10 right 3*x up 2*y look_at 0 angle 40", 7.279, 4.853},
        {"location -z*10 angle 40", 8.007, 6.021},
    };
    for (const auto& c : cases) {
        const Result<Scene> scene =
            parse(std::string("sphere { 0, 1 } camera { orthographic ") + c.camera + " }");
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_NEAR(glm::length(scene->camera->window->right), c.width, 0.001) << c.camera;
        EXPECT_NEAR(glm::length(scene->camera->window->up), c.height, 0.001) << c.camera;
    }
}

TEST(PovScene, ThingsInheritTheLookOfTheirGroup) {
    const Result<Scene> scene =
        parse("union { sphere { 0, 1 } sphere { x, 1 pigment { rgb y } } pigment { rgb x } }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 2u);
    EXPECT_EQ(scene->materials[0].color, vec3(1, 0, 0));
    EXPECT_EQ(scene->materials[1].color, vec3(0, 1, 0));
}

} // namespace
} // namespace ovc
