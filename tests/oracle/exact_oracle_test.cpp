// SPDX-License-Identifier: Apache-2.0
// The C ABI against the oracle: the right triangle, and t, u and v to the last bit, of rays in
// batches and one by one, over cases that are hard. OVC_ORACLE_RAYS says how many rays; the gate
// asks few.
#include "tests/abi/abi_scene.h"
#include "tests/oracle/cases.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

namespace ovc::oracle {
namespace {

using test::api;
using test::sized;

class ExactOracle : public testing::Test {
protected:
    void SetUp() override {
        device = test::open_device();
        if (!device)
            GTEST_SKIP() << api().last_error(nullptr);
    }

    uint32_t add(ovc_scene scene, const Mesh& mesh) const {
        auto given = sized<ovc_mesh>();
        std::vector<float> floats;
        given.vertex_count = mesh.corners.size();
        if (mesh.in_floats) {
            for (const Corner& corner : mesh.corners)
                floats.insert(floats.end(), {float(corner[0]), float(corner[1]), float(corner[2])});
            given.positions = floats.data();
        } else {
            given.positions_double = mesh.corners[0].data();
        }
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_mesh(scene, &given, &number), OVC_OK) << error();
        return number;
    }

    /// What overcast.h says an instance's corner is.
    static Corner placed(const std::array<double, 12>& m, const Corner& p) {
        Corner q;
        for (size_t row = 0; row < 3; ++row) {
            const double* r = &m[4 * row];
            q[row] = ((r[0] * p[0] + r[1] * p[1]) + r[2] * p[2]) + r[3];
        }
        return q;
    }

    static void list(std::vector<Triangle>& triangles, uint32_t number,
                     const std::vector<Corner>& corners) {
        for (uint32_t prim = 0; prim < corners.size() / 3; ++prim)
            triangles.push_back({{corners[3 * prim], corners[3 * prim + 1], corners[3 * prim + 2]},
                                 {number, prim}});
    }

    /// The meshes in a scene of its own that is built in one of several ways, and their triangles.
    test::AbiScene make(const std::vector<Mesh>& meshes, Random& random,
                        std::vector<Triangle>& triangles) const {
        auto config = sized<ovc_scene_config>();
        config.leaves = random.below(3) == 0 ? uint32_t(1 + random.below(12)) : 0;
        config.kernel = uint32_t(random.below(3));
        config.gpu_memory_bytes = random.below(4) == 0 ? 64 << 10 : 0;
        ovc_scene scene = nullptr;
        EXPECT_EQ(api().create_scene(device.get(), &config, &scene), OVC_OK) << error();
        test::AbiScene owner(scene);
        for (const Mesh& mesh : meshes) {
            const uint32_t number = add(scene, mesh);
            list(triangles, number, mesh.corners);
            for (const auto& transform : mesh.instances) {
                auto instance = sized<ovc_instance>();
                instance.mesh = number;
                instance.transform = transform.data();
                uint32_t placed_as = OVC_NONE;
                EXPECT_EQ(api().add_instance(scene, &instance, &placed_as), OVC_OK) << error();
                std::vector<Corner> corners;
                for (const Corner& corner : mesh.corners)
                    corners.push_back(placed(transform, corner));
                list(triangles, placed_as, corners);
            }
        }
        EXPECT_EQ(api().commit(scene), OVC_OK) << error();
        return owner;
    }

    std::string error() const { return api().last_error(device.get()); }

    test::Device device;
};

bool same_bits(const ovc_hit& a, const ovc_hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.mesh == b.mesh && a.prim == b.prim;
}

std::string text(const ovc_hit& hit) {
    char line[200];
    snprintf(line, sizeof line, "t %.17g u %.17g v %.17g mesh %d prim %d", hit.t, hit.u, hit.v,
             int(hit.mesh), int(hit.prim));
    return line;
}

uint64_t rays_asked_for() {
    const char* asked = std::getenv("OVC_ORACLE_RAYS");
    return asked ? uint64_t(std::strtod(asked, nullptr)) : 90'000;
}

TEST_F(ExactOracle, FindsNoAnswerThatIsOffByABit) {
    constexpr size_t kRaysPerScene = 500;
    const uint64_t rounds =
        std::max<uint64_t>(rays_asked_for() / kRaysPerScene / cases().size(), 1);
    uint64_t hits = 0, rays_asked = 0;
    for (uint64_t seed = 0; seed < rounds; ++seed)
        for (const Case& c : cases()) {
            SCOPED_TRACE(c.name);
            SCOPED_TRACE(seed);
            Random random(seed);
            std::vector<Triangle> triangles;
            const test::AbiScene scene = make(c.meshes(random), random, triangles);
            const Oracle oracle(triangles);
            std::vector<ovc_ray> rays;
            std::vector<ovc_triangle> skip;
            for (size_t i = 0; i < kRaysPerScene; ++i) {
                rays.push_back(c.ray(random, triangles));
                skip.push_back(random.below(4) == 0 ? triangles[random.below(triangles.size())].id
                                                    : ovc_triangle{OVC_NONE, OVC_NONE});
            }
            std::vector<ovc_hit> got(rays.size());
            std::vector<uint8_t> occluded(rays.size());
            auto query = sized<ovc_query>();
            query.skip = skip.data();
            ASSERT_EQ(api().intersect(scene.get(), rays.data(), rays.size(), got.data(), &query),
                      OVC_OK)
                << error();
            ASSERT_EQ(
                api().occluded(scene.get(), rays.data(), rays.size(), occluded.data(), &query),
                OVC_OK)
                << error();
            for (size_t i = 0; i < rays.size(); ++i) {
                const ovc_hit expected = oracle.nearest(rays[i], skip[i]);
                ASSERT_TRUE(same_bits(got[i], expected))
                    << "ray " << i << ": " << text(got[i]) << ", exactly " << text(expected);
                ASSERT_EQ(occluded[i] != 0, expected.mesh != OVC_NONE) << "ray " << i;
                hits += expected.mesh != OVC_NONE;
                if (i % 8 != 0)
                    continue;
                query.skip = &skip[i];
                ovc_hit one;
                ASSERT_EQ(api().intersect1(scene.get(), &rays[i], &one, &query), OVC_OK);
                ASSERT_TRUE(same_bits(one, expected))
                    << "single ray " << i << ": " << text(one) << ", exactly " << text(expected);
            }
            rays_asked += rays.size();
        }
    EXPECT_GT(hits, rays_asked / 5);
    RecordProperty("rays", int(rays_asked));
    std::printf("%llu rays, %llu hits: none off by a bit\n", (unsigned long long)(rays_asked),
                (unsigned long long)(hits));
}

} // namespace
} // namespace ovc::oracle
