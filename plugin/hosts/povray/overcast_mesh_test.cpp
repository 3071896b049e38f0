// SPDX-License-Identifier: AGPL-3.0-or-later
// Compares POV-Ray's answers for a mesh with those of every triangle tested in turn.
#include "plugin/hosts/povray/overcast_mesh.h"

#include "core/exact/triangle.h"
#include "plugin/hosts/povray/overcast_settings.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace {

using ovc::PreparedRay;
using ovc::Ray;
using ovc::vec3;

constexpr double kNearest = 1e-6; // mesh.cpp's DEPTH_TOLERANCE
constexpr double kFarthest = 1e7; // POV-Ray's MAX_DISTANCE

/// A triangle as POV-Ray has it: indices of vertices among other things.
struct Record {
    double before;
    long corner[3];
    float behind;
};

/// Triangles of all sizes in a cube, with shared vertices.
class PovrayMesh : public testing::Test {
protected:
    PovrayMesh() {
        setenv("OVC_PLUGIN", OVC_BINARY_DIR "/bin/libovercast.so", 1);
        setenv("OVC_POVRAY_GPU_MEMORY", "64M", 1);
        setenv("OVC_POVRAY_TRIANGLES", "1", 1);
        std::uniform_real_distribution<float> place(-1, 1);
        for (vec3& vertex : vertices_)
            vertex = {place(random_), place(random_), place(random_)};
        std::uniform_int_distribution<long> index(0, long(vertices_.size()) - 1);
        for (Record& record : records_)
            for (long& corner : record.corner)
                corner = index(random_);
        for (size_t i = 0; i < records_.size(); i += 10) { // the same triangle twice, turned
            const long* first = records_[i].corner;
            std::reverse_copy(first, first + 3, records_[i + 5].corner);
        }
    }
    ~PovrayMesh() override {
        for (const char* name : {"OVC_PLUGIN", "OVC_POVRAY_GPU_MEMORY", "OVC_POVRAY_TRIANGLES"})
            unsetenv(name);
    }

    OvercastTriangles triangles() const {
        return {reinterpret_cast<const float(*)[3]>(vertices_.data()), long(vertices_.size()),
                records_.front().corner, sizeof(Record), long(records_.size())};
    }

    /// Off the middle, towards it; sometimes from within.
    Ray some_ray() {
        std::uniform_real_distribution<double> place(-1.5, 1.5);
        const ovc::dvec3 from(place(random_), place(random_), place(random_));
        const ovc::dvec3 to = 0.4 * ovc::dvec3(place(random_), place(random_), place(random_));
        return {from, kNearest, glm::normalize(to - from), kFarthest};
    }

    /// All hits in [t_min, t_max], by depth and number, of each triangle by itself.
    std::vector<OvercastHit> by_all(const Ray& ray) const {
        const PreparedRay prepared(ray);
        std::vector<OvercastHit> hits;
        for (size_t i = 0; i < records_.size(); ++i) {
            const auto& [a, b, c] = records_[i].corner;
            ovc::Nearest nearest(prepared);
            nearest.offer({ovc::dvec3(vertices_[size_t(a)]), ovc::dvec3(vertices_[size_t(b)]),
                           ovc::dvec3(vertices_[size_t(c)])},
                          {0, uint32_t(i)});
            if (nearest.is_hit())
                hits.push_back({nearest.hit().t, long(i)});
        }
        std::ranges::sort(
            hits, {}, [](const OvercastHit& hit) { return std::pair(hit.depth, hit.triangle); });
        return hits;
    }

    std::mt19937 random_{7};
    std::vector<vec3> vertices_{300};
    std::vector<Record> records_{1500};
};

bool ask(const OvercastMesh& mesh, const Ray& ray, OvercastHit& hit,
         const OvercastHit* after = nullptr) {
    return overcast_hit(mesh, &ray.org.x, &ray.dir.x, ray.t_min, ray.t_max, after, hit);
}

using Owned = std::unique_ptr<OvercastMesh, decltype(&overcast_release)>;

TEST_F(PovrayMesh, HitsAreThoseOfEveryTriangleTestedInTurn) {
    const Owned mesh(overcast_take(triangles()), overcast_release);
    ASSERT_TRUE(mesh);
    size_t hits = 0;
    for (int i = 0; i < 30; ++i) {
        const Ray ray = some_ray();
        OvercastHit hit;
        const OvercastHit* after = nullptr;
        for (const OvercastHit& expected : by_all(ray)) { // as where solids are cut
            ASSERT_TRUE(ask(*mesh, ray, hit, after)) << "ray " << i;
            ASSERT_EQ(hit.triangle, expected.triangle) << "ray " << i;
            ASSERT_EQ(hit.depth, expected.depth) << "ray " << i;
            after = &hit;
            ++hits;
        }
        ASSERT_FALSE(ask(*mesh, ray, hit, after)) << "ray " << i;
    }
    EXPECT_GT(hits, 2000u);
}

TEST_F(PovrayMesh, ThreadsGetTheirOwnAnswers) {
    const Owned mesh(overcast_take(triangles()), overcast_release);
    ASSERT_TRUE(mesh);
    std::vector<Ray> rays(64);
    std::vector<OvercastHit> expected(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        rays[i] = some_ray();
        const std::vector<OvercastHit> hits = by_all(rays[i]);
        expected[i] = hits.empty() ? OvercastHit{INFINITY, -1} : hits.front();
    }
    std::vector<std::thread> threads;
    std::atomic<int> wrong = 0;
    for (size_t first = 0; first < 8; ++first)
        threads.emplace_back([&, first] {
            for (size_t i = first; i < first + rays.size(); ++i) {
                const size_t at = i % rays.size();
                OvercastHit hit{INFINITY, -1};
                const bool found = ask(*mesh, rays[at], hit);
                wrong += found != (expected[at].triangle >= 0) ||
                         (found && (hit.triangle != expected[at].triangle ||
                                    hit.depth != expected[at].depth));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST_F(PovrayMesh, SmallMeshesStayPovrays) {
    setenv("OVC_POVRAY_TRIANGLES", "1501", 1);
    EXPECT_EQ(overcast_take(triangles()), nullptr);
    setenv("OVC_POVRAY_TRIANGLES", "1500", 1);
    EXPECT_TRUE(Owned(overcast_take(triangles()), overcast_release));
}

TEST_F(PovrayMesh, BudgetsThatDoNotWorkLeaveTheMeshToPovrayAndSayWhy) {
    setenv("OVC_POVRAY_GPU_MEMORY", "1K", 1);
    testing::internal::CaptureStderr();
    EXPECT_EQ(overcast_take(triangles()), nullptr);
    EXPECT_EQ(overcast_take(triangles()), nullptr);
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::MatchesRegex(".*\rpovray-overcast: .*1024.*; meshes stay POV-Ray's\n.*"));
}

TEST_F(PovrayMesh, VariablesWithoutMeaningAreErrors) {
    const auto says = [](const char* name, const char* text) -> std::string {
        setenv(name, text, 1);
        try {
            overcast_settings();
        } catch (const std::runtime_error& error) {
            unsetenv(name);
            return error.what();
        }
        unsetenv(name);
        return "";
    };
    EXPECT_EQ(says("OVC_POVRAY_GPU_MEMORY", "12X"),
              "OVC_POVRAY_GPU_MEMORY is '12X', expected bytes, such as 256M");
    for (const char* text : {"M", "-1", "1.5G", "99999999999999999999", "99999999999G", "1KM"})
        EXPECT_NE(says("OVC_POVRAY_GPU_MEMORY", text), "") << text;
    EXPECT_EQ(says("OVC_POVRAY_TRIANGLES", "many"),
              "OVC_POVRAY_TRIANGLES is 'many', expected a number of triangles");
    EXPECT_EQ(says("OVC_POVRAY_TRIANGLES", "0"), "");
    setenv("OVC_POVRAY_GPU_MEMORY", "3M", 1);
    EXPECT_EQ(overcast_settings().gpu_memory_bytes, 3u << 20);
}

} // namespace
