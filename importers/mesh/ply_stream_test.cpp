// SPDX-License-Identifier: Apache-2.0
// A PLY file that streams gives its sink the triangles of one that is held.
#include "importers/expect_stream.h"
#include "tests/file_size_limit.h"

#include <fmt/format.h>

namespace ovc {
namespace {

constexpr const char* kHeader = "ply\nformat ascii 1.0\n";

/// Returns a strip of squares of so many vertices, with normals where asked.
std::string vertices(size_t count, const char* type, bool normals) {
    std::string text;
    for (size_t i = 0; i < count; ++i) {
        text += fmt::format("{} {} {}", i / 2, i % 2, double(i % 7) * 0.25);
        text += normals ? fmt::format(" 0 {} 1\n", i % 3) : "\n";
    }
    std::string header = fmt::format("element vertex {}\nproperty {} x\nproperty {} y\n"
                                     "property {} z\n",
                                     count, type, type, type);
    if (normals)
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    return header + "|" + text;
}

std::string faces(size_t count) {
    std::string text;
    for (size_t i = 0; i < count; ++i)
        text += i % 5 == 0 ? fmt::format("4 {} {} {} {}\n", 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1)
                           : fmt::format("3 {} {} {}\n", 2 * i, 2 * i + 2, 2 * i + 1);
    return fmt::format("element face {}\nproperty list uchar int vertex_indices\n|", count) + text;
}

/// Puts elements, each a header and rows, together to a file.
std::string file_of(std::initializer_list<std::string> elements) {
    std::string headers, rows;
    for (const std::string& element : elements) {
        const size_t bar = element.find('|');
        headers += element.substr(0, bar);
        rows += element.substr(bar + 1);
    }
    return kHeader + headers + "end_header\n" + rows;
}

void stream(const TestFolder& folder, const std::string& name, const std::string& contents) {
    expect_streams_as_it_loads(folder.write(name, contents), 1 << 30);
}

TEST(PlyStream, GivesTheTrianglesOfAFileThatIsHeld) {
    const TestFolder folder;
    constexpr size_t kMany = 40'000; // triangles of several parts
    const std::string plain = vertices(2 * kMany + 2, "float", false);
    stream(folder, "small.ply", file_of({vertices(22, "float", false), faces(10)}));
    stream(folder, "many.ply", file_of({plain, faces(kMany)}));
    stream(folder, "gz.ply", gzip(file_of({plain, faces(kMany)})));
    stream(folder, "faces_first.ply", file_of({faces(kMany), plain}));
    stream(folder, "normals.ply", file_of({vertices(2 * kMany + 2, "float", true), faces(kMany)}));
    stream(folder, "doubles.ply", file_of({vertices(22, "double", true), faces(10)}));
    stream(folder, "strips.ply",
           file_of({vertices(22, "float", false), "element tristrips 1\nproperty list int int "
                                                  "vertex_indices\n|9 0 1 2 3 -1 4 5 6 7\n"}));
    stream(folder, "none.ply", file_of({vertices(3, "float", false)}));
}

TEST(PlyStream, EndsWhereTheSinkWantsNoMore) {
    const TestFolder folder;
    for (const bool faces_first : {false, true}) {
        const std::string points = vertices(200'002, "float", false), all = faces(100'000);
        const auto path =
            folder.write("a.ply", faces_first ? file_of({all, points}) : file_of({points, all}));
        FullSink sink;
        const Streaming streaming{sink, 1 << 30};
        ImportOptions options;
        options.streaming = &streaming;
        const Result<Scene> scene = load(path, options);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().kind, ErrorKind::Cancelled);
        EXPECT_EQ(sink.parts, 1);
    }
}

/// A page has 1,024 items, and three are in memory at least.
TEST(PlyStream, VerticesThatDoNotFitWaitOnTheDisk) {
    const TestFolder folder;
    constexpr size_t kMany = 20'000;
    for (const char* type : {"float", "double"})
        expect_streams_as_it_loads(
            folder.write("a.ply", file_of({vertices(2 * kMany + 2, type, true), faces(kMany)})),
            100'000);
}

TEST(PlyStream, TellsThatTheDiskIsFull) {
    const TestFolder folder;
    const auto path =
        folder.write("a.ply", file_of({vertices(200'002, "float", true), faces(100'000)}));
    const test::FileSizeLimit limit(1'000'000);
    FullSink sink;
    sink.wanted = 1000;
    const Streaming streaming{sink, 100'000, path.parent_path()};
    ImportOptions options;
    options.streaming = &streaming;
    const Result<Scene> scene = load(path, options);
    ASSERT_FALSE(scene);
    EXPECT_TRUE(scene.error().message.ends_with("the scratch file there failed: File too large"))
        << scene.error().message;
}

TEST(PlyStream, SomeFormatsStream) {
    EXPECT_TRUE(streams("a.ply") && streams("b.PLY.gz") && streams("c.obj") && streams("d.pbrt"));
    EXPECT_FALSE(streams("a.pov") || streams("a.stl") || streams("ply"));
}

} // namespace
} // namespace ovc
