// SPDX-License-Identifier: Apache-2.0
// Tests doubles, transforms and instances through the ABI against the same triangles moved by hand:
// every bit against brute force, a sample against exact rationals, and ids against Embree's own
// instances.
#include "core/file/test_archive.h"
#include "tests/abi/embree_instances.h"
#include "tests/abi/instances_world.h"

#include <gmock/gmock.h>

#include <cstring>

namespace ovc {
namespace {

using namespace test;
using testing::HasSubstr;

TEST_F(Instances, AnswerAsTheirTrianglesMovedByHandDo) {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        // The reach grows from 0.1, where instances overlap, to far away.
        const double reach = std::pow(10, int(seed)) - 0.9;
        World w = world();
        const auto floats = random_corners<vec3>(random, 40, 0.3);
        const auto doubles = random_corners<dvec3>(random, 40, 0.3);
        const Matrix placed = any_transform(random, reach);
        const uint32_t sources[] = {
            w.add(floats, dvec3(0.1, 1e3, -7), nullptr),
            w.add(doubles, random.point(-1, 1), nullptr),
            w.add(floats, dvec3(0), &placed),
            w.add(doubles, dvec3(0.3), &placed, OVC_MESH_SHARED),
            w.add(floats, dvec3(0), nullptr, OVC_MESH_TEMPLATE),
            w.add(doubles, dvec3(1.7), &placed, OVC_MESH_TEMPLATE | OVC_MESH_SHARED)};
        std::vector<uint32_t> numbers(std::begin(sources), std::end(sources));
        for (int i = 0; i < 15; ++i) {
            const Matrix m = any_transform(random, reach);
            const uint32_t of = numbers[random.below(uint32_t(numbers.size()))];
            numbers.push_back(w.instance(of, i == 7 ? nullptr : &m));
        }
        w.commit();
        EXPECT_EQ(w.statistics().triangles, w.expected.triangle_count());
        EXPECT_EQ(w.statistics().soup_bytes, 40 * 3 * (3 * sizeof(vec3) + sizeof(dvec3)))
            << "instances keep no positions, and shared ones are the caller's";
        expect_brute_force(w, rays_at(w.expected, 3000, seed), 300);
    }
}

TEST_F(Instances, DoublesAreNotRounded) {
    // The floor consists of squares 2^-20 wide, 1e7 away, where floats are 1 apart.
    const double step = 0x1p-20;
    const dvec3 corner(1e7 + 0.1, -2e7 - 0.7, 3e7);
    std::vector<dvec3> corners;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            const auto at = [&](int x, int y) {
                return corner + dvec3(step * (i + x), step * (j + y), 0);
            };
            for (const dvec3& p : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)})
                corners.push_back(p);
        }
    World w = world();
    w.add(corners, dvec3(0), nullptr);
    w.commit();
    std::vector<Ray> rays;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
            rays.push_back(
                {corner + dvec3(step * (i + 0.75), step * (j + 0.25), 1), 0, {0, 0, -1}});
    const std::vector<Hit> hits = w.intersect(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].t, 1);
        EXPECT_EQ(hits[i].id.prim, 2 * i);
    }
    expect_brute_force(w, rays_at(w.expected, 1000, 1), 100);
}

/// Rays go straight down at seams and corners of tiles. Each must hit.
TEST_F(Instances, TilesShareTheirCornersWhereSumsAreExact) {
    const auto at = [](int x, int y) { return vec3(float(x), float(y), float((x * y) % 3) / 4); };
    std::vector<vec3> tile; // Its opposite sides match.
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (const vec3& p : {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y),
                                  at(x + 1, y + 1), at(x, y + 1)})
                tile.push_back(p);
    World w = world();
    const uint32_t number = w.add(tile, dvec3(0), nullptr, OVC_MESH_TEMPLATE);
    const dvec3 far(5e6, -3e6, 7e5);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            const Matrix m = shift(far + dvec3(3 * i, 3 * j, 0));
            w.instance(number, &m);
        }
    w.commit();
    test::Random random(9);
    std::vector<Ray> rays;
    for (int i = 0; i < 20'000; ++i) {
        const dvec3 in = random.point(0.01, 35.99);
        dvec3 target = far + in;
        (i % 2 ? target.x : target.y) = far[i % 2 ? 0 : 1] + 3.0 * (1 + random.below(11));
        if (i % 3 == 0)
            target = far + 3.0 * dvec3(1 + random.below(11), 1 + random.below(11), 0);
        const dvec3 org = target + dvec3(0, 0, 50) + (i % 5 ? random.point(-1, 1) : dvec3(0));
        rays.push_back({org, 0, dvec3(target.x, target.y, far.z) - org});
    }
    for (const Hit& hit : w.intersect(rays))
        ASSERT_TRUE(hit.is_hit());
}

TEST_F(Instances, MirroredOnesKeepTheirPrimsAndWeights) {
    test::Random random(3);
    const auto corners = random_corners<vec3>(random, 30, 0.5);
    const Matrix mirror = scale({-1, 1, 1});
    World plain = world(), mirrored = world();
    plain.add(corners, dvec3(0), nullptr);
    mirrored.add(corners, dvec3(0), &mirror);
    plain.commit();
    mirrored.commit();
    const std::vector<Ray> rays = rays_at(plain.expected, 1000, 4);
    std::vector<Ray> reflected = rays;
    for (Ray& ray : reflected) {
        ray.org.x = -ray.org.x;
        ray.dir.x = -ray.dir.x;
    }
    const std::vector<Hit> a = plain.intersect(rays), b = mirrored.intersect(reflected);
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(a[i].id, b[i].id);
        ASSERT_EQ(a[i].is_hit(), b[i].is_hit());
        if (a[i].is_hit()) {
            ASSERT_NEAR(a[i].u, b[i].u, 1e-12);
            ASSERT_NEAR(a[i].v, b[i].v, 1e-12);
        }
    }
}

TEST_F(Instances, SingularTransformsFlatten) {
    test::Random random(5);
    const auto corners = random_corners<vec3>(random, 30, 0.5);
    const Matrix onto_plane = scale({1, 1, 0}), onto_line = scale({0, 0, 1}), onto_point{};
    World w = world();
    const uint32_t number = w.add(corners, dvec3(0), nullptr, OVC_MESH_TEMPLATE);
    w.instance(number, &onto_plane);
    w.instance(number, &onto_line);
    w.instance(number, &onto_point);
    w.commit();
    EXPECT_EQ(w.statistics().triangles, 90u);
    EXPECT_EQ(w.statistics().dropped_degenerate, 60u);
    expect_brute_force(w, rays_at(w.expected, 500, 6), 100);
    for (const Hit& hit : w.intersect({{{corners[0].x, corners[0].y, 4}, 0, {0, 0, -2}}})) {
        EXPECT_EQ(hit.t, 2) << "the plane z = 0";
        EXPECT_EQ(hit.id.mesh, 1u);
    }
}

TEST_F(Instances, OverflowIsDroppedAndUnderflowIsZero) {
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Matrix huge = scale(dvec3(1e80)), overflows = scale(dvec3(1e308)),
                 tiny = scale(dvec3(1e-80)), thin = scale({1, 1, 1e-300});
    World w = world();
    w.add(corners, dvec3(0), &huge);
    w.add(corners, dvec3(1e10), &overflows);
    w.add(corners, dvec3(0), &tiny);
    w.add(std::vector<vec3>{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, dvec3(0), &thin);
    w.commit();
    EXPECT_EQ(w.statistics().dropped_not_finite, 2u);
    EXPECT_EQ(w.statistics().dropped_degenerate, 1u);
    const std::vector<Hit> hits = w.intersect({{{0.25, 0.25, 1}, 0, {0, 0, -1}}});
    EXPECT_EQ(hits[0].id, (TriangleId{3, 0}));
    EXPECT_EQ(hits[0].t, 1);
}

/// Far above and below the range of floats, answers are still those of exact arithmetic.
TEST_F(Instances, AnyScaleWithinTheRange) {
    for (const double size : {1e-70, 1e-50, 1e-30, 1e30, 1e50, 1e70}) {
        SCOPED_TRACE(size);
        test::Random random(7);
        const auto corners = random_corners<vec3>(random, 60, 0.4);
        const Matrix m = scale(dvec3(size));
        World w = world();
        w.add(corners, dvec3(0), &m);
        w.commit();
        EXPECT_EQ(w.statistics().dropped_not_finite + w.statistics().dropped_degenerate, 0u);
        expect_brute_force(w, rays_at(w.expected, 500, 8), 50);
    }
}

TEST_F(Instances, WhatMakesNoSenseIsRefused) {
    World w = world();
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<dvec3> doubles(corners.begin(), corners.end());
    Matrix bad = shift(dvec3(0));
    bad[6] = NAN;
    const struct {
        const char* part;
        std::function<void(ovc_mesh&)> spoil;
    } cases[] = {
        {"transform[6] is not finite", [&](ovc_mesh& m) { m.transform = bad.data(); }},
        {"both set", [&](ovc_mesh& m) { m.positions_double = &doubles[0].x; }},
        {"stride is 12, expected 24 or more",
         [&](ovc_mesh& m) {
             m.positions = nullptr, m.positions_double = &doubles[0].x, m.stride = 12;
         }},
        {"stride is 28, expected 24 or more and, as positions_double, a multiple of 8",
         [&](ovc_mesh& m) {
             m.positions = nullptr, m.positions_double = &doubles[0].x, m.stride = 28;
         }},
        {"positions is at an address that is no multiple of 4",
         [&](ovc_mesh& m) {
             m.positions =
                 reinterpret_cast<const float*>(reinterpret_cast<const char*>(&corners[0].x) + 2);
         }},
        {"OVC_MESH_SHARED needs stride 24",
         [&](ovc_mesh& m) {
             m.positions = nullptr, m.positions_double = &doubles[0].x, m.stride = 32;
             m.flags = OVC_MESH_SHARED;
         }},
    };
    for (const auto& c : cases) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = &corners[0].x;
        mesh.vertex_count = 3;
        c.spoil(mesh);
        EXPECT_EQ(api().add_mesh(w.scene.get(), &mesh, nullptr), OVC_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(w.error(), HasSubstr(c.part));
    }
    auto instance = sized<ovc_instance>();
    const auto refused = [&](ovc_result code, const char* part) {
        EXPECT_EQ(api().add_instance(w.scene.get(), &instance, nullptr), code);
        EXPECT_THAT(w.error(), HasSubstr(part));
    };
    refused(OVC_ERROR_INVALID_ARGUMENT, "ovc_instance.mesh is 0, but 0 meshes were added so far");
    w.add(corners, dvec3(0), nullptr);
    instance.transform = bad.data();
    refused(OVC_ERROR_INVALID_ARGUMENT, "ovc_instance.transform[6] is not finite");
    instance.transform = nullptr;
    instance.reserved = 1;
    refused(OVC_ERROR_INVALID_ARGUMENT, "reserved");
    instance.reserved = 0;
    instance.struct_size = 8;
    refused(OVC_ERROR_INVALID_ARGUMENT, "ovc_instance.struct_size is 8");
    EXPECT_EQ(api().add_instance(w.scene.get(), nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().add_instance(nullptr, &instance, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    w.commit();
    EXPECT_EQ(w.statistics().triangles, 1u) << "what was refused left nothing behind";
}

TEST_F(Instances, TheMeshOfAnEarlierHeaderIsFine) {
    World w = world();
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    ovc_mesh mesh;
    // Bytes behind the earlier struct must not be read.
    std::memset(&mesh, 0xff, sizeof(mesh));
    std::memset(&mesh, 0, offsetof(ovc_mesh, positions_double));
    mesh.struct_size = offsetof(ovc_mesh, positions_double);
    mesh.positions = &corners[0].x;
    mesh.vertex_count = 3;
    EXPECT_EQ(api().add_mesh(w.scene.get(), &mesh, nullptr), OVC_OK) << w.error();
    w.commit();
    EXPECT_EQ(w.intersect({{{0.25, 0.25, 1}, 0, {0, 0, -1}}})[0].t, 1);
}

/// Saved levels fit the same instances, and no others.
TEST_F(Instances, AreSavedWithTheirTransforms) {
    test::Random random(13);
    const auto corners = random_corners<vec3>(random, 80, 0.3);
    const Matrix here = any_transform(random, 2);
    Matrix there = here;
    there[3] = std::nextafter(there[3], 9.0);
    const auto made_of = [&](const Matrix& m) {
        World w = world();
        w.instance(w.add(corners, dvec3(0), nullptr), &m);
        w.commit();
        return w;
    };
    const World built = made_of(here);
    EXPECT_EQ(built.statistics().from_saved, 0u);
    test::ArchiveMemory saved;
    const auto append = [](void* user, const void* bytes, size_t size) {
        static_cast<test::ArchiveMemory*>(user)->append(
            {static_cast<const std::byte*>(bytes), size});
        return 0;
    };
    ASSERT_EQ(api().save(built.scene.get(), append, &saved), OVC_OK) << built.error();
    config.saved = saved.bytes().data();
    config.saved_bytes = saved.bytes().size();
    const World again = made_of(here), other = made_of(there);
    EXPECT_EQ(again.statistics().from_saved, 1u);
    EXPECT_EQ(other.statistics().from_saved, 0u) << "a transform one rounding apart";
    expect_brute_force(again, rays_at(again.expected, 1000, 14), 50);
    expect_brute_force(other, rays_at(other.expected, 1000, 14), 50);
}

TEST_F(Instances, NameTheTrianglesThatEmbreesInstancesName) {
    test::Random random(11);
    World w = world();
    test::EmbreeInstances embree;
    for (uint32_t mesh = 0; mesh < 4; ++mesh) {
        const auto corners = random_corners<vec3>(random, 50, 0.4);
        w.add(corners, dvec3(0), nullptr, OVC_MESH_TEMPLATE);
        embree.add_mesh(corners);
    }
    for (uint32_t i = 0; i < 40; ++i) {
        Matrix m = any_transform(random, 4);
        for (double& x : m)
            x = float(x); // Both sides get the same transform.
        w.instance(i % 4, &m);
        embree.add_instance(i % 4, m);
    }
    w.commit();
    embree.commit();
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(w.expected, nullptr, &bounds);
    // Rays go anywhere. Towards sides, floats would decide by chance.
    std::vector<Ray> rays;
    for (int i = 0; i < 50'000; ++i) {
        const dvec3 org = bounds.lo + random.point(0, 1) * bounds.extent();
        rays.push_back({dvec3(vec3(org)), 0, dvec3(vec3(random.point(-1, 1)))});
    }
    const std::vector<Hit> hits = w.intersect(rays);
    size_t differences = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        TriangleId theirs = embree.nearest(rays[i]);
        if (theirs.mesh != kNone)
            theirs.mesh += 4; // Our templates are numbered first.
        if (theirs == hits[i].id)
            continue;
        ++differences;
        const auto truth = test::exact_nearest(w.expected, ids, rays[i]);
        ASSERT_EQ(truth ? truth->id : TriangleId{}, hits[i].id) << "ray " << i;
    }
    std::printf("%zu rays, %zu where Embree names another triangle; exact arithmetic agrees with "
                "Overcast in all of them\n",
                rays.size(), differences);
    EXPECT_LT(differences, rays.size() / 1000);
}

} // namespace
} // namespace ovc
