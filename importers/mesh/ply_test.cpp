// SPDX-License-Identifier: Apache-2.0
// The reader of PLY: encodings, elements, errors by their text, damage.
#include "importers/test_files.h"

#include <bit>
#include <cstring>
#include <sstream>

namespace ovc {
namespace {

constexpr const char* kSquareHeader = "element vertex 4\nproperty float x\nproperty float y\n"
                                      "property float z\nelement face 2\n"
                                      "property list uchar int vertex_indices\nend_header\n";
constexpr const char* kSquareRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n";

std::string ascii(const std::string& rest) {
    return "ply\nformat ascii 1.0\n" + rest;
}

/// Returns the value's bytes, last first if `big`.
template <class T>
std::string bytes(T value, bool big) {
    std::string text(sizeof(T), '\0');
    std::memcpy(text.data(), &value, sizeof(T));
    return big ? std::string(text.rbegin(), text.rend()) : text;
}

std::string binary_square(bool big) {
    std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\n" + kSquareHeader;
    for (const float value : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1})
        file += bytes(value, big);
    file += bytes(0.5f, big);
    for (const auto& face : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        file += '\3';
        for (const int32_t index : face)
            file += bytes(index, big);
    }
    return file;
}

const std::vector<Triangle> kBentSquare = {{dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(1, 1, 0)},
                                           {dvec3(0, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 0.5)}};

TEST(Ply, EveryEncodingGivesTheSameTriangles) {
    const TestFolder folder;
    const std::string text = ascii(std::string(kSquareHeader) + kSquareRows);
    std::string dos, mac;
    for (const char c : text) {
        dos += c == '\n' ? "\r\n" : std::string(1, c);
        mac += c == '\n' ? '\r' : c;
    }
    EXPECT_EQ(triangles_of(load(folder.write("a.ply", text))), kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("dos.ply", dos))), kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("mac.ply", mac))), kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("le.ply", binary_square(false)))), kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("be.ply", binary_square(true)))), kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("mark.ply", "\xef\xbb\xbf" + text))), kBentSquare);
    EXPECT_EQ(
        triangles_of(load(folder.write("mark le.ply", "\xef\xbb\xbf" + binary_square(false)))),
        kBentSquare);
    EXPECT_EQ(triangles_of(load(folder.write("end.ply", text.substr(0, text.size() - 1)))),
              kBentSquare);
}

TEST(Ply, ExtraPropertiesElementsAndBlanksAreSkipped) {
    const TestFolder folder;
    const auto path = folder.write(
        "extra.ply",
        ascii("obj_info made by hand\ncomment x\nelement camera 1\nproperty list uchar float pose\n"
              "property int id\nelement nothing 4000000000\nelement vertex 4\nproperty uchar red\n"
              "property float z\nproperty float y\nproperty list int short tags\nproperty float x\n"
              "element edge 1\nproperty int a\nelement face 2\nproperty uchar material\n"
              "property list uchar uint vertex_index\nproperty list uchar float texcoord\n"
              "end_header\n2 0.5 0.25 7 \n\n255 0 0 0 0 \n255 0 0 2 9 9 1\t\n"
              " 255 0 1 0 1\n255 .5 +1 0 0e0\n42\n1 3 0 1 2 0\n1 3 0 2 3 2 0.5 0.5\n"));
    std::vector<std::string> warnings;
    EXPECT_EQ(triangles_of(load(path, gather(warnings))), kBentSquare);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(folder.plain(warnings[0]), "extra.ply: vertex colors left out");
    EXPECT_EQ(folder.plain(warnings[1]), "extra.ply: 2 elements left out: 'camera', 'edge'");
}

/// Returns `value` as a PLY type of this name stores it.
std::string stored(const std::string& type, int value, bool big) {
    if (type == "char" || type == "uchar")
        return std::string(1, char(value));
    return type == "short" || type == "ushort" ? bytes(int16_t(value), big)
                                               : bytes(int32_t(value), big);
}

TEST(Ply, ListsMayHaveAnyTypesOfLengthAndIndex) {
    const TestFolder folder;
    const std::string types[] = {"char", "uchar", "short", "ushort", "int", "uint"};
    for (const std::string& length : types)
        for (const std::string& index : types) {
            SCOPED_TRACE(length + " " + index);
            std::string header = kSquareHeader;
            header.replace(header.find("uchar int"), 9, length + " " + index);
            for (const bool big : {false, true}) {
                std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                                   "_endian 1.0\n" + header;
                for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f})
                    file += bytes(value, big);
                file += bytes(0.5f, big);
                for (const auto& face : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
                    file += stored(length, 3, big);
                    for (const int corner : face)
                        file += stored(index, corner, big);
                }
                EXPECT_EQ(triangles_of(load(folder.write("a.ply", file))), kBentSquare);
            }
            EXPECT_EQ(triangles_of(load(folder.write("b.ply", ascii(header + kSquareRows)))),
                      kBentSquare);
        }
}

TEST(Ply, WholeNumbersMayHaveASignAndLeadingZeros) {
    const TestFolder folder;
    const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n"
                             "+3 -0 000000001 00000000002\n3\t0  +2 0000000000000003 \n";
    EXPECT_EQ(triangles_of(load(folder.write("a.ply", ascii(kSquareHeader + rows)))), kBentSquare);
}

TEST(Ply, ConcavePolygonsAreCutWithoutOverlap) {
    const TestFolder folder;
    // The face is a staircase of six corners in the plane x = 2; the second corner is reflex.
    const auto triangles = triangles_of(load(folder.write(
        "stairs.ply",
        ascii("element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
              "2 0 2\n2 0 0\n2 2 0\n2 2 1\n2 1 1\n2 1 2\n6 3 4 5 0 1 2\n"))));
    ASSERT_EQ(triangles.size(), 4u);
    double area = 0;
    for (const Triangle& t : triangles) {
        const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
        EXPECT_GE(normal.x, 0);
        area += normal.x / 2;
    }
    EXPECT_EQ(area, 3);
}

TEST(Ply, FacesMayComeBeforeVertices) {
    const TestFolder folder;
    const auto path =
        folder.write("first.ply", ascii("element face 1\nproperty list uchar int vertex_indices\n"
                                        "element vertex 4\nproperty double x\nproperty double y\n"
                                        "property double z\nend_header\n"
                                        "4 0 1 2 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n"));
    EXPECT_EQ(triangles_of(load(path)), kBentSquare);
}

TEST(Ply, StripsAlternateTheirWindingAndRestart) {
    const TestFolder folder;
    const auto strip = triangles_of(
        load(folder.write("strip.ply", ascii("element vertex 4\nproperty int x\nproperty char y\n"
                                             "property short z\nelement tristrips 1\n"
                                             "property list int int vertex_indices\nend_header\n"
                                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
                                             "12 0 1 2 3 -1 -1 0 1 -1 3 2 1\n"))));
    const dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
    EXPECT_EQ(strip, (std::vector<Triangle>{{a, b, c}, {c, b, d}, {d, c, b}}));
}

TEST(Ply, NormalsAreReadWhereAllCanBeUsed) {
    const TestFolder folder;
    const auto with_normal = [&](const std::string& last) {
        return ascii("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
                     "property list uchar int vertex_indices\nend_header\n"
                     "0 0 0 0 0 1\n1 0 0 0 2 0\n0 1 0 " +
                     last + "\n3 2 1 0\n");
    };
    const auto good = load(folder.write("good.ply", with_normal("0 0 -1")));
    ASSERT_TRUE(good);
    EXPECT_EQ(good->meshes[0].normals, (std::vector<vec3>{{0, 0, -1}, {0, 1, 0}, {0, 0, 1}}));
    for (const char* bad : {"0 0 0", "nan 0 0", "0 inf 0", "3e38 3e38 3e38"}) {
        std::vector<std::string> warnings;
        const auto scene = load(folder.write("bad.ply", with_normal(bad)), gather(warnings));
        ASSERT_TRUE(scene) << bad;
        EXPECT_TRUE(scene->meshes[0].normals.empty()) << bad;
        ASSERT_EQ(warnings.size(), 1u) << bad;
        EXPECT_EQ(folder.plain(warnings[0]),
                  "bad.ply: normals left out: some are zero or not finite");
    }
}

TEST(Ply, DoublesKeepTheirPrecisionFarFromTheOrigin) {
    const TestFolder folder;
    const std::string header = "element vertex 3\nproperty double x\nproperty double y\n"
                               "property double z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n";
    const auto far = load(folder.write(
        "far.ply",
        ascii(header + "5000000.125 10 0\n5000001.125 10 0\n5000000.125 11 0.25\n3 0 1 2\n")));
    EXPECT_EQ(triangles_of(far)[0], (Triangle{dvec3(5000000.125, 10, 0), dvec3(5000001.125, 10, 0),
                                              dvec3(5000000.125, 11, 0.25)}));
    const auto near =
        load(folder.write("near.ply", ascii(header + "0 0.5 0\n1 0 0\n2 1 0\n3 0 1 2\n")));
    ASSERT_TRUE(near);
    EXPECT_EQ(near->soup.chunks[0].origin(), dvec3(0)) << "floats stay as they are";
    const auto fine = triangles_of(load(folder.write(
        "fine.ply", ascii(header + "100.1 100.2 100.3\n101.7 100 100\n100 101 100\n3 0 1 2\n"))));
    EXPECT_NEAR(fine[0][0].x, 100.1, 1e-7); // a float there is off by 1.5e-6
}

TEST(Ply, NonFiniteVerticesAreKept) {
    const TestFolder folder;
    std::string rows = kSquareRows;
    rows.replace(0, 5, "nan -1.#IND 1e999");
    const auto triangles = triangles_of(load(folder.write("nan.ply", ascii(kSquareHeader + rows))));
    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_TRUE(std::isnan(triangles[0][0].x));
    EXPECT_TRUE(std::isnan(triangles[0][0].y));
    EXPECT_TRUE(std::isinf(triangles[0][0].z));
}

TEST(Ply, PointCloudsGiveAnEmptyMeshAndAWarning) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene = load(folder.write("points.ply", ascii("element vertex 1\nproperty float x\n"
                                                             "property float y\nproperty float z\n"
                                                             "end_header\n1 2 3\n")),
                            gather(warnings));
    EXPECT_TRUE(triangles_of(scene).empty());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]), "points.ply: it has no triangles");
}

TEST(Ply, PolygonsWithTooFewCornersAreCounted) {
    const TestFolder folder;
    const std::string header =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face ";
    const std::string rows =
        "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const struct {
        const char* count;
        const char* faces;
        const char* message;
    } cases[] = {
        {"2", "2 0 1\n", "short.ply: 1 polygon with fewer than three corners left out"},
        {"3", "0\n1 2\n", "short.ply: 2 polygons with fewer than three corners left out"},
    };
    for (const auto& test : cases) {
        std::vector<std::string> warnings;
        const auto scene =
            load(folder.write("short.ply", ascii(header + test.count + rows + test.faces)),
                 gather(warnings));
        EXPECT_EQ(triangles_of(scene).size(), 1u);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_EQ(folder.plain(warnings[0]), test.message);
    }
}

TEST(Ply, NumbersThatTheHeaderDoesNotTellOfAreLeftOut) {
    const TestFolder folder;
    std::string rows;
    std::istringstream lines(kSquareRows);
    int row = 0;
    for (std::string line; std::getline(lines, line); ++row)
        rows += line + (row % 2 ? " 255 -1e3 0" : "") + "\n";
    std::vector<std::string> warnings;
    const auto scene = load(
        folder.write("more.ply", ascii(std::string(kSquareHeader) + rows) + std::string(3, '\0')),
        gather(warnings));
    EXPECT_EQ(triangles_of(scene), kBentSquare);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(folder.plain(warnings[0]),
              "more.ply, line 11: numbers that the header does not tell of left out, in " +
                  std::to_string(row / 2) + " rows");
}

TEST(Ply, DataAfterTheLastRowIsSaid) {
    const TestFolder folder;
    const std::string text = ascii(std::string(kSquareHeader) + kSquareRows);
    const struct {
        const char* name;
        std::string contents;
        const char* message; // null: none
    } cases[] = {
        {"nothing", text, nullptr},
        {"blank lines", text + "\n \t\r\n\n", nullptr},
        {"a row", text + "\n3 0 1 2\n", "more.ply, line 17: 1 line after the last row left out"},
        {"rows and blanks", text + "3 0 1 2\n\n3 0 1 2\nx",
         "more.ply, line 16: 3 lines after the last row left out"},
        {"binary", binary_square(false), nullptr},
        {"a byte", binary_square(false) + "\n",
         "more.ply, byte 243: 1 byte after the last row left out"},
        {"little endian", binary_square(false) + std::string(100000, '\0'),
         "more.ply, byte 243: 100000 bytes after the last row left out"},
        {"big endian", binary_square(true) + "12",
         "more.ply, byte 240: 2 bytes after the last row left out"},
    };
    for (const auto& test : cases)
        for (const bool packed : {false, true}) {
            SCOPED_TRACE(test.name);
            std::vector<std::string> warnings;
            const std::string contents = packed ? gzip(test.contents) : test.contents;
            const auto scene = load(folder.write("more.ply", contents), gather(warnings));
            EXPECT_EQ(triangles_of(scene), kBentSquare);
            ASSERT_EQ(warnings.size(), test.message ? 1u : 0u);
            if (test.message) {
                EXPECT_EQ(folder.plain(warnings[0]), test.message);
            }
        }
}

const struct {
    const char* name;
    std::string contents;
    const char* message;
} kInvalid[] = {
    {"empty", "", "bad.ply: the file is empty, expected a model"},
    {"magic", "plyx\n", "bad.ply, line 1: found 'plyx', expected ply"},
    {"binary rubbish",
     std::string("\x7f"
                 "ELF\0\1",
                 6),
     "bad.ply, line 1: found '\\x7fELF\\x00\\x01', expected ply"},
    {"no end", "ply\nformat ascii 1.0\n",
     "bad.ply, line 2: found the end of the file, expected end_header"},
    {"no format", "ply\nend_header\n",
     "bad.ply, line 2: found end_header, expected a line format … before it"},
    {"format", "ply\nformat utf8 1.0\n",
     "bad.ply, line 2: found format 'utf8', expected ascii, binary_little_endian or "
     "binary_big_endian"},
    {"version", "ply\nformat ascii 2.0\n",
     "bad.ply, line 2: found format version '2.0', expected 1.0"},
    {"keyword", ascii("elemnt vertex 3\n"),
     "bad.ply, line 3: found 'elemnt', expected format, element, property, comment, obj_info or "
     "end_header"},
    {"count", ascii("element vertex -3\n"),
     "bad.ply, line 3: found element count '-3', expected a whole number, 0 or more"},
    {"no count", ascii("element vertex\n"),
     "bad.ply, line 3: found the end of the line, expected a whole number, 0 or more"},
    {"too many vertices", ascii("element vertex 4294967296\n"),
     "bad.ply, line 3: found element count '4294967296', expected at most 4294967295 rows of "
     "vertex"},
    {"far too many vertices", ascii("element vertex 99999999999\n"),
     "bad.ply, line 3: found element count '99999999999', expected at most 4294967295 rows of "
     "vertex"},
    {"a count beyond 64 bits", ascii("element vertex 99999999999999999999\n"),
     "bad.ply, line 3: found element count '99999999999999999999', expected at most 4294967295 "
     "rows of vertex"},
    {"too many faces", ascii("element face 4294967295\n"),
     "bad.ply, line 3: found element count '4294967295', expected at most 4294967294 rows of face"},
    {"no format", "ply\nformat\n",
     "bad.ply, line 2: found the end of the line, expected ascii, binary_little_endian or "
     "binary_big_endian"},
    {"empty line", "\nply\n", "bad.ply, line 1: found the end of the line, expected ply"},
    {"orphan", ascii("property float x\n"),
     "bad.ply, line 3: found a property, expected an element before it"},
    {"type", ascii("element vertex 1\nproperty half x\n"),
     "bad.ply, line 4: found type 'half', expected a type such as char, uchar, short, ushort, int, "
     "uint, float, double"},
    {"nameless", ascii("element vertex 1\nproperty float\n"),
     "bad.ply, line 4: found the end of the line, expected the name of the property"},
    {"list length type", ascii("element face 1\nproperty list float int vertex_indices\n"),
     "bad.ply, line 4: found list length type 'float', expected an integer type"},
    {"no z", ascii("element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
     "bad.ply, line 6: found an element vertex without a property z, expected x, y and z"},
    {"no list", ascii("element face 1\nproperty int a\nend_header\n1\n"),
     "bad.ply, line 5: found an element face without vertex_indices, expected a list of integers "
     "of "
     "that name"},
    {"float list", ascii("element face 1\nproperty list uchar float vertex_indices\nend_header\n"),
     "bad.ply, line 5: found an element face without vertex_indices, expected a list of integers "
     "of "
     "that name"},
    {"word", ascii(std::string(kSquareHeader) + "0 0 0\n1 x 0\n"),
     "bad.ply, line 11: found 'x', expected a number for y"},
    {"short row", ascii(std::string(kSquareHeader) + "0 0 0\n1 0\n"),
     "bad.ply, line 11: found the end of the line, expected a number for z"},
    {"long row", ascii(std::string(kSquareHeader) + "0 0 0 7 x\n"),
     "bad.ply, line 10: found 'x', expected the end of the line"},
    {"end of rows", ascii(std::string(kSquareHeader) + "0 0 0\n1 0 0\n"),
     "bad.ply, line 11: the file ends early: found 2 of 4 rows of vertex"},
    {"index too large", ascii(std::string(kSquareHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 4\n"),
     "bad.ply, line 14: found vertex index 4, expected 0 to 3"},
    {"negative index", ascii(std::string(kSquareHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 -1\n"),
     "bad.ply, line 14: found vertex index -1, expected 0 to 3"},
    {"index is no integer",
     ascii(std::string(kSquareHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 1.5\n"),
     "bad.ply, line 14: found '1.5', expected a whole number for vertex_indices"},
    {"negative length",
     ascii(std::string(kSquareHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n-3 0 1 1\n"),
     "bad.ply, line 14: found '-3', expected the length of vertex_indices"},
    {"index other than the only one",
     ascii("element vertex 1\nproperty char x\nproperty char y\nproperty char z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n0 0 0\n3 0 1 0\n"),
     "bad.ply, line 11: found vertex index 1, expected 0, the only one"},
    {"no vertices",
     ascii("element face 1\nproperty list uchar int vertex_indices\nend_header\n3 0 0 0\n"),
     "bad.ply, line 6: found vertex index 0, expected none, for there are no vertices"},
    {"short binary vertex", binary_square(false).substr(0, 180),
     "bad.ply, byte 177: the file ends early: found 0 of 4 rows of vertex"},
    {"short binary face", binary_square(true).substr(0, binary_square(true).size() - 1),
     "bad.ply, byte 228: the file ends early: found 1 of 2 rows of face"},
    {"four thousand million",
     "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\n"
     "property double y\nproperty double z\nend_header\n12345678",
     "bad.ply, byte 135: the file ends early: found 0 of 4000000000 rows of vertex"},
    {"list of four thousand million",
     "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\n"
     "property char z\nproperty list uint double w\nend_header\n123\xff\xff\xff\xff"
     "12345678",
     "bad.ply, byte 147: the file ends early: found 0 of 1 row of vertex"},
};

TEST(Ply, ErrorsNameThePlaceAndWhatWasExpected) {
    const TestFolder folder;
    for (const auto& c : kInvalid) {
        folder.write("bad.ply", c.contents);
        EXPECT_EQ(folder.failure("bad.ply"), c.message) << c.name;
    }
}

TEST(Ply, DamageBehindTheLastRowOfACompressedFileIsAnError) {
    const TestFolder folder;
    const std::string packed = gzip(binary_square(false));
    std::string flipped = packed;
    flipped[packed.size() - 6] ^= 1; // in the checksum
    const struct {
        const char* name;
        std::string contents;
        const char* message;
    } cases[] = {{"checksum", flipped, "the compressed data is damaged: incorrect checksum"},
                 {"cut", packed.substr(0, packed.size() - 3), "the compressed data ends early"}};
    for (const auto& test : cases) {
        folder.write("bad.ply", test.contents);
        const std::string message = folder.failure("bad.ply");
        EXPECT_TRUE(message.starts_with("bad.ply") &&
                    message.ends_with(": " + std::string(test.message)))
            << test.name << ": " << message;
    }
}

TEST(Ply, SurvivesTruncationAndFlippedBits) {
    const TestFolder folder;
    folder.write("ascii.ply", ascii(std::string(kSquareHeader) + kSquareRows));
    folder.write("le.ply", binary_square(false));
    folder.write("be.ply", binary_square(true));
    for (const char* name : {"ascii.ply", "le.ply", "be.ply"})
        survive_damage(folder, name);
}

TEST(Ply, EveryTruncationOfABinaryFileIsAnError) {
    const TestFolder folder;
    const std::string whole = binary_square(false);
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(load(folder.write("cut.ply", whole.substr(0, length)))) << length;
}

TEST(Ply, WhatIsPassedOverIsSaidByName) {
    const TestFolder folder;
    std::vector<std::string> warnings;
    const auto scene =
        load(folder.write("a.ply",
                          "ply\nformat ascii 1.0\ncomment TextureFile wood floor.png\n"
                          "comment TextureFile\nelement camera 1\nproperty float view\n"
                          "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                          "element none 0\nelement face 1\nproperty list uchar int vertex_indices\n"
                          "property uchar red\nelement edge 1\nproperty int vertex1\nend_header\n"
                          "7\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255\n0\n"),
             gather(warnings));
    ASSERT_TRUE(scene);
    for (std::string& warning : warnings)
        warning = folder.plain(warning);
    EXPECT_EQ(warnings, (std::vector<std::string>{"a.ply: face colors left out",
                                                  "a.ply: 2 elements left out: 'camera', 'edge'",
                                                  "a.ply: 1 texture left out: 'wood floor.png'"}));
}

} // namespace
} // namespace ovc
