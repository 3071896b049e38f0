// SPDX-License-Identifier: Apache-2.0
#include "importers/file/gzip_file.h"

#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace ovc {
namespace {

/// The bytes that a file gives, and then the reason why it gives no more.
struct Given {
    std::string text;
    std::string damage;
    bool is_compressed = false;

    bool operator==(const Given&) const = default;
};

/// Reads a file in pieces of so many bytes.
Given read_all(const std::filesystem::path& path, size_t piece) {
    const auto file = GzipFile::open(path);
    Given given;
    std::string part(piece, ' ');
    for (size_t got = piece; got == piece;) {
        got = file->read({reinterpret_cast<unsigned char*>(part.data()), piece}, given.damage);
        given.text.append(part, 0, got);
    }
    given.is_compressed = file->is_compressed();
    return given;
}

/// Returns a text that does not compress to nothing.
std::string long_text() {
    std::string text;
    for (uint32_t i = 0; i < 100'000; ++i)
        text += std::to_string(i * 2654435761u);
    return text;
}

TEST(GzipFile, GivesWhatGzipGives) {
    const TestFolder folder;
    const std::string text = long_text(), packed = gzip(text);
    const struct {
        const char* name;
        std::string contents;
        Given expected;
    } cases[] = {{"plain", text, {text, "", false}},
                 {"empty", "", {"", "", false}},
                 {"half a mark", "\x1f", {"\x1f", "", false}},
                 {"packed", packed, {text, "", true}},
                 {"nothing, packed", gzip(""), {"", "", true}},
                 {"two members", packed + gzip("behind"), {text + "behind", "", true}},
                 {"zeros behind", packed + std::string(1000, '\0'), {text, "", true}},
                 {"half a mark behind", packed + "\x1f", {text, "", true}},
                 {"a mark alone", "\x1f\x8b", {"", "the compressed data ends early", true}}};
    for (const auto& test : cases) {
        const auto path = folder.write("file", test.contents);
        for (const size_t piece : {test.contents.size() / 1000 + 1, size_t(1) << 18})
            EXPECT_EQ(read_all(path, piece), test.expected) << test.name << ", " << piece;
    }
}

TEST(GzipFile, TellsOfDamageBehindWhatIsSound) {
    const TestFolder folder;
    const std::string text = long_text(), packed = gzip(text);
    const auto read = [&](const std::string& contents) {
        return read_all(folder.write("file", contents), 1 << 18);
    };
    const Given cut = read(packed.substr(0, packed.size() / 2));
    EXPECT_EQ(cut.damage, "the compressed data ends early");
    EXPECT_GT(cut.text.size(), text.size() / 3);
    EXPECT_TRUE(text.starts_with(cut.text));
    std::string flipped = packed;
    flipped[packed.size() - 6] ^= 1; // in the checksum
    const Given checked = read(flipped);
    EXPECT_EQ(checked.damage, "the compressed data is damaged: incorrect checksum");
    EXPECT_EQ(checked.text, text);
    EXPECT_EQ(read(std::string("\x1f\x8b") + "no method").damage,
              "the compressed data is damaged: unknown compression method");
}

} // namespace
} // namespace ovc
