// SPDX-License-Identifier: Apache-2.0
// expect_same() compares the levels of two scenes.
#pragma once

#include "plugin/build/built_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace ovc::test {

inline bool same(const Box& a, const Box& b) {
    return a.lo == b.lo && a.hi == b.hi;
}

/// Expects two scenes to have the same levels, bit for bit.
inline void expect_same(const BuiltScene& a, const BuiltScene& b) {
    EXPECT_EQ(a.dropped.not_finite, b.dropped.not_finite);
    EXPECT_EQ(a.dropped.degenerate, b.dropped.degenerate);
    EXPECT_EQ(a.duplicates.count(), b.duplicates.count());
    ASSERT_EQ(a.duplicates.pairs().size(), b.duplicates.pairs().size());
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.level1.shares_frame, b.level1.shares_frame);
    EXPECT_EQ(a.level1.far_leaves, b.level1.far_leaves);
    EXPECT_TRUE(same(a.level1.bounds, b.level1.bounds) || a.level1.leaves.empty());
    EXPECT_EQ(a.level1.padding, b.level1.padding);
    ASSERT_EQ(a.level1.nodes.size(), b.level1.nodes.size());
    EXPECT_TRUE(a.level1.nodes.empty() || std::memcmp(a.level1.nodes.data(), b.level1.nodes.data(),
                                                      a.level1.nodes.size() * sizeof(KdNode)) == 0);
    ASSERT_EQ(a.level1.leaves.size(), b.level1.leaves.size());
    ASSERT_EQ(a.pages.size(), b.pages.size());
    for (size_t i = 0; i < a.pages.size(); ++i) {
        const Leaf &la = a.level1.leaves[i], &lb = b.level1.leaves[i];
        EXPECT_TRUE(same(la.cell, lb.cell) && same(la.box, lb.box) && same(la.grid, lb.grid));
        EXPECT_TRUE(std::ranges::equal(la.list(), lb.list()));
        EXPECT_EQ(la.frame.origin, lb.frame.origin);
        EXPECT_EQ(la.frame.scale, lb.frame.scale);
        EXPECT_EQ(a.pages[i].depth, b.pages[i].depth);
        EXPECT_TRUE(std::ranges::equal(a.pages[i].view(), b.pages[i].view()));
    }
}

} // namespace ovc::test
