// SPDX-License-Identifier: Apache-2.0
// A floor that reaches far beyond a mesh: hits are those of brute force, and the floor leaves few
// of them in doubt, however it is turned. And meshes far away in frames of their own.
#include "plugin/two_level/test_two_level.h"

#include "kdtree/test_soups.h"

#include <bit>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace ovc {
namespace {

using test::Floor;
using test::ok;

/// Returns a floor near 0, however it is turned, that reaches so far to all sides.
Floor random_floor(test::Random& random, double reach) {
    const dvec3 through = random.point(-0.5, 0.5);
    const dvec3 along = glm::normalize(random.point(-1, 1)) * reach;
    return {through, along, glm::normalize(glm::cross(along, random.point(-1, 1))) * reach};
}

/// Returns rays from around a mesh of size 1, at it and at the floor near it. Some begin on the
/// floor, and some end close to it.
std::vector<Ray> rays_near(const Floor& floor, double reach, size_t count) {
    test::Random random(7);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        const double near = 3 / reach;
        const dvec3 on_floor = floor.at(random(-near, near), random(-near, near));
        Ray ray{.org = random.point(-3, 3)};
        ray.dir = (i % 2 ? on_floor : random.point(-1, 1)) - ray.org;
        if (i % 16 == 5) {
            ray.org = on_floor;
            ray.dir = random.point(-1, 1);
        } else if (i % 16 == 7) {
            ray.t_max = random(0.999, 1.001);
        } else if (i % 16 == 9) {
            ray.t_min = random(0.999, 1.001);
        } else if (i % 16 == 13) { // at the side that both triangles share
            const double along = random(-near, near);
            ray.dir = floor.at(along, along) - ray.org;
        } else if (i % 16 == 15) { // at an outer side, far away
            ray.dir = floor.at(random(-1, 1), 1) - ray.org;
        } else if (i % 16 == 11) {
            ray.dir =
                floor.along * (random(-1, 1) / reach) + floor.across * (random(-1, 1) / reach);
            ray.org = on_floor - ray.dir * random(0, 2);
        }
        rays.push_back(ray);
    }
    return rays;
}

/// Returns those of rays_near() that aim at nothing in particular.
std::vector<Ray> plain_of(const std::vector<Ray>& rays) {
    std::vector<Ray> plain;
    for (size_t i = 0; i < rays.size(); ++i)
        if (i % 16 < 4)
            plain.push_back(rays[i]);
    return plain;
}

/// Returns how many of the rays are not certain to the kernel.
uint64_t flagged_of(TwoLevel& structure, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    const uint64_t before = structure.statistics().flagged;
    EXPECT_TRUE(ok(structure.intersect(rays, {}, hits)));
    return structure.statistics().flagged - before;
}

/// The parameters are how far the floor reaches, and whether the kernel is the compute kernel.
class FarTrianglesGl : public TwoLevelGl,
                       public testing::WithParamInterface<std::tuple<double, bool>> {};
INSTANTIATE_TEST_SUITE_P(Reach, FarTrianglesGl,
                         testing::Combine(testing::Values(1e3, 1e6, 1e9), testing::Bool()),
                         [](const auto& of) {
                             return std::string("E").append(
                                        std::to_string(int(std::log10(std::get<0>(of.param))))) +
                                    (std::get<1>(of.param) ? "Compute" : "Fragment");
                         });

TEST_P(FarTrianglesGl, LetAFloorLeaveFewHitsInDoubt) {
    const auto [reach, compute] = GetParam();
    for (uint64_t seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const Floor floor = random_floor(random, reach);
        Soup soup = test::closed_grid(24);
        soup.chunks.push_back(floor.chunk(1));
        const std::vector<Ray> rays = rays_near(floor, reach, 4000);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        const auto structure = build(soup, {.leaf_triangles = 100, .compute = compute});
        ASSERT_TRUE(structure);
        test::expect_answers(*structure, rays, expected);
        const std::vector<Ray> plain = plain_of(rays);
        EXPECT_LE(flagged_of(*structure, plain), plain.size() / 50);
    }
}

/// No triangle touches many cells where there are few leaves, or one.
TEST_P(FarTrianglesGl, AreFoundWhereAllElseIsOneLeaf) {
    const auto [reach, compute] = GetParam();
    for (const uint32_t across : {2u, 24u}) {
        SCOPED_TRACE(across);
        test::Random random(across);
        const Floor floor = random_floor(random, reach);
        Soup soup = test::closed_grid(across);
        soup.chunks.push_back(floor.chunk(1));
        const std::vector<Ray> rays = rays_near(floor, reach, 4000);
        const auto structure = build(soup, {.leaf_triangles = 1 << 20, .compute = compute});
        ASSERT_TRUE(structure);
        EXPECT_EQ(structure->scene().level1.leaves.size(), 2u);
        test::expect_answers(*structure, rays, test::brute_force(soup, rays));
        const std::vector<Ray> plain = plain_of(rays);
        EXPECT_LE(flagged_of(*structure, plain), plain.size() / 50);
    }
}

TEST_P(FarTrianglesGl, AreLeftToPagesWhereTheyAreManyOrPlaced) {
    const auto [reach, compute] = GetParam();
    test::Random random(11);
    const Floor floor = random_floor(random, reach);
    Soup soup = test::closed_grid(24);
    soup.chunks.push_back(floor.chunk(20));
    Chunk second = soup.chunks[1].instance();
    second.place({{{{0.8, 0.1, 0.2, 0.4}, {-0.3, 0.9, 0, 0.2}, {0.1, 0.2, 1.1, -0.7}}}});
    soup.chunks.push_back(std::move(second));
    const std::vector<Ray> rays = rays_near(floor, reach, 4000);
    const auto structure = build(soup, {.leaf_triangles = 100, .compute = compute});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, test::brute_force(soup, rays));
}

/// Returns flat boxes of all sizes, which stand through each other: parts that overlap, in frames
/// of their own.
Chunk flat_boxes(test::Random& random, int count) {
    std::vector<dvec3> corners;
    for (int i = 0; i < count; ++i) {
        dvec3 half{std::exp(random(0, 6)), std::exp(random(-3, 0)), std::exp(random(0, 6))};
        std::swap(half.y, half[int(random.below(3))]);
        const dvec3 middle = random.point(-50, 50);
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                const auto at = [&](int a, int b) {
                    dvec3 corner;
                    corner[axis] = side;
                    corner[(axis + 1) % 3] = a;
                    corner[(axis + 2) % 3] = b;
                    return middle + half * corner;
                };
                corners.insert(corners.end(),
                               {at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1)});
            }
    }
    return Chunk::owning_doubles(dvec3(0), std::move(corners));
}

TEST_P(FarTrianglesGl, AnswerRaysThatMeetOverlappingParts) {
    const auto [reach, compute] = GetParam();
    for (uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        Soup soup;
        soup.chunks.push_back(flat_boxes(random, 40 + 10 * int(seed % 8)));
        soup.chunks.push_back(random_floor(random, reach).chunk(1));
        std::vector<Ray> rays;
        for (int i = 0; i < 4000; ++i) {
            Ray ray{.org = random.point(-100, 100)};
            const Triangle aim =
                soup.chunks[0].triangle(uint32_t(random.below(soup.chunks[0].size())));
            ray.dir =
                glm::mix(glm::mix(aim[0], aim[1], random(0, 1)), aim[2], random(0, 1)) - ray.org;
            rays.push_back(ray);
        }
        const auto structure =
            build(soup, {.leaf_triangles = uint32_t(40 + 40 * (seed % 5)), .compute = compute});
        ASSERT_TRUE(structure);
        test::expect_answers(*structure, rays, test::brute_force(soup, rays));
    }
}

/// Returns a number near x whose low word is a subnormal number, if it is taken for a float.
double with_subnormal_low_word(double x, test::Random& random) {
    const uint64_t high = std::bit_cast<uint64_t>(x) & ~uint64_t(0xffffffff);
    return std::bit_cast<double>(high | (0x400000 + random.below(0x400000)));
}

/// Parameter: whether the kernel is the compute kernel.
class PortalNumbersGl : public TwoLevelGl, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(Of, PortalNumbersGl, testing::Bool(),
                         [](const auto& of) { return of.param ? "Compute" : "Fragment"; });

/// An NVIDIA driver loses such a word of what is in an array of doubles: a mesh at 4,915,200 then
/// lies up to 8 mm elsewhere.
TEST_P(PortalNumbersGl, KeepTheirLowWords) {
    test::Random random(3);
    const auto number = [&](double lo, double hi) {
        return with_subnormal_low_word(random(lo, hi), random);
    };
    Soup soup = test::closed_grid(24);
    std::vector<dvec3> places;
    for (int i = 0; i < 8; ++i) {
        places.push_back({number(4.9e6, 4.91e6), number(1e3, 2e3), number(-4.91e6, -4.9e6)});
        Chunk instance = soup.chunks[0].instance();
        instance.place({{{{number(0.8, 1), 0, number(0.1, 0.2), places[i].x},
                          {0, number(0.8, 1), 0, places[i].y},
                          {number(-0.2, -0.1), 0, number(0.8, 1), places[i].z}}}});
        soup.chunks.push_back(std::move(instance));
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 aim = places[random.below(places.size())] + random.point(-1, 1);
        const dvec3 org = aim + random.point(-4, 4);
        rays.push_back({org, 0, aim - org});
    }
    const auto structure = build(soup, {.compute = GetParam()});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, test::brute_force(soup, rays));
}

} // namespace
} // namespace ovc
