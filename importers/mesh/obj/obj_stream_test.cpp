// SPDX-License-Identifier: Apache-2.0
// An OBJ file that streams gives its sink the triangles of one that is held, also where vertices
// and normals lie on the disk.
#include "importers/expect_stream.h"
#include "tests/file_size_limit.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace ovc {
namespace {

constexpr uint64_t kMuch = 1 << 30, kLittle = 64 << 10;

/// Returns so many vertices and as many normals in several pages of memory, one of which is zero
/// where asked.
std::string vertex_lines(size_t count, double far = 0, size_t zero_normal = ~size_t(0)) {
    std::string text;
    for (size_t i = 0; i < count; ++i)
        text += fmt::format("v {} {} {}\nvn 0 {} {}\n", far + double(i) / 3, i % 2,
                            double(i % 7) * 0.25, i % 3, i == zero_normal ? 0 : 1);
    return text;
}

/// Returns faces that name the vertices out of order; every `change` of them begin with
/// `statement`, which gets a number.
std::string faces(size_t count, const char* form, size_t change = 0,
                  fmt::format_string<size_t> statement = "g {}\n") {
    std::string text;
    uint32_t random = 1;
    const auto corner = [&] {
        random = random * 1664525 + 1013904223;
        return fmt::format(fmt::runtime(form), random / 65536 % count + 1);
    };
    for (size_t i = 0; i < count; ++i) {
        if (change > 0 && i % change == 0)
            text += fmt::format(statement, i / change % 7);
        text += "f";
        for (size_t k = 0; k < (i % 5 == 0 ? 4u : 3u); ++k)
            text += corner();
        text += "\n";
    }
    return text;
}

constexpr const char *kPlain = " {}", *kWithNormal = " {0}//{0}";

TEST(ObjStream, GivesTheTrianglesOfAFileThatIsHeld) {
    const TestFolder folder;
    folder.write("a.mtl", "newmtl m0\nKd 1 0 0\nnewmtl m3\nKd 0 0 1\nmap_Kd a.png\nKe 1 1 1\n");
    constexpr size_t kMany = 20'000;
    const std::string points = vertex_lines(kMany);
    const std::string interleaved = points + faces(kMany, kWithNormal, 100);
    const struct {
        const char* name;
        std::string contents;
    } cases[] = {
        {"none.obj", vertex_lines(3)},
        {"small.obj", vertex_lines(22) + faces(22, kPlain)},
        {"many.obj", points + faces(kMany, kPlain)},
        {"normals.obj", points + faces(kMany, kWithNormal)},
        {"gz.obj", gzip(points + faces(kMany, kWithNormal))},
        {"far.obj", vertex_lines(kMany, 1e9) + faces(kMany, kPlain)},
        {"groups.obj", interleaved},
        {"each_triangle.obj", points + faces(kMany, kWithNormal, 1)},
        {"materials.obj", "mtllib a.mtl\n" + points + faces(kMany, kPlain, 500, "usemtl m{}\n")},
        {"vertices_between.obj", interleaved + vertex_lines(500) + faces(kMany, kWithNormal, 900)},
        {"normals_lost.obj", interleaved + "g 3\nf 1 2 3\n" + faces(kMany, kWithNormal, 900)},
        {"zero_normal.obj", vertex_lines(kMany, 0, 15'000) + faces(kMany, kWithNormal, 8'000)},
        {"short.obj", points + "f 1 2\nf 1 2 3 4\nline 1 2\n"},
    };
    for (const auto& [name, contents] : cases)
        for (const uint64_t bytes : {kMuch, kLittle})
            expect_streams_as_it_loads(folder.write(name, contents), bytes);
}

Error streamed_error(const std::filesystem::path& path, TriangleSink& sink, uint64_t bytes) {
    const Streaming streaming{sink, bytes, path.parent_path()};
    ImportOptions options;
    options.streaming = &streaming;
    const Result<Scene> scene = load(path, options);
    return scene ? Error{"none"} : scene.error();
}

TEST(ObjStream, ErrorsAreThoseOfAFileThatIsHeld) {
    const TestFolder folder;
    const std::string points = vertex_lines(9000);
    for (const char* end : {"f 1 2 9001\n", "f 1 2 0\n", "f 1 2 x\n", "v 1 2\n", "vn 1\n"}) {
        const auto path = folder.write("a.obj", points + faces(9000, kPlain) + end);
        FullSink sink;
        sink.wanted = 1000;
        const std::string sentence = streamed_error(path, sink, kLittle).message;
        EXPECT_EQ(folder.plain(sentence), folder.failure("a.obj"));
        EXPECT_THAT(sentence, testing::HasSubstr(", line 27001: found"));
    }
    const std::string packed = gzip(points + faces(9000, kPlain));
    folder.write("a.obj", packed.substr(0, packed.size() / 2));
    FullSink sink;
    sink.wanted = 1000;
    EXPECT_EQ(folder.plain(streamed_error(folder / "a.obj", sink, kLittle).message),
              folder.failure("a.obj"));
}

TEST(ObjStream, EndsWhereTheSinkWantsNoMore) {
    const TestFolder folder;
    const auto path = folder.write("a.obj", vertex_lines(60'000) + faces(60'000, kPlain));
    FullSink sink;
    EXPECT_EQ(streamed_error(path, sink, kMuch).kind, ErrorKind::Cancelled);
    EXPECT_EQ(sink.parts, 1);
}

TEST(ObjStream, RefusesMoreMeshesThanTheMemoryHolds) {
    const TestFolder folder;
    const auto path = folder.write("a.obj", vertex_lines(3) + "g a\nf 1 2 3\ng b\nf 1 2 3\n");
    FullSink sink;
    EXPECT_EQ(folder.plain(streamed_error(path, sink, 8000).message),
              "a.obj, line 10: found more than 1 objects, groups and materials, which take 2000 "
              "bytes of host memory each, and may take a quarter of 8000");
}

TEST(ObjStream, TellsThatTheDiskIsFull) {
    const TestFolder folder;
    const auto path = folder.write("a.obj", vertex_lines(60'000) + faces(60'000, kWithNormal));
    const test::FileSizeLimit limit(300'000);
    FullSink sink;
    sink.wanted = 1000;
    EXPECT_THAT(streamed_error(path, sink, kLittle).message,
                testing::EndsWith("the scratch file there failed: File too large"));
}

} // namespace
} // namespace ovc
