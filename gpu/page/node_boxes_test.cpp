// SPDX-License-Identifier: Apache-2.0
#include "gpu/page/node_boxes.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <array>

namespace ovc {
namespace {

/// Returns a coordinate as coordinates() of shaders/box.glsl decodes it, in cells from the grid's
/// first.
double in_kernel(uint32_t word, size_t child) {
    return double(int32_t(child & 1 ? word : word << 16)) / 65536 + kGridMiddle;
}

TEST(NodeBoxes, ComeBackAndTheKernelSeesNoLess) {
    test::Random random(3);
    for (int i = 0; i < 10000; ++i) {
        std::array<GridRange, 4> ranges;
        for (GridRange& range : ranges) {
            range.lo = uint32_t(random(1, kGridLast + 1));
            range.hi = uint32_t(random(range.lo, kGridLast + 1));
        }
        if (i % 2)
            ranges[size_t(i / 2 % 4)] = GridRange();
        uvec4 words(0x12345678);
        for (size_t child = 0; child < 4; ++child)
            put_range(words, child, ranges[child]);
        for (size_t child = 0; child < 4; ++child) {
            const GridRange& range = ranges[child];
            ASSERT_EQ(range_of(words, child), range);
            const double lo = in_kernel(words[int(child / 2)], child);
            const double hi = in_kernel(words[int(2 + child / 2)], child);
            ASSERT_LE(lo, range.lo);
            ASSERT_GE(lo, double(range.lo) - 1);
            ASSERT_GE(hi, range.hi);
            ASSERT_LT(hi, double(range.hi) + 1);
            ASSERT_EQ(lo > hi, range.empty());
        }
    }
}

} // namespace
} // namespace ovc
