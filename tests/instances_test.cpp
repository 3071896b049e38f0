// SPDX-License-Identifier: Apache-2.0
// Doubles, transforms and instances through the ABI, against the same triangles moved by hand:
// every bit against brute force, a sample against exact rationals, and ids against Embree's own
// instances.
#include "core/stopwatch.h"
#include "core/test_archive.h"
#include "kdtree/test_soups.h"
#include "tests/abi_scene.h"
#include "tests/embree_instances.h"
#include "tests/exact.h"

#include <gmock/gmock.h>

#include <cstring>
#include <map>

namespace ovc {
namespace {

using test::api;
using test::sized;
using testing::HasSubstr;
using Transform = std::array<double, 12>;

/// As overcast.h has it.
dvec3 moved(const Transform& m, const dvec3& p) {
    dvec3 q;
    for (int row = 0; row < 3; ++row) {
        const double* r = &m[size_t(4 * row)];
        q[row] = ((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + r[3];
    }
    return q;
}

Transform product(const Transform& second, const Transform& first) {
    Transform both{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 4; ++j) {
            const double* r = &second[4 * i];
            both[4 * i + j] = (r[0] * first[j] + r[1] * first[4 + j]) + r[2] * first[8 + j];
            if (j == 3)
                both[4 * i + j] += r[3];
        }
    return both;
}

Transform shift(const dvec3& by) {
    return {1, 0, 0, by.x, 0, 1, 0, by.y, 0, 0, 1, by.z};
}

Transform scale(const dvec3& by) {
    return {by.x, 0, 0, 0, 0, by.y, 0, 0, 0, 0, by.z, 0};
}

/// Any affine map: rotations, shears, mirrors, whatever comes.
Transform any_transform(test::Random& random, double reach) {
    Transform m;
    for (size_t i = 0; i < 12; ++i)
        m[i] = random.point(-1, 1).x * (i % 4 == 3 ? reach : 1);
    return m;
}

/// A scene behind the ABI, and its triangles where overcast.h says they are, mesh by mesh.
class World {
public:
    World(ovc_device device, const ovc_scene_config& config) : device_(device) {
        ovc_scene created = nullptr;
        EXPECT_EQ(api().create_scene(device, &config, &created), OVC_OK);
        scene.reset(created);
    }

    uint32_t add(const std::vector<vec3>& positions, const dvec3& origin, const Transform* m,
                 uint32_t flags = 0) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions = &positions[0].x;
        return add(mesh, {positions.begin(), positions.end()}, origin, m, flags);
    }
    uint32_t add(const std::vector<dvec3>& positions, const dvec3& origin, const Transform* m,
                 uint32_t flags = 0) {
        auto mesh = sized<ovc_mesh>();
        mesh.positions_double = &positions[0].x;
        return add(mesh, positions, origin, m, flags);
    }
    uint32_t instance(uint32_t mesh, const Transform* m) {
        auto given = sized<ovc_instance>();
        given.mesh = mesh;
        given.transform = m ? m->data() : nullptr;
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_instance(scene.get(), &given, &number), OVC_OK) << error();
        const Transform first = transforms_.count(mesh) ? transforms_[mesh] : shift(dvec3(0));
        const bool has_both = m && transforms_.count(mesh);
        if (m)
            transforms_[number] = has_both ? product(*m, first) : *m;
        else if (transforms_.count(mesh))
            transforms_[number] = first;
        sources_[number] = sources_[mesh];
        expect(number, /* is_template= */ false);
        return number;
    }

    void commit() { ASSERT_EQ(api().commit(scene.get()), OVC_OK) << error(); }

    std::vector<Hit> intersect(const std::vector<Ray>& rays) const {
        std::vector<Hit> hits(rays.size());
        EXPECT_EQ(api().intersect(scene.get(), reinterpret_cast<const ovc_ray*>(rays.data()),
                                  rays.size(), reinterpret_cast<ovc_hit*>(hits.data()), nullptr),
                  OVC_OK)
            << error();
        return hits;
    }
    ovc_statistics statistics() const {
        auto statistics = sized<ovc_statistics>();
        EXPECT_EQ(api().statistics(scene.get(), &statistics), OVC_OK) << error();
        return statistics;
    }
    std::string error() const { return api().last_error(device_); }

    test::AbiScene scene;
    Soup expected;

private:
    uint32_t add(ovc_mesh& mesh, std::vector<dvec3> positions, const dvec3& origin,
                 const Transform* m, uint32_t flags) {
        mesh.vertex_count = positions.size();
        mesh.flags = flags;
        mesh.transform = m ? m->data() : nullptr;
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = origin[axis];
        uint32_t number = OVC_NONE;
        EXPECT_EQ(api().add_mesh(scene.get(), &mesh, &number), OVC_OK) << error();
        for (dvec3& p : positions)
            p = origin + p;
        sources_[number] = std::move(positions);
        if (m)
            transforms_[number] = *m;
        expect(number, flags & OVC_MESH_TEMPLATE);
        return number;
    }
    void expect(uint32_t number, bool is_template) {
        EXPECT_EQ(number, expected.chunks.size()) << "numbered in the order they are added";
        std::vector<dvec3> corners;
        if (!is_template)
            corners = sources_[number];
        if (transforms_.count(number))
            for (dvec3& p : corners)
                p = moved(transforms_[number], p);
        expected.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
    }

    ovc_device device_;
    std::map<uint32_t, std::vector<dvec3>> sources_; // as overcast.h has them, without transforms
    std::map<uint32_t, Transform> transforms_;
};

template <class Corner>
std::vector<Corner> random_corners(test::Random& random, size_t triangles, double size) {
    std::vector<Corner> corners;
    for (size_t i = 0; i < triangles; ++i) {
        const dvec3 middle = random.point(-1, 1);
        for (int c = 0; c < 3; ++c)
            corners.push_back(Corner(middle + size * random.point(-1, 1)));
    }
    return corners;
}

/// At corners, at sides, and anywhere within the triangles of a soup, from all around.
std::vector<Ray> rays_at(const Soup& soup, size_t count, uint64_t seed) {
    test::Random random(seed);
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const Triangle t = soup.triangle(ids[random.below(uint32_t(ids.size()))]);
        dvec3 weights = random.point(0, 1);
        weights.x = i % 4 < 1 ? 0 : weights.x;
        weights.y = i % 8 < 1 ? 0 : weights.y;
        weights /= weights.x + weights.y + weights.z;
        const dvec3 target = weights.x * t[0] + weights.y * t[1] + weights.z * t[2];
        const dvec3 org = bounds.center() + max_component(bounds.extent()) * random.point(-1, 1);
        rays.push_back({org, 0, target - org});
    }
    return rays;
}

/// Bit for bit what testing every triangle answers; and of some rays what exact rationals say.
void expect_brute_force(const World& world, const std::vector<Ray>& rays, size_t exactly,
                        bool most_hit = true) {
    const std::vector<TriangleId> ids = hittable_triangles(world.expected, nullptr, nullptr);
    const std::vector<Hit> hits = world.intersect(rays);
    size_t hit_count = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const PreparedRay p(rays[i]);
        Nearest nearest(p);
        for (const TriangleId id : ids)
            nearest.offer(world.expected.triangle(id), id);
        const Hit expected = nearest.hit();
        ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof(Hit)), 0)
            << "ray " << i << ": (" << hits[i].id.mesh << ", " << hits[i].id.prim << ") at "
            << hits[i].t << ", expected (" << expected.id.mesh << ", " << expected.id.prim
            << ") at " << expected.t;
        hit_count += hits[i].is_hit();
    }
    EXPECT_GT(hit_count, most_hit ? rays.size() / 2 : 0);
    for (size_t i = 0; i < std::min(exactly, rays.size()); ++i) {
        const auto truth = test::exact_nearest(world.expected, ids, rays[i]);
        ASSERT_EQ(truth ? truth->id : TriangleId{}, hits[i].id) << "ray " << i;
    }
}

/// The same where each ray does not see one triangle, often the one that it would hit; and whether
/// anything is hit.
void expect_brute_force_with_skips(const World& world, const std::vector<Ray>& rays,
                                   uint64_t seed) {
    test::Random random(seed);
    const std::vector<TriangleId> ids = hittable_triangles(world.expected, nullptr, nullptr);
    const std::vector<Hit> first = world.intersect(rays);
    std::vector<ovc_triangle> skip;
    for (const Hit& hit : first) {
        const TriangleId id =
            hit.is_hit() && random.below(4) ? hit.id : ids[random.below(uint32_t(ids.size()))];
        skip.push_back({id.mesh, id.prim});
    }
    auto query = sized<ovc_query>();
    query.skip = skip.data();
    const auto* const asked = reinterpret_cast<const ovc_ray*>(rays.data());
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    ASSERT_EQ(api().intersect(world.scene.get(), asked, rays.size(),
                              reinterpret_cast<ovc_hit*>(hits.data()), &query),
              OVC_OK);
    ASSERT_EQ(api().occluded(world.scene.get(), asked, rays.size(), occluded.data(), &query),
              OVC_OK);
    for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected =
            test::brute_force(world.expected, ids, rays[i], {skip[i].mesh, skip[i].prim});
        ASSERT_EQ(std::memcmp(&hits[i], &expected, sizeof(Hit)), 0)
            << "ray " << i << " does not see (" << skip[i].mesh << ", " << skip[i].prim << "): ("
            << hits[i].id.mesh << ", " << hits[i].id.prim << ") at " << hits[i].t << ", expected ("
            << expected.id.mesh << ", " << expected.id.prim << ") at " << expected.t;
        ASSERT_EQ(occluded[i] != 0, expected.is_hit()) << "ray " << i;
    }
}

class Instances : public test::DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped())
            return;
        config.leaf_triangles = 50;
    }
    World world() const { return World(device.get(), config); }

    ovc_scene_config config = sized<ovc_scene_config>();
};

TEST_F(Instances, AnswerAsTheirTrianglesMovedByHandDo) {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const double reach = std::pow(10, int(seed)) - 0.9; // from on top of each other to far away
        World w = world();
        const auto floats = random_corners<vec3>(random, 40, 0.3);
        const auto doubles = random_corners<dvec3>(random, 40, 0.3);
        const Transform placed = any_transform(random, reach);
        const uint32_t sources[] = {
            w.add(floats, dvec3(0.1, 1e3, -7), nullptr),
            w.add(doubles, random.point(-1, 1), nullptr),
            w.add(floats, dvec3(0), &placed),
            w.add(doubles, dvec3(0.3), &placed, OVC_MESH_SHARED),
            w.add(floats, dvec3(0), nullptr, OVC_MESH_TEMPLATE),
            w.add(doubles, dvec3(1.7), &placed, OVC_MESH_TEMPLATE | OVC_MESH_SHARED)};
        std::vector<uint32_t> numbers(std::begin(sources), std::end(sources));
        for (int i = 0; i < 15; ++i) {
            const Transform m = any_transform(random, reach);
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
    // A floor of squares 2^-20 wide, 1e7 away: floats are 1 apart there.
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

/// Rays straight down at seams and corners of tiles: each must hit.
TEST_F(Instances, TilesShareTheirCornersWhereSumsAreExact) {
    const auto at = [](int x, int y) { return vec3(float(x), float(y), float((x * y) % 3) / 4); };
    std::vector<vec3> tile; // its opposite sides match
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
            const Transform m = shift(far + dvec3(3 * i, 3 * j, 0));
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
    const Transform mirror = scale({-1, 1, 1});
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
    const Transform onto_plane = scale({1, 1, 0}), onto_line = scale({0, 0, 1}), onto_point{};
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
    const Transform huge = scale(dvec3(1e80)), overflows = scale(dvec3(1e308)),
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

/// Far above and below what floats hold, answers are still those of exact arithmetic.
TEST_F(Instances, AnyScaleWithinTheRange) {
    for (const double size : {1e-70, 1e-50, 1e-30, 1e30, 1e50, 1e70}) {
        SCOPED_TRACE(size);
        test::Random random(7);
        const auto corners = random_corners<vec3>(random, 60, 0.4);
        const Transform m = scale(dvec3(size));
        World w = world();
        w.add(corners, dvec3(0), &m);
        w.commit();
        EXPECT_EQ(w.statistics().dropped_not_finite + w.statistics().dropped_degenerate, 0u);
        expect_brute_force(w, rays_at(w.expected, 500, 8), 50);
    }
}

/// A map of one of the kinds that people place meshes by, and some that nobody should.
Transform transform_of_any_kind(test::Random& random) {
    const dvec3 at = std::pow(10.0, double(random.below(5))) * random.point(-1, 1);
    const Transform turned = any_transform(random, 0);
    switch (random.below(8)) {
    case 0:
        return shift(at);
    case 1: { // a turn about an axis
        const double angle = random.point(0, 6).x, c = std::cos(angle), s = std::sin(angle);
        return {c, -s, 0, at.x, s, c, 0, at.y, 0, 0, 1, at.z};
    }
    case 2:
        return product(shift(at), scale({-1, 2, 0.5})); // a mirror
    case 3:
        return product(shift(at), scale({1e4, 1, 1e-4}));
    case 4: // a shear
        return {1, 300 * random.point(-1, 1).x, 0, at.x, 0, 1, 7, at.y, 0, 0, 1, at.z};
    case 5: { // nearly singular
        Transform m = product(turned, product(scale({1, 1, 1e-9}), turned));
        m[3] = at.x;
        return m;
    }
    case 6:
        return product(turned, scale({1, random.below(2) ? 1.0 : 0.0, 1})); // singular
    default:
        return product(shift(at), turned);
    }
}

/// Meshes of every kind that are large enough to be shared.
std::vector<vec3> mesh_of_any_kind(test::Random& random) {
    auto corners = random_corners<vec3>(random, 120 + random.below(120), 0.3);
    if (random.below(2))
        for (vec3& corner : corners) // many share corners, lie on lines and in planes
            corner = glm::round(corner * 4.0f) / 4.0f;
    if (random.below(3) == 0) // some come twice
        corners.insert(corners.end(), corners.begin(), corners.begin() + 30);
    if (random.below(3) == 0) // on a line, but with three corners
        for (int i = 0; i < 3; ++i)
            corners.insert(corners.end(),
                           {vec3(0.1f * float(i)), vec3(0.3f + float(i)), vec3(0.7f + float(i))});
    return corners;
}

/// Shared pages, whatever the transforms: every bit is that of the triangles moved by hand.
/// OVC_INSTANCES_SECONDS=600 goes on for as long.
TEST_F(Instances, SharePagesAndAnswerAlike) {
    const char* const asked = std::getenv("OVC_INSTANCES_SECONDS");
    const double seconds = asked ? std::strtod(asked, nullptr) : 8;
    const Stopwatch watch;
    uint64_t rays_asked = 0, shared = 0;
    for (uint64_t round = 0; round < 6 || watch.seconds() < seconds; ++round) {
        const uint64_t seed = round == 0 ? 360 : round - 1; // 360: a stack of 36 words
        SCOPED_TRACE(seed);
        test::Random random(seed);
        config.leaf_triangles = random.below(3) ? 0 : 40;
        config.kernel = random.below(2) ? OVC_KERNEL_FRAGMENT : OVC_KERNEL_AUTO;
        config.gpu_memory_bytes = random.below(3) ? 0 : 300 << 10;
        World w = world();
        std::vector<uint32_t> numbers;
        for (uint32_t mesh = 0; mesh < 1 + random.below(3); ++mesh)
            numbers.push_back(w.add(mesh_of_any_kind(random), random.point(-1, 1), nullptr,
                                    random.below(2) ? OVC_MESH_TEMPLATE : 0));
        const uint32_t instances = 3 + random.below(12);
        Transform before = shift(dvec3(0));
        for (uint32_t i = 0; i < instances; ++i) {
            const Transform m = random.below(5) ? transform_of_any_kind(random) : before;
            numbers.push_back(w.instance(numbers[random.below(uint32_t(numbers.size()))], &m));
            before = m;
        }
        w.commit();
        const ovc_statistics statistics = w.statistics();
        shared += statistics.instances > 0;
        EXPECT_EQ(statistics.triangles, w.expected.triangle_count());
        const std::vector<Ray> rays = rays_at(w.expected, 300, seed);
        expect_brute_force(w, rays, 5, /* most_hit= */ false); // doubles miss slivers they aim at
        expect_brute_force_with_skips(w, rays, seed);
        rays_asked += rays.size();
    }
    EXPECT_GT(shared, 3u);
    std::printf("%llu rays, %llu scenes with shared pages: none off by a bit\n",
                static_cast<unsigned long long>(rays_asked),
                static_cast<unsigned long long>(shared));
}

/// A hundred instances in one place are one to a ray, and to the memory.
TEST_F(Instances, InOnePlaceAreOne) {
    test::Random random(11);
    const auto corners = random_corners<vec3>(random, 200, 0.3);
    const Transform m = any_transform(random, 3);
    World one = world(), many = world();
    for (World* w : {&one, &many}) {
        const uint32_t number = w->add(corners, dvec3(0), nullptr);
        for (int i = 0; i < (w == &one ? 1 : 100); ++i)
            w->instance(number, &m);
        w->commit();
    }
    EXPECT_EQ(many.statistics().level2_bytes, one.statistics().level2_bytes);
    EXPECT_EQ(many.statistics().twins, 99 * 200u);
    const std::vector<Ray> rays = rays_at(one.expected, 500, 12);
    const std::vector<Hit> a = one.intersect(rays), b = many.intersect(rays);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)), 0);
    expect_brute_force_with_skips(many, std::vector<Ray>(rays.begin(), rays.begin() + 60), 13);
}

TEST_F(Instances, WhatMakesNoSenseIsRefused) {
    World w = world();
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<dvec3> doubles(corners.begin(), corners.end());
    Transform bad = shift(dvec3(0));
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
    instance.struct_size = sizeof(instance);
    refused(OVC_ERROR_INVALID_STATE, "add_instance: the scene is committed");
}

TEST_F(Instances, TheMeshOfAnEarlierHeaderIsFine) {
    World w = world();
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    ovc_mesh mesh;
    std::memset(&mesh, 0xff, sizeof(mesh)); // what lies behind the earlier struct is not looked at
    std::memset(&mesh, 0, offsetof(ovc_mesh, positions_double));
    mesh.struct_size = offsetof(ovc_mesh, positions_double);
    mesh.positions = &corners[0].x;
    mesh.vertex_count = 3;
    EXPECT_EQ(api().add_mesh(w.scene.get(), &mesh, nullptr), OVC_OK) << w.error();
    w.commit();
    EXPECT_EQ(w.intersect({{{0.25, 0.25, 1}, 0, {0, 0, -1}}})[0].t, 1);
}

/// What was saved fits the same instances, and no others.
TEST_F(Instances, AreSavedWithTheirTransforms) {
    test::Random random(13);
    const auto corners = random_corners<vec3>(random, 80, 0.3);
    const Transform here = any_transform(random, 2);
    Transform there = here;
    there[3] = std::nextafter(there[3], 9.0);
    const auto made_of = [&](const Transform& m) {
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
        Transform m = any_transform(random, 4);
        for (double& x : m)
            x = float(x); // both are asked the same
        w.instance(i % 4, &m);
        embree.add_instance(i % 4, m);
    }
    w.commit();
    embree.commit();
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(w.expected, nullptr, &bounds);
    std::vector<Ray> rays; // anywhere, not at sides, where floats decide by chance
    for (int i = 0; i < 50'000; ++i) {
        const dvec3 org = bounds.lo + random.point(0, 1) * bounds.extent();
        rays.push_back({dvec3(vec3(org)), 0, dvec3(vec3(random.point(-1, 1)))});
    }
    const std::vector<Hit> hits = w.intersect(rays);
    size_t differences = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        TriangleId theirs = embree.nearest(rays[i]);
        if (theirs.mesh != kNone)
            theirs.mesh += 4; // the templates are numbered first
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
