// SPDX-License-Identifier: Apache-2.0
// Notes arrive whole and in order, whatever their length and that of a message.
#include "plugin/ranks/transport/notes.h"

#include "plugin/ranks/transport/memory_transport.h"

#include <gtest/gtest.h>

#include <functional>
#include <thread>

namespace ovc {
namespace {

using RankNotes = std::vector<std::vector<std::byte>>;

std::vector<std::byte> note_of(size_t length, int seed) {
    std::vector<std::byte> note(length);
    for (size_t i = 0; i < length; ++i)
        note[i] = std::byte(seed + int(i));
    return note;
}

TEST(Notes, ArriveWholeInSeveralMessages) {
    constexpr size_t kMaxPart = 7;
    constexpr uint32_t kRanks = 3;
    const size_t lengths[] = {20, 0, 7}; // that end within a part, are none, and end with one
    auto transports = test::MemoryTransport::make(kRanks);
    std::vector<RankNotes> gathered(kRanks), spread(kRanks);
    std::vector<std::thread> threads;
    for (uint32_t rank = 0; rank < kRanks; ++rank)
        threads.emplace_back([&, rank] {
            Notes notes(*transports[rank], kMaxPart);
            const auto always = [] { return true; };
            const auto to = [&](RankNotes& all) {
                return [&all](uint32_t, std::span<const std::byte> note) {
                    all.emplace_back(note.begin(), note.end());
                };
            };
            for (int time = 0; time < 3; ++time) {
                const size_t length = lengths[(rank + size_t(time)) % 3];
                EXPECT_TRUE(notes.gather(note_of(length, time), always, to(gathered[rank])));
                EXPECT_TRUE(notes.spread(note_of(length, 50), always, to(spread[rank])));
            }
            transports[rank]->close();
        });
    for (std::thread& thread : threads)
        thread.join();
    ASSERT_EQ(gathered[0].size(), 9u);
    EXPECT_TRUE(gathered[1].empty());
    for (size_t i = 0; i < 9; ++i)
        EXPECT_EQ(gathered[0][i], note_of(lengths[(i % 3 + i / 3) % 3], int(i / 3))) << i;
    for (uint32_t rank = 0; rank < kRanks; ++rank) {
        ASSERT_EQ(spread[rank].size(), 3u);
        for (size_t time = 0; time < 3; ++time)
            EXPECT_EQ(spread[rank][time], note_of(lengths[time], 50));
    }
}

} // namespace
} // namespace ovc
