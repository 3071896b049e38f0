// SPDX-License-Identifier: Apache-2.0
// Tests instances that share the pages of their mesh: every bit is that of the triangles moved by
// hand.
#include "core/system/stopwatch.h"
#include "tests/abi/instances_world.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ovc {
namespace {

using namespace test;

/// Returns a transform of one of the kinds that people place meshes by, or of a kind to avoid.
Matrix transform_of_any_kind(Random& random) {
    const dvec3 at = std::pow(10.0, double(random.below(5))) * random.point(-1, 1);
    const Matrix turned = any_transform(random, 0);
    switch (random.below(8)) {
    case 0:
        return shift(at);
    case 1: { // This turns about an axis.
        const double angle = random.point(0, 6).x, c = std::cos(angle), s = std::sin(angle);
        return {c, -s, 0, at.x, s, c, 0, at.y, 0, 0, 1, at.z};
    }
    case 2:
        return product(shift(at), scale({-1, 2, 0.5})); // This mirrors.
    case 3:
        return product(shift(at), scale({1e4, 1, 1e-4}));
    case 4: // This shears.
        return {1, 300 * random.point(-1, 1).x, 0, at.x, 0, 1, 7, at.y, 0, 0, 1, at.z};
    case 5: { // This is nearly singular.
        Matrix m = product(turned, product(scale({1, 1, 1e-9}), turned));
        m[3] = at.x;
        return m;
    }
    case 6:
        return product(turned, scale({1, random.below(2) ? 1.0 : 0.0, 1})); // This may be singular.
    default:
        return product(shift(at), turned);
    }
}

/// Returns a mesh of any kind that is large enough to be shared.
std::vector<vec3> mesh_of_any_kind(Random& random) {
    auto corners = random_corners<vec3>(random, 120 + random.below(120), 0.3);
    if (random.below(2))
        // Many corners coincide, or lie on lines and in planes.
        for (vec3& corner : corners)
            corner = glm::round(corner * 4.0f) / 4.0f;
    if (random.below(3) == 0) // Some triangles come twice.
        corners.insert(corners.end(), corners.begin(), corners.begin() + 30);
    // These have three different corners on a line.
    if (random.below(3) == 0)
        for (int i = 0; i < 3; ++i)
            corners.insert(corners.end(),
                           {vec3(0.1f * float(i)), vec3(0.3f + float(i)), vec3(0.7f + float(i))});
    return corners;
}

/// With shared pages, whatever the transforms, every bit is that of the triangles moved by hand.
/// OVC_INSTANCES_SECONDS=600 tests for that long.
TEST_F(Instances, SharePagesAndAnswerAlike) {
    const char* const asked = std::getenv("OVC_INSTANCES_SECONDS");
    const double seconds = asked ? std::strtod(asked, nullptr) : 8;
    const Stopwatch watch;
    uint64_t rays_asked = 0, shared = 0;
    for (uint64_t round = 0; round < 6 || watch.seconds() < seconds; ++round) {
        // Seed 360 needs a stack of 36 words.
        const uint64_t seed = round == 0 ? 360 : round - 1;
        SCOPED_TRACE(seed);
        Random random(seed);
        config.leaf_triangles = random.below(3) ? 0 : 40;
        config.kernel = random.below(2) ? OVC_KERNEL_FRAGMENT : OVC_KERNEL_AUTO;
        config.gpu_memory_bytes = random.below(3) ? 0 : 300 << 10;
        World w = world();
        std::vector<uint32_t> numbers;
        for (uint32_t mesh = 0; mesh < 1 + random.below(3); ++mesh)
            numbers.push_back(w.add(mesh_of_any_kind(random), random.point(-1, 1), nullptr,
                                    random.below(2) ? OVC_MESH_TEMPLATE : 0));
        const uint32_t instances = 3 + random.below(12);
        Matrix before = shift(dvec3(0));
        for (uint32_t i = 0; i < instances; ++i) {
            const Matrix m = random.below(5) ? transform_of_any_kind(random) : before;
            numbers.push_back(w.instance(numbers[random.below(uint32_t(numbers.size()))], &m));
            before = m;
        }
        w.commit();
        const ovc_statistics statistics = w.statistics();
        shared += statistics.instances > 0;
        EXPECT_EQ(statistics.triangles, w.expected.triangle_count());
        const std::vector<Ray> rays = rays_at(w.expected, 300, seed);
        // Doubles miss slivers that rays aim at.
        expect_brute_force(w, rays, 5, /* most_hit= */ false);
        expect_brute_force_with_skips(w, rays, seed);
        rays_asked += rays.size();
    }
    EXPECT_GT(shared, 3u);
    std::printf("%llu rays, %llu scenes with shared pages: none off by a bit\n",
                static_cast<unsigned long long>(rays_asked),
                static_cast<unsigned long long>(shared));
}

/// A hundred instances in one place count as one for rays and for memory.
TEST_F(Instances, InOnePlaceAreOne) {
    Random random(11);
    const auto corners = random_corners<vec3>(random, 200, 0.3);
    const Matrix m = any_transform(random, 3);
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

} // namespace
} // namespace ovc
