// SPDX-License-Identifier: Apache-2.0
// Tests numbers of meshes that come apart.
#include "host/backend/mesh_numbers.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Returns the numbers of meshes 0, 1, 2 after 1 and 2 were replaced.
MeshNumbers replaced() {
    MeshNumbers numbers;
    for (const uint32_t number : {0u, 1u, 2u})
        numbers.add(number);
    EXPECT_FALSE(numbers.differ());
    numbers.forget_from(1);
    for (const uint32_t number : {3u, 4u})
        numbers.add(number);
    return numbers;
}

TEST(MeshNumbers, AreTranslatedBothWays) {
    const MeshNumbers numbers = replaced();
    EXPECT_TRUE(numbers.differ());
    EXPECT_EQ(numbers.count(), 3u);
    const uint32_t expected[] = {0, 3, 4};
    for (uint32_t mesh = 0; mesh < 3; ++mesh) {
        EXPECT_EQ(numbers.in_library(mesh), expected[mesh]);
        EXPECT_EQ(numbers.in_scene(TriangleId{expected[mesh], 7}), (TriangleId{mesh, 7}));
        EXPECT_EQ(numbers.in_library(TriangleId{mesh, 7}), (TriangleId{expected[mesh], 7}));
    }
    EXPECT_EQ(numbers.in_scene(TriangleId()), TriangleId());
    EXPECT_EQ(numbers.in_library(TriangleId()), TriangleId());
    std::vector<Hit> hits(2);
    hits[1].id = {4, 9};
    numbers.to_scene(hits);
    EXPECT_FALSE(hits[0].is_hit());
    EXPECT_EQ(hits[1].id, (TriangleId{2, 9}));
}

TEST(MeshNumbers, OfExclusionsAndFiltersAreTranslated) {
    struct Second final : HitFilter {
        bool keep(std::span<const uint64_t>, std::span<const Hit> hits,
                  std::span<uint8_t> keep) override {
            for (size_t i = 0; i < hits.size(); ++i)
                keep[i] = hits[i].id.mesh == 2;
            return true;
        }
    } filter;
    const MeshNumbers numbers = replaced();
    const std::vector<TriangleId> skip{{1, 5}, {}};
    std::vector<Hit> after(2);
    after[0].id = {2, 6};
    const LibraryExclusions excluded(numbers, skip, after);
    EXPECT_EQ(excluded.skip()[0], (TriangleId{3, 5}));
    EXPECT_EQ(excluded.skip()[1], TriangleId());
    EXPECT_EQ(excluded.after()[0].id, (TriangleId{4, 6}));
    std::vector<Hit> hits(2);
    hits[0].id = {3, 0};
    hits[1].id = {4, 0};
    const uint64_t rays[2] = {0, 1};
    uint8_t keep[2] = {1, 1};
    EXPECT_TRUE(LibraryFilter(numbers, filter).keep(rays, hits, keep));
    EXPECT_EQ(keep[0], 0);
    EXPECT_EQ(keep[1], 1);
}

} // namespace
} // namespace ovc
