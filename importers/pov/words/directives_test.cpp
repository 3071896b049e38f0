// SPDX-License-Identifier: Apache-2.0
// Tests directives: declarations, macros, conditions, loops, and files.
#include "core/system/stopwatch.h"
#include "importers/pov/test_parse.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

namespace ovc {
namespace {

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
    EXPECT_VALUE(14, "A[1] * 2", "#declare A = array[2]; #declare A[1] = 7;");
    EXPECT_VALUE(4, "dimension_size(A, 1)", "#declare A = array[4] { 1, 2, 3, 4 }");
}

/// povray takes any item that has a value, whether the first one has or not.
TEST(PovDirectives, ItemsMayComeBeforeTheFirst) {
    const std::pair<const char*, const char*> kUses[] = {
        {"sphere { 0, 1 }", "object { A[1] }"},
        {"texture { pigment { rgb x } }", "sphere { 0, 1 texture { A[1] } }"},
        {"pigment { rgb x }", "sphere { 0, 1 pigment { A[1] } }"},
        {"finish { ambient 1 }", "sphere { 0, 1 finish { A[1] } }"},
        {"normal { bumps }", "sphere { 0, 1 normal { A[1] } }"},
        {"interior { ior 1.5 }", "sphere { 0, 1 interior { A[1] } }"},
        {"color_map { [0 rgb 1] [1 rgb x] }",
         "sphere { 0, 1 pigment { bozo color_map { A[1] } } }"}};
    for (const auto& [item, use] : kUses) {
        const Result<Scene> scene = parsed_scene(
            "#declare A = array[2]; #declare A[1] = " + std::string(item) + "; " + use);
        EXPECT_TRUE(scene) << item << ": " << scene.error().message;
    }
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

/// As Parse_String of strings.inc does, which writes one file again and again.
TEST(PovDirectives, WhatIsWrittenIsIncluded) {
    const std::string run = "#macro Run(S) #fopen F \"run.tmp\" write #write (F, S) #fclose F\n"
                            "#include \"run.tmp\"\n#end\n";
    EXPECT_VALUE(7, "A + B", run + "Run(\"#declare A = 3;\") Run(\"#declare B = 4;\")");
    EXPECT_VALUE(8, "Twice(4)",
                 run + "Run(\"#macro Twice(X) (2 * X) #end\") Run(\"#declare Twice2 = 1;\")");
    EXPECT_VALUE(2, "file_exists(\"run.tmp\") + 1", run + "Run(\"\")");
    const Result<Scene> endless = parsed_scene(run + R"(Run("#include \"run.tmp\""))");
    ASSERT_FALSE(endless);
    EXPECT_NE(endless.error().message.find("'run.tmp' does not end"), std::string::npos)
        << endless.error().message;
    const Result<Scene> wrong = parsed_scene(run + "Run(\"sphere { 0, }\")");
    ASSERT_FALSE(wrong);
    EXPECT_TRUE(wrong.error().message.starts_with("run.tmp:1:13: ")) << wrong.error().message;
}

TEST(PovDirectives, DeclarationsNeedNoSemicolon) {
    EXPECT_VALUE(5, "B", "#declare A = 5\n#declare B = A\n");
    EXPECT_VALUE(5, "B", "#\n#declare A = 5 #; #\n # declare B = A # \n");
    EXPECT_VALUE(1, "1", "declare Old = 3 /* a /* nested */ comment */");
}

TEST(PovDirectives, MacrosBehindAValueRunOnceItIsDeclared) {
    EXPECT_VALUE(5, "A[0]", "#macro M() #declare A[0] = 5; #end\n#declare A = array[1]\nM()");
    EXPECT_VALUE(3, "B",
                 "#macro M() #declare B = A[0]; #end #declare C = array[1] { 3 };\n"
                 "#declare A = C\nM()");
    EXPECT_VALUE(1, "defined(B)",
                 "#macro M() #declare B = texture { A } #end\n"
                 "#declare C = texture { pigment { rgb 1 } };\n#declare A = C\nM()");
}

TEST(PovDirectives, MacrosBehindATextureRunOnceItIsDeclared) {
    const std::string red = " = texture { pigment { rgb x } }\n";
    const std::string uses =
        "#macro M() #local B = sphere { 0, 1 texture { T } } object { B } #end\n";
    for (const std::string& text :
         {"#macro M(Look) sphere { 0, 1 texture { Look } } #end #declare T" + red + "M(T)",
          uses + "#declare T" + red + "M()", uses + "#macro N() #local T" + red + "M() #end N()",
          uses + "#declare T" + red + "texture { pigment { rgbt 1 } }\nM()",
          uses + "#declare T = texture { pigment { rgb y } } #declare T" + red + "M()",
          "#macro M() #declare T" + red +
              "#end #declare T = texture { pigment { rgb y } }\nM() sphere { 0, 1 texture { T } "
              "}"}) {
        const Result<Scene> scene = parsed_scene(text);
        ASSERT_TRUE(scene) << scene.error().message << text;
        EXPECT_EQ(scene->materials.at(0).color, vec3(1, 0, 0)) << text;
    }
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
        const Result<Scene> scene = parsed_scene(text);
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
        const Result<Scene> scene = parsed_scene("#declare X = 0;\n" + std::string(loop));
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
            parsed_scene("#include \"colors.inc\"\n#include \"shapes.inc\"\n#include \"" +
                         entry.path().filename().string() + "\"\nsphere { 0, 1 }");
        EXPECT_TRUE(scene) << entry.path() << "\n" << scene.error().message;
    }
}

} // namespace
} // namespace ovc
