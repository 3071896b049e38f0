// SPDX-License-Identifier: Apache-2.0
// Archive: parts come back as written, in place; changed bits and missing bytes are noticed.
#include "core/file/archive.h"

#include "core/file/test_archive.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

using test::ArchiveMemory;

const std::vector<double> kNumbers = {1, 2.5, -3};
const std::string kText = "seventeen letters";

ArchiveMemory example() {
    ArchiveMemory file;
    ArchiveWriter writer(file.sink(), "example", 7);
    writer.part<double>("numbers", kNumbers);
    writer.begin("nothing");
    writer.begin("text");
    writer.write(bytes_of(std::span<const char>(kText).first(5)));
    writer.write(bytes_of(std::span<const char>(kText).subspan(5)));
    EXPECT_TRUE(writer.finish());
    return file;
}

TEST(Archive, GivesBackItsParts) {
    const ArchiveMemory memory = example();
    const auto archive = Archive::open(memory.bytes(), "example", 7);
    ASSERT_TRUE(archive) << archive.error().message;
    const auto numbers = archive->items<double>("numbers");
    ASSERT_TRUE(numbers);
    EXPECT_TRUE(std::equal(numbers->begin(), numbers->end(), kNumbers.begin(), kNumbers.end()));
    const auto text = archive->items<char>("text", kText.size());
    ASSERT_TRUE(text);
    EXPECT_EQ(std::string(text->begin(), text->end()), kText);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(text->data()) % kPartAlignment, 0u);
    ASSERT_TRUE(archive->part("nothing"));
    EXPECT_TRUE(archive->part("nothing")->empty());
    EXPECT_EQ(archive->part("something").error().message, "has no part 'something'");
    EXPECT_EQ(archive->items<double>("numbers", 2).error().message,
              "is damaged: its part 'numbers' has the wrong size");
    EXPECT_EQ(archive->items<double>("text").error().message,
              "is damaged: its part 'text' has the wrong size");
}

TEST(Archive, OthersAreRefusedWithAReason) {
    const ArchiveMemory memory = example();
    EXPECT_EQ(Archive::open(memory.bytes(), "other", 7).error().message,
              "does not begin as other does");
    EXPECT_EQ(Archive::open(memory.bytes(), "example", 8).error().message,
              "is of version 7, expected 8");
    EXPECT_EQ(Archive::open({}, "example", 7).error().message, "is too short to be whole");
}

ReadBytes reading(Bytes bytes) {
    return [bytes](uint64_t offset, std::span<std::byte> to) {
        EXPECT_FALSE(to.empty()) << "a host may copy to the null pointer then";
        if (offset > bytes.size() || to.size() > bytes.size() - offset)
            return false;
        std::copy_n(bytes.begin() + ptrdiff_t(offset), to.size(), to.begin());
        return true;
    };
}

/// Returns whether all parts are found to be as they were written. It does not matter whether the
/// archive lies in memory.
bool is_whole(Bytes bytes) {
    const auto archive = Archive::open(bytes, "example", 7);
    const bool whole =
        archive && archive->part("numbers") && archive->part("nothing") && archive->part("text");
    const auto stored = StoredArchive::open(reading(bytes), bytes.size(), "example", 7);
    EXPECT_EQ(whole, stored && stored->items<double>("numbers") && stored->items<char>("nothing") &&
                         stored->items<char>("text"));
    if (!archive || !stored) {
        EXPECT_EQ(archive.error().message, stored.error().message);
    }
    return whole;
}

TEST(StoredArchive, GivesTheSameParts) {
    const ArchiveMemory memory = example();
    const auto archive = StoredArchive::open(reading(memory.bytes()), memory.size(), "example", 7);
    ASSERT_TRUE(archive) << archive.error().message;
    const auto numbers = archive->items<double>("numbers");
    ASSERT_TRUE(numbers);
    EXPECT_EQ(*numbers, kNumbers);
    EXPECT_EQ(archive->items<double>("numbers", 2).error().message,
              "is damaged: its part 'numbers' has the wrong size");
    EXPECT_EQ(archive->items<char>("something").error().message, "has no part 'something'");
    EXPECT_EQ(archive->place("text").bytes, kText.size());
    EXPECT_EQ(archive->place("something").bytes, 0u);
}

TEST(StoredArchive, EveryReadThatFailsIsSaid) {
    const ArchiveMemory memory = example();
    for (int failing = 0; failing < 4; ++failing) {
        int reads = 0;
        const ReadBytes whole = reading(memory.bytes());
        const ReadBytes read = [&](uint64_t offset, std::span<std::byte> to) {
            return reads++ != failing && whole(offset, to);
        };
        const auto archive = StoredArchive::open(read, memory.size(), "example", 7);
        if (failing < 3)
            EXPECT_EQ(archive.error().message, "cannot be read");
        else
            EXPECT_EQ(archive->items<double>("numbers").error().message,
                      "cannot be read: its part 'numbers'");
    }
}

TEST(Archive, EveryChangedBitIsNoticedButInThePaddingBetweenParts) {
    ArchiveMemory memory = example();
    size_t unnoticed = 0;
    for (size_t bit = 0; bit < 8 * memory.size(); ++bit) {
        memory.data()[bit / 8] ^= std::byte(1 << bit % 8);
        unnoticed += is_whole(memory.bytes());
        memory.data()[bit / 8] ^= std::byte(1 << bit % 8);
    }
    const size_t padding = (64 - 24) + (64 - kText.size());
    EXPECT_EQ(unnoticed, 8 * padding);
    EXPECT_TRUE(is_whole(memory.bytes()));
}

TEST(Archive, EveryMissingEndIsNoticed) {
    const ArchiveMemory memory = example();
    for (size_t size = 0; size < memory.size(); ++size)
        EXPECT_FALSE(is_whole(memory.bytes().first(size))) << size;
}

TEST(Archive, ResealedItIsWholeAgain) {
    ArchiveMemory memory = example();
    memory.data()[64] ^= std::byte(1); // in the first part
    EXPECT_FALSE(is_whole(memory.bytes()));
    test::reseal(memory);
    EXPECT_TRUE(is_whole(memory.bytes()));
}

TEST(Archive, AFullSinkIsTold) {
    size_t room = 300;
    ArchiveWriter writer(
        [&](Bytes bytes) { return bytes.size() <= room && (room -= bytes.size()); }, "example", 1);
    writer.begin("a");
    const std::vector<std::byte> much(400);
    writer.write(much);
    EXPECT_FALSE(writer.finish());
}

} // namespace
} // namespace ovc
