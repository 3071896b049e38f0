// SPDX-License-Identifier: Apache-2.0
// A portal's doubles reach the kernel whole, whatever the halves of their bits look like.
#include "plugin/two_level/test_two_level.h"

#include "kdtree/test_soups.h"

#include <bit>
#include <vector>

namespace ovc {
namespace {

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
