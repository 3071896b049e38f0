// SPDX-License-Identifier: Apache-2.0
// A PBRT file that streams becomes the same scene file as one that is held; objects that share
// their triangles are held, or refused in a sentence.
#include "importers/expect_stream.h"
#include "tests/file_size_limit.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace ovc {
namespace {

constexpr const char* kCamera =
    "LookAt 0 0 -50  0 0 0  0 1 0 Camera \"perspective\" Film \"image\" "
    "\"integer xresolution\" 64 \"integer yresolution\" 48\n"
    "WorldBegin LightSource \"point\" \"rgb I\" [5 5 5]\n";

/// Returns a mesh of n x n squares, with normals where asked.
std::string grid(size_t n, bool normals = false, const std::string& more = "") {
    std::string points, directions, indices;
    for (size_t i = 0; i <= n; ++i)
        for (size_t j = 0; j <= n; ++j) {
            points += fmt::format("{} {} {} ", double(i) / 3, double(j) / 7, double(i * j % 5) / 9);
            directions += fmt::format("{} 0 {} ", i % 3, j % 4 == 0 ? -1 : 1);
        }
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j) {
            const size_t a = i * (n + 1) + j, b = a + n + 1;
            indices += fmt::format("{} {} {} {} {} {} ", a, b, b + 1, a, b + 1, a + 1);
        }
    return fmt::format("Shape \"trianglemesh\" \"integer indices\" [{}] \"point3 P\" [{}]{}{}\n",
                       indices, points,
                       normals ? fmt::format(" \"normal N\" [{}]", directions) : "", more);
}

std::string moved(double x, const std::string& what) {
    return fmt::format("AttributeBegin Translate {} 0 0 {} AttributeEnd\n", x, what);
}

std::string repeated(size_t count, const std::string& what) {
    std::string text;
    for (size_t i = 0; i < count; ++i)
        text += moved(double(i), what);
    return text;
}

constexpr const char* kRound = "Shape \"sphere\" \"float radius\" 2 Shape \"cylinder\"\n";
constexpr const char* kLoop =
    "Shape \"loopsubdiv\" \"integer nlevels\" 3 \"integer indices\" [0 1 2 "
    "0 3 1 1 3 2 2 3 0] \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1]\n";
constexpr const char* kRed = "Material \"matte\" \"rgb Kd\" [1 0 0]\n";
constexpr const char* kHoles =
    "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.pgm\"\n";

/// Returns a PLY file of n x n squares with normals, some of which point away from their triangles.
std::string ply(size_t n) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty double y\nproperty "
        "float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        (n + 1) * (n + 1), n * n);
    for (size_t i = 0; i <= n; ++i)
        for (size_t j = 0; j <= n; ++j)
            text += fmt::format("{} {} {} 0 {} {}\n", double(i) / 3, 5e5 + double(j) / 7,
                                double(i * j % 5) / 9, i % 3, j % 4 == 0 ? -1 : 1);
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j) {
            const size_t a = i * (n + 1) + j, b = a + n + 1;
            text += fmt::format("4 {} {} {} {}\n", a, b, b + 1, a + 1);
        }
    return text;
}

void write_files(const TestFolder& folder) {
    folder.write("part.pbrt", grid(20, true) + kRound);
    folder.write("a.pgm", "P2\n2 1\n255\n0 255\n");
    folder.write("square.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\n"
                               "property float y\nproperty float z\nelement face 1\nproperty list "
                               "uchar int vertex_indices\nend_header\n1e7 0 0\n10000001.3 0 0\n"
                               "10000001 1 0\n1e7 1 0\n4 0 1 2 3\n");
    folder.write("large.ply", ply(90));
}

TEST(PbrtStream, MakesTheSceneOfAFileThatIsHeld) {
    const TestFolder folder;
    write_files(folder);
    const std::string holes = " \"texture alpha\" \"t\"";
    const std::string light = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] " +
                              grid(3) + "AttributeEnd\n";
    const std::string small = "ObjectBegin \"o\" " + grid(2, true) + "ObjectEnd\n";
    const std::string large = "ObjectBegin \"o\" " + grid(30, true) + kRound + "ObjectEnd\n";
    const std::string large_ply = "Shape \"plymesh\" \"string filename\" \"large.ply\"\n";
    const std::string place = "ObjectInstance \"o\"\n";
    const struct {
        const char* name;
        std::string contents;
    } cases[] = {
        {"none.pbrt", ""},
        {"round.pbrt", std::string(kRound) + kLoop},
        {"large.pbrt", grid(70) + grid(80, true) + grid(3)},
        {"many.pbrt", repeated(600, grid(8, true))},
        {"materials.pbrt", repeated(40, grid(9) + kRed + grid(5, true))},
        {"include.pbrt", repeated(30, "Include \"part.pbrt\"")},
        {"ply.pbrt", moved(3, "Shape \"plymesh\" \"string filename\" \"square.ply\"") + kRound},
        {"plys.pbrt", moved(3, large_ply) + "ReverseOrientation Scale 1 -2 1 " + large_ply + kRed +
                          grid(3) + large_ply +
                          "Shape \"plymesh\" \"string filename\" "
                          "\"large.ply\"" +
                          holes},
        {"mirrored.pbrt", "Scale -1 1 1 " + grid(9, true) + "ReverseOrientation " + kRound},
        {"far.pbrt", moved(1e7, grid(9)) + moved(1e7 + 5, kRound)},
        {"holes.pbrt", kHoles + repeated(9, grid(8, true, holes)) + grid(3, false, holes)},
        {"light.pbrt", light + grid(40)},
        {"tiles.pbrt", small + repeated(50, place) + "Scale 1 -1 1 " + place + grid(5)},
        {"once.pbrt", large + grid(9) + moved(1e4, place)},
    };
    for (const auto& [name, contents] : cases)
        for (const uint64_t bytes : {uint64_t(1) << 30, uint64_t(5) << 20})
            expect_streams_as_it_loads(folder.write(name, kCamera + contents), bytes);
}

Result<Scene> streamed(const std::filesystem::path& path, TriangleSink& sink, uint64_t bytes) {
    const Streaming streaming{sink, bytes, path.parent_path()};
    ImportOptions options;
    options.streaming = &streaming;
    return load(path, options);
}

std::string sentence_of(const TestFolder& folder, const std::string& contents, uint64_t bytes) {
    FullSink sink;
    sink.wanted = 1000;
    const auto path = folder.write("a.pbrt", kCamera + contents);
    const Result<Scene> scene = streamed(path, sink, bytes);
    return scene ? "" : folder.plain(scene.error().message);
}

TEST(PbrtStream, ObjectsThatShareTrianglesAreHeldOrRefused) {
    const TestFolder folder;
    const std::string text =
        "ObjectBegin \"o\" " + grid(30) + "ObjectEnd ObjectInstance \"o\" ObjectInstance \"o\"\n";
    // 1,800 triangles of 500 bytes and two instances of 512.
    EXPECT_EQ(sentence_of(folder, text, 901'023),
              "a.pbrt: found objects that share their triangles, which is built in memory alone: "
              "1800 triangles and 2 instances take 901024 bytes of host memory, and 901023 are "
              "allowed: the smallest number that works is 901024");
    FullSink sink;
    const auto path = folder / "a.pbrt";
    const Result<Scene> scene = streamed(path, sink, 901'024), held = load(path);
    ASSERT_TRUE(scene && held);
    EXPECT_EQ(sink.parts, 0);
    ASSERT_TRUE(write_scene_file(*scene, {}, {}, folder / "a.ovc"));
    ASSERT_TRUE(write_scene_file(*held, {}, {}, folder / "b.ovc"));
    EXPECT_TRUE(folder.read("a.ovc") == folder.read("b.ovc"));
}

/// Its 180,000 triangles take 13 MB as a shape in memory, and its vertices 2.2 MB.
TEST(PbrtStream, APlyFileThatDoesNotFitIsReadInParts) {
    const TestFolder folder;
    folder.write("large.ply", ply(300));
    const std::string shape = "Shape \"plymesh\" \"string filename\" \"large.ply\"\n";
    expect_streams_as_it_loads(folder.write("a.pbrt", kCamera + shape), 1'000'000);
    // Holes need it at hand.
    folder.write("a.pgm", "P2\n2 1\n255\n0 255\n");
    EXPECT_THAT(
        sentence_of(folder,
                    std::string(kHoles) + ("Shape \"plymesh\" \"texture alpha\" \"t\" \"string "
                                           "filename\" \"large.ply\"\n"),
                    1'000'000),
        testing::HasSubstr("found a shape that takes "));
}

TEST(PbrtStream, ErrorsAreSentences) {
    const TestFolder folder;
    EXPECT_EQ(sentence_of(folder, grid(3) + "\nShape 7\n", 5 << 20),
              "a.pbrt:5: found the number 7, expected a name in quotes");
    EXPECT_EQ(sentence_of(folder, grid(30), 100'000),
              "a.pbrt:3: found a shape that takes 89328 bytes of host memory, and may take a "
              "quarter of 100000: the smallest number that works is 357312");
    EXPECT_EQ(sentence_of(folder, repeated(3, grid(1) + grid(1, true)), 16'000),
              "a.pbrt:6: found more than 2 meshes, which take 2000 bytes of host memory each, and "
              "may take a quarter of 16000");
    EXPECT_THAT(sentence_of(folder, "ObjectBegin \"o\" " + repeated(9, grid(3)), 9000),
                testing::AllOf(testing::HasSubstr("objects and texture coordinates take "),
                               testing::EndsWith("and may take a quarter of 9000")));
}

TEST(PbrtStream, EndsWhereTheSinkWantsNoMore) {
    const TestFolder folder;
    FullSink sink;
    const Result<Scene> scene =
        streamed(folder.write("a.pbrt", kCamera + repeated(9, grid(60))), sink, uint64_t(1) << 30);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().kind, ErrorKind::Cancelled);
    EXPECT_EQ(sink.parts, 1);
}

TEST(PbrtStream, TellsThatTheDiskIsFull) {
    const TestFolder folder;
    const auto path = folder.write("a.pbrt", kCamera + repeated(300, grid(20)));
    const test::FileSizeLimit limit(5'000'000);
    FullSink sink;
    const Result<Scene> scene = streamed(path, sink, 5 << 20);
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error().message,
                testing::EndsWith("the scratch file there failed: File too large"));
}

} // namespace
} // namespace ovc
