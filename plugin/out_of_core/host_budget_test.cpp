// SPDX-License-Identifier: Apache-2.0
// HostBudget: its parts stay below the whole, for every budget that is large enough.
#include "plugin/out_of_core/host_budget.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(HostBudget, PartsStayBelowTheWhole) {
    for (const uint64_t triangles : {1'000ull, 3'000'000ull, 250'000'000ull, 2'000'000'000ull})
        for (const size_t threads : {1u, 2u, 64u})
            for (const uint64_t times : {1, 3, 50}) {
                const HostBudget budget{times * smallest_host_budget(triangles, threads), threads};
                ASSERT_GT(budget.leaf_triangles(), 0u);
                const uint64_t cells = 2 * triangles / budget.leaf_triangles() + 1;
                EXPECT_LE(cells * budget.buffer_bytes(cells), budget.bytes / 8 + 4096);
                const uint64_t in_buffer = budget.buffer_bytes(cells) / 48;
                EXPECT_LE(triangles / in_buffer * 16, budget.bytes / 4) << "kept of each buffer";
                EXPECT_LE(budget.triangles_at_once() * kBytesOfCell, budget.bytes / 2);
                EXPECT_LE(triangles / budget.sample_rate(triangles) * kBytesOfSample,
                          budget.bytes / 4);
            }
}

TEST(HostBudget, ACellOfDoublesHoldsFewerTriangles) {
    const HostBudget floats{100 << 20, 3}, doubles{100 << 20, 3, /* has_doubles= */ true};
    EXPECT_LT(doubles.leaf_triangles(), floats.leaf_triangles());
    EXPECT_LE(doubles.triangles_at_once() * (kBytesOfCell + kBytesOfDouble), doubles.bytes / 2);
}

} // namespace
} // namespace ovc
