// SPDX-License-Identifier: Apache-2.0
// ScratchArray gives back what it took, within its memory, whatever the order of reading.
#include "core/vec.h"
#include "importers/scratch/scratch_array.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

dvec3 item(size_t i) {
    return {double(i), -double(i) / 3, 7};
}

TEST(ScratchArray, GivesBackWhatItTook) {
    constexpr size_t kCount = 100'000;
    for (const uint64_t bytes : {uint64_t(0), uint64_t(300'000), ~uint64_t(0)}) {
        SCOPED_TRACE(bytes);
        ScratchArray<dvec3> array(std::filesystem::temp_directory_path(), bytes);
        std::mt19937 random(1);
        for (size_t i = 0; i < kCount; ++i) {
            array.push_back(item(i));
            const size_t j = random() % (i + 1);
            ASSERT_EQ(array[j], item(j));
        }
        EXPECT_EQ(array.size(), kCount);
        for (size_t i = 0; i < kCount; ++i)
            ASSERT_EQ(array[i], item(i));
        EXPECT_EQ(array.error(), nullptr);
        array.clear();
        EXPECT_EQ(array.size(), 0u);
    }
}

TEST(ScratchArray, TellsThatThereIsNoSuchFolder) {
    ScratchArray<dvec3> array("/no/such/folder", 0);
    for (size_t i = 0; i < 3 * array.kItems; ++i)
        array.push_back(item(i));
    EXPECT_EQ(array.error(), nullptr) << "three pages fit";
    array.push_back(item(0));
    ASSERT_NE(array.error(), nullptr);
    EXPECT_EQ(array.error()->message, "/no/such/folder: no scratch file can be made there: No such "
                                      "file or directory");
    array[0];
}

} // namespace
} // namespace ovc
