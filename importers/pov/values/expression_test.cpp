// SPDX-License-Identifier: Apache-2.0
// Tests the values of expressions, against those that povray prints.
#include "importers/pov/test_parse.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace ovc {
namespace {

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

/// povray 3.7.0.10 prints these values.
TEST(PovExpression, ColorsKeepAllComponentsOfVectors) {
    EXPECT_VALUE(0.4, "C.filter", "#declare C = rgb <0.1, 0.2, 0.3, 0.4, 0.5>;");
    EXPECT_VALUE(0.5, "C.transmit", "#declare C = rgb <0.1, 0.2, 0.3, 0.4, 0.5>;");
    EXPECT_VALUE(0.5, "C.transmit", "#declare C = srgbf <0.1, 0.2, 0.3, 0.4, 0.5>;");
    EXPECT_VALUE(0.4, "C.transmit", "#declare C = rgbt <0.1, 0.2, 0.3, 0.4, 0.5>;");
    EXPECT_VALUE(0, "C.filter", "#declare C = rgbt <0.1, 0.2, 0.3, 0.4, 0.5>;");
    EXPECT_VALUE(0, "C.filter + C.transmit", "#declare C = rgb 0.5;");
    EXPECT_VALUE(0.5, "C.filter - C.transmit", "#declare C = rgbf 0.5;");
    EXPECT_VALUE(0, "C.blue", "#declare C = rgb <0.1, 0.2>;");
}

TEST(PovExpression, FunctionsOfArraysAreCalled) {
    const std::string functions =
        "#declare F = array[2][1]; #declare F[0][0] = function (a) { 2 * a };"
        "#declare F[1][0] = function { transform { translate 3*y } }; #declare G = F[0][0];";
    EXPECT_VALUE(7, "V", functions + "#local V = F[0][0](G(1.5)) + 1;");
    EXPECT_VALUE(5, "V", functions + "#declare V = F[1][0](x).y + F[0][0](1);");
}

/// povray 3.7.0.10 prints these values.
TEST(PovExpression, FunctionsAddUpAndMultiply) {
    EXPECT_VALUE(20, "F(2)", "#declare F = function (x) { sum(i, 1, 4, i * x) }");
    EXPECT_VALUE(59.0625, "F(0.5)", "#declare F = function (a) { prod(i, 1, 4, i + a) }");
    EXPECT_VALUE(4.5, "F(0)", "#declare F = function (a) { sum(i, 0.5, 3, i) }");
    EXPECT_VALUE(1, "F(0)", "#declare F = function (a) { prod(i, 3, 1, i) + sum(i, 3, 1, i) }");
    EXPECT_VALUE(8, "F(2)", "#declare F = function (x) { sum(x, 1, 3, x) + x }");
    EXPECT_VALUE(42, "F(2)", "#declare N = 5; #declare F = function (x) { sum(i, 1, N+1, i) * x }");
    EXPECT_VALUE(36, "F(2)",
                 "#declare F = function (a) { sum(i, 1, 3, sum(j, 1, 3, j) * a / i) + "
                 "a * 0 + 14 }");
    const Result<Scene> varies = parsed_scene("#declare F = function (n) { sum(i, 1, n, i) };");
    ASSERT_FALSE(varies);
    EXPECT_NE(varies.error().message.find("as the bound of a sum or product"), std::string::npos);
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
    EXPECT_VALUE(2001, "val(datetime(366.5, \"%Y\"))");
    EXPECT_VALUE(12, "val(substr(datetime(366.5), 12, 2))");
    EXPECT_VALUE(20, "strlen(D)", "#declare D = datetime(366.5);");
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
    EXPECT_NEAR(value_of("F(0.3, 0.7, 0.1)", functions).x, 0.204942349, 2e-5);
    EXPECT_NEAR(value_of("C.green", functions).x, 0.6, 1e-6);
    EXPECT_NEAR(value_of("C.transmit", functions).x, 0.333333343, 1e-6);
    EXPECT_NEAR(value_of("H(1, 0.2, 0.3)", functions).x, 0.689955851, 4e-5);
    EXPECT_NEAR(value_of("K(1, 0, 0)", functions).x, 0.575600025, 1e-6);
    EXPECT_NEAR(value_of("N(0.3, 0.7, 0.1)", functions).x, 0.395001395, 1e-7);
    EXPECT_NEAR(value_of("M(0.3, 0.7, 0.1, 1)", functions).x, 0.253942565, 1e-7);
    const std::string fractals =
        "#declare R = function { internal(59) }; #declare H = function { internal(29) };";
    EXPECT_NEAR(value_of("R(0.3, 0.7, 0.15, 0.8, 2, 4, 0.9, 1.5, 2)", fractals).x, 0.902440869,
                1e-6);
    EXPECT_NEAR(value_of("R(0.3, 0.7, 0.15, 0.8, 2, 1, 0.9, 1.5, 1)", fractals).x, 0.20826027,
                1e-6);
    EXPECT_NEAR(value_of("H(0.3, 0.7, 0.15, 0.8, 2, 3, 0.9, 0.6, 2)", fractals).x, 1.581838639,
                1e-6);
    EXPECT_NEAR(value_of("H(0.3, 0.7, 0.15, 0.8, 2, 3, 0.9, 2, 2)", fractals).x, 1.314912804, 1e-6);
    const dvec3 turbulence = value_of("vturbulence(2.1, 0.4, 5, <0.3, 0.7, 0.1>)");
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
            value_of("trace(J, <0.1, 0.2, -5>, z)", "#declare J = julia_fractal { " + set + " }").z,
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
        EXPECT_EQ(value_of("inside(" + std::string(asked) + ")", shapes).x, expected) << asked;
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
    EXPECT_LT(std::abs(value_of("S(2, natural_spline)", uneven).x - 0.66894019), 1e-8);
    EXPECT_FALSE(parsed_scene(uneven + " box { 0, S(2, linear) }"));
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
        EXPECT_NEAR(value_of(call, functions).x, expected, 2e-6) << call;
}

} // namespace
} // namespace ovc
