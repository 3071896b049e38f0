// SPDX-License-Identifier: Apache-2.0
// A StepFile gives back whole steps of the same work, and none of what was cut short or damaged.
#include "importers/file/step_file.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

Bytes bytes_in(const std::string& text) {
    return bytes_of(std::span<const char>(text));
}

/// Returns the steps that the file holds of the work; an error's sentence where it does not open.
std::vector<std::string> steps_in(const TestFolder& folder, std::string_view work) {
    const Result<StepFile> file = StepFile::open(folder / "steps", work);
    if (!file)
        return {folder.plain(file.error().message)};
    std::vector<std::string> steps;
    for (const std::vector<std::byte>& step : file->steps())
        steps.emplace_back(reinterpret_cast<const char*>(step.data()), step.size());
    return steps;
}

TEST(StepFile, GivesBackTheStepsOfTheSameWorkAlone) {
    const TestFolder folder;
    for (const char* step : {"one", "", "three"}) {
        Result<StepFile> file = StepFile::open(folder / "steps", "work");
        ASSERT_TRUE(file);
        EXPECT_TRUE(file->keep(bytes_in(step)));
        EXPECT_EQ(steps_in(folder, "work"),
                  std::vector<std::string>{"steps: another process is at this work"});
    }
    EXPECT_THAT(steps_in(folder, "work"), testing::ElementsAre("one", "", "three"));
    EXPECT_THAT(steps_in(folder, "another"), testing::IsEmpty());
    EXPECT_THAT(steps_in(folder, "work"), testing::IsEmpty());
}

TEST(StepFile, DropsWhatIsCutShortOrDamagedAndGoesOn) {
    const TestFolder folder;
    const std::vector<std::string> all = {"first", "second", "third"};
    {
        Result<StepFile> file = StepFile::open(folder / "steps", "work");
        for (const std::string& step : all)
            ASSERT_TRUE(file && file->keep(bytes_in(step)));
    }
    const std::string whole = folder.read("steps");
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string spoilt = whole;
        spoilt[at] = char(spoilt[at] ^ 4);
        for (const std::string& contents : {whole.substr(0, at), spoilt}) {
            folder.write("steps", contents);
            const std::vector<std::string> left = steps_in(folder, "work");
            ASSERT_LT(left.size(), all.size()) << at;
            EXPECT_TRUE(std::equal(left.begin(), left.end(), all.begin())) << at;
            {
                Result<StepFile> file = StepFile::open(folder / "steps", "work");
                ASSERT_TRUE(file && file->keep(bytes_in("next")));
            }
            EXPECT_EQ(steps_in(folder, "work").size(), left.size() + 1);
        }
    }
}

} // namespace
} // namespace ovc
