// SPDX-License-Identifier: Apache-2.0
// These tests cut off the fuzzer's pbrt_seeds everywhere and change their bytes, as the fuzzer does
// for longer.
#include "importers/test_files.h"
#include "tests/fuzz/pbrt.h"

#include <random>

namespace ovc {
namespace {

std::vector<std::string> pbrt_seeds() {
    return contents_of(OVC_SOURCE_DIR "/importers/pbrt/corpus");
}

void survives_pbrt(const std::string& text) {
    fuzz_pbrt(reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

TEST(PbrtDamage, SeedsAreScenes) {
    ASSERT_GE(pbrt_seeds().size(), 4u);
    const TestFolder folder;
    for (const std::string& text : pbrt_seeds())
        EXPECT_GT(triangles_of(load(folder.write("seed.pbrt", text))).size(), 20u);
}

TEST(PbrtDamage, EveryBeginningIsASceneOrASentence) {
    for (const std::string& text : pbrt_seeds())
        for (size_t length = 0; length < text.size(); length += 3)
            survives_pbrt(text.substr(0, length));
}

TEST(PbrtDamage, AnyByteMayBeAnyOther) {
    constexpr std::string_view kOdd = "\"[]#-.9eE \n\\\0\xff";
    for (const std::string& text : pbrt_seeds()) {
        std::mt19937 random(uint32_t(text.size()));
        for (int i = 0; i < 1500; ++i) {
            std::string damaged = text;
            for (uint32_t n = random() % 3; n < 3; ++n)
                damaged[random() % text.size()] = kOdd[random() % kOdd.size()];
            survives_pbrt(damaged);
        }
    }
}

TEST(PbrtDamage, WordsMayStandAnywhere) {
    for (const std::string& text : pbrt_seeds()) {
        std::vector<std::string> words;
        for (size_t at = 0, end; at < text.size(); at = end + 1) {
            end = std::min(text.find_first_of(" \n", at), text.size());
            words.push_back(text.substr(at, end - at));
        }
        std::mt19937 random(7);
        for (int i = 0; i < 500; ++i) {
            std::string shuffled;
            std::vector<std::string> mixed = words;
            for (int swaps = 0; swaps < 4; ++swaps)
                std::swap(mixed[random() % mixed.size()], mixed[random() % mixed.size()]);
            for (const std::string& word : mixed)
                shuffled.append(word).append("\n");
            survives_pbrt(shuffled);
        }
    }
}

} // namespace
} // namespace ovc
