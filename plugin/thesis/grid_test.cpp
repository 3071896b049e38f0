// SPDX-License-Identifier: Apache-2.0
// Tests the grid's resolution, and that the cell around each point of a triangle lists it.
#include "plugin/thesis/grid.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc::thesis {
namespace {

TEST(Grid, HasAboutFiveCubesATriangle) {
    const auto cubes = grid_resolution(dvec3(1, 2, 4), 100000);
    const double cells = double(cubes[0]) * cubes[1] * cubes[2];
    EXPECT_NEAR(cells / 100000, 5, 0.5);
    EXPECT_NEAR(double(cubes[2]) / cubes[0], 4, 0.1);
    const auto flat = grid_resolution(dvec3(1, 1, 0.001), 1000000);
    EXPECT_EQ(flat[0], 1024u);
    EXPECT_GE(flat[2], 1u);
}

/// Reads the texels of a grid as the kernel does.
struct Reader {
    const Texels& texels;

    float number(size_t texel, int i) const { return std::bit_cast<float>(texels[texel][i]); }
    bool lists(const vec3& point, uint32_t id) const {
        uint32_t index = 0;
        for (int axis = 2; axis >= 0; --axis) {
            const float at = std::floor((point[axis] - number(0, axis)) / number(1, axis));
            const uint32_t count = texels[2][axis];
            index = index * count + uint32_t(std::clamp(at, 0.0f, float(count - 1)));
        }
        const uvec4 two = texels[texels[3].x + index / 2];
        const uint32_t first = two[index % 2 * 2], end = two[index % 2 * 2 + 1];
        for (uint32_t r = first; r < end; ++r)
            if (texels[texels[3].y + r / 4][r % 4] == id)
                return true;
        return false;
    }
};

TEST(Grid, ListsEachTriangleWhereverItIs) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        if (ids.empty())
            continue;
        const Leaf whole = whole_leaf(soup, ids, bounds);
        const Result<System> grid = build_grid(soup, whole);
        ASSERT_TRUE(grid);
        const Reader reader{grid->texels};
        const auto triangles = local_triangles(soup, whole);
        test::Random random(7);
        for (uint32_t i = 0; i < triangles.size(); ++i)
            for (int k = 0; k < 20; ++k) {
                const float u = float(random(0, 1)), v = float(random(0, 1 - u));
                const LocalTriangle& t = triangles[i];
                const vec3 point = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
                ASSERT_TRUE(reader.lists(point, i)) << name << ", triangle " << i;
            }
    }
}

} // namespace
} // namespace ovc::thesis
