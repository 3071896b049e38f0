// SPDX-License-Identifier: Apache-2.0
// A file that is replaced is whole at any time, whoever else replaces it, and leaves no other file.
#include "core/file/replace_file.h"

#include "core/file/mapped_file.h"
#include "core/text/format_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <unistd.h>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class ReplaceFile : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "ovc-replace-XXXXXX").string();
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
    }
    void TearDown() override { fs::remove_all(folder); }

    bool replace(const std::string& text) const {
        return replace_file(folder / "file", bytes_of(std::span<const char>(text)));
    }
    std::string found() const {
        std::ifstream file(folder / "file", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    }
    size_t files() const {
        return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }

    fs::path folder;
};

TEST_F(ReplaceFile, LeavesTheNewBytesAndNoOtherFile) {
    for (const std::string text : {"", "some", "some more than before", "few"}) {
        EXPECT_TRUE(replace(text));
        EXPECT_EQ(found(), text);
        EXPECT_EQ(files(), 1u);
    }
}

TEST_F(ReplaceFile, IsWholeWhileManyReplaceIt) {
    // The texts have several pages and other lengths, so that one that is cut or mixed is seen.
    const auto text_of = [](char writer) { return std::string(10'000 + size_t(writer), writer); };
    ASSERT_TRUE(replace(text_of('a')));
    std::atomic<bool> ends{false};
    std::jthread reader([&] {
        while (!ends) {
            const std::string text = found();
            ASSERT_FALSE(text.empty());
            ASSERT_EQ(text, text_of(text[0]));
        }
    });
    {
        std::vector<std::jthread> writers;
        for (char writer = 'a'; writer < 'e'; ++writer)
            writers.emplace_back([&, writer] {
                for (int i = 0; i < 200; ++i)
                    EXPECT_TRUE(replace(text_of(writer)));
            });
    }
    ends = true;
    reader.join();
    EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, TakesNoNameThatIsTakenAndLeavesThatFileAlone) {
    constexpr int kTaken = 2000; // more than the other tests of this process use up
    for (int i = 0; i < kTaken; ++i)
        std::ofstream(folder / format_text(".ovc-{}-{}", getpid(), i)) << "of another process";
    EXPECT_TRUE(replace("new"));
    EXPECT_EQ(found(), "new");
    EXPECT_EQ(files(), size_t(kTaken) + 1);
}

TEST_F(ReplaceFile, FailsWhereTheFolderTakesNoFiles) {
    const std::string text = "text";
    const Bytes bytes = bytes_of(std::span<const char>(text));
    EXPECT_FALSE(replace_file(folder / "none" / "file", bytes));
    fs::create_directories(folder / "file" / "full");
    EXPECT_FALSE(replace(text)) << "a folder has the name";
    EXPECT_EQ(files(), 1u);
}

} // namespace
} // namespace ovc
