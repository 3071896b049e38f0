// SPDX-License-Identifier: Apache-2.0
// A PLY file that streams gives its sink the triangles of one that is held.
#include "importers/file/triangle_store.h"
#include "importers/test_files.h"

#include <fmt/format.h>

#include <cstring>

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

void expect_streams_as_it_loads(const TestFolder& folder, const std::string& name,
                                const std::string& contents) {
    SCOPED_TRACE(name);
    const auto path = folder.write(name, contents);
    const Result<Scene> held = load(path);
    Result<TriangleStore> store = TriangleStore::create(std::filesystem::temp_directory_path());
    ASSERT_TRUE(held && store);
    const Streaming streaming{*store, 1 << 30};
    ImportOptions options;
    options.streaming = &streaming;
    const Result<Scene> streamed = load(path, options);
    ASSERT_TRUE(streamed) << streamed.error().message;
    ASSERT_TRUE(store->finish());
    ASSERT_EQ(store->meshes(), held->meshes.size());
    const Chunk& chunk = held->soup.chunks[0];
    EXPECT_EQ(streamed->soup.chunks[0].size(), 0u);
    EXPECT_EQ(streamed->soup.chunks[0].origin(), chunk.origin());
    EXPECT_EQ(streamed->meshes[0].normals_left_out, held->meshes[0].normals_left_out);
    const auto gathered = [](const auto& write) {
        std::vector<vec3> items;
        EXPECT_TRUE(write([&](Bytes bytes) {
            const size_t before = items.size();
            items.resize(before + bytes.size() / sizeof(vec3));
            std::memcpy(items.data() + before, bytes.data(), bytes.size());
            return true;
        }));
        return items;
    };
    EXPECT_TRUE(std::ranges::equal(
        gathered([&](const ByteSink& sink) { return store->write_corners(sink); }),
        chunk.corners()));
    EXPECT_EQ(gathered([&](const ByteSink& sink) { return store->write_normals(sink); }),
              held->meshes[0].normals);
}

TEST(PlyStream, GivesTheTrianglesOfAFileThatIsHeld) {
    const TestFolder folder;
    constexpr size_t kMany = 40'000; // triangles of several parts
    const std::string plain = vertices(2 * kMany + 2, "float", false);
    expect_streams_as_it_loads(folder, "small.ply",
                               file_of({vertices(22, "float", false), faces(10)}));
    expect_streams_as_it_loads(folder, "many.ply", file_of({plain, faces(kMany)}));
    expect_streams_as_it_loads(folder, "gz.ply", gzip(file_of({plain, faces(kMany)})));
    expect_streams_as_it_loads(folder, "faces_first.ply", file_of({faces(kMany), plain}));
    expect_streams_as_it_loads(folder, "normals.ply",
                               file_of({vertices(2 * kMany + 2, "float", true), faces(kMany)}));
    expect_streams_as_it_loads(folder, "doubles.ply",
                               file_of({vertices(22, "double", true), faces(10)}));
    expect_streams_as_it_loads(
        folder, "strips.ply",
        file_of({vertices(22, "float", false), "element tristrips 1\nproperty list int int "
                                               "vertex_indices\n|9 0 1 2 3 -1 4 5 6 7\n"}));
    expect_streams_as_it_loads(folder, "none.ply", file_of({vertices(3, "float", false)}));
}

/// Wants no more than its first part.
struct FullSink final : TriangleSink {
    int parts = 0;

    void begin_mesh() override {}
    bool add_corners(std::span<const vec3>) override {
        ++parts;
        return false;
    }
    bool add_normals(std::span<const vec3>) override { return true; }
};

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

TEST(PlyStream, RefusesMoreVerticesThanTheMemoryHolds) {
    const TestFolder folder;
    const auto path = folder.write("a.ply", file_of({vertices(1000, "float", true), faces(10)}));
    FullSink sink;
    const Streaming streaming{sink, 20'000};
    ImportOptions options;
    options.streaming = &streaming;
    const Result<Scene> scene = load(path, options);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().message,
              path.string() + ": its 1000 vertices take 24000 bytes of host memory, and 20000 are "
                              "allowed: the smallest number that works is 24000");
    EXPECT_EQ(sink.parts, 0);
}

TEST(PlyStream, OnlyPlyStreams) {
    EXPECT_TRUE(streams("a.ply") && streams("b.PLY.gz"));
    EXPECT_FALSE(streams("a.obj") || streams("a.stl") || streams("ply"));
}

} // namespace
} // namespace ovc
