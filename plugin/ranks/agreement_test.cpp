// SPDX-License-Identifier: Apache-2.0
// Ranks agree on what holds for all, and each of them learns where they cannot.
#include "plugin/ranks/agreement.h"

#include "plugin/ranks/transport/memory_transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

namespace ovc {
namespace {

using testing::HasSubstr;

/// Calls of_rank() for each of three ranks, all at once.
void on_ranks(const std::function<void(uint32_t rank, Notes&, const Transport&)>& of_rank) {
    auto transports = test::MemoryTransport::make(3);
    std::vector<std::thread> threads;
    for (uint32_t rank = 0; rank < transports.size(); ++rank)
        threads.emplace_back([&, rank] {
            Notes notes(*transports[rank]);
            of_rank(rank, notes, *transports[rank]);
            transports[rank]->close();
        });
    for (std::thread& thread : threads)
        thread.join();
}

TEST(Agreement, TakesTheSmallestOfEachNumber) {
    on_ranks([](uint32_t rank, Notes& notes, const Transport& transport) {
        RankTerms mine;
        mine.own.gpu_bytes = 100 - rank;
        mine.own.pool_bytes = 50 + rank;
        mine.own.has_saved = rank != 1;
        const auto all = agreed_terms(notes, transport, mine);
        ASSERT_TRUE(all);
        EXPECT_EQ(all->gpu_bytes, 98u);
        EXPECT_EQ(all->host_bytes, RankTerms::kNoLimit);
        EXPECT_EQ(all->pool_bytes, 50u);
        EXPECT_EQ(all->has_saved, 0u);
    });
}

TEST(Agreement, TellsAllRanksWhoHasBroughtSomethingElse) {
    on_ranks([](uint32_t rank, Notes& notes, const Transport& transport) {
        RankTerms mine;
        mine.alike.triangles = rank == 2 ? 7 : 5;
        const auto meshes = agreed_terms(notes, transport, mine);
        ASSERT_FALSE(meshes);
        EXPECT_EQ(meshes.error().kind, ErrorKind::InvalidArgument);
        EXPECT_THAT(meshes.error().message, HasSubstr("rank 2 on here has 7 triangles"));
        mine.alike = {.soup = rank};
        const auto soup = agreed_terms(notes, transport, mine);
        ASSERT_FALSE(soup);
        EXPECT_THAT(soup.error().message, HasSubstr("rank 1 on here has other positions"));
        mine.alike = {.ranks_own = rank == 1};
        const auto config = agreed_terms(notes, transport, mine);
        ASSERT_FALSE(config);
        EXPECT_THAT(config.error().message, HasSubstr("rank 1 on here has a config other than"));
    });
}

TEST(Agreement, FindsTheRankWhoseSharesAreOthers) {
    on_ranks([](uint32_t rank, Notes& notes, const Transport& transport) {
        EXPECT_TRUE(check_shares(notes, transport, 11));
        EXPECT_EQ(bool(check_shares(notes, transport, rank == 1 ? 12 : 11)), rank != 1);
    });
}

} // namespace
} // namespace ovc
