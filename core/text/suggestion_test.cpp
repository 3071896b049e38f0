// SPDX-License-Identifier: Apache-2.0
#include "core/text/suggestion.h"

#include <gtest/gtest.h>

#include <fstream>

#include <unistd.h>

namespace ovc {
namespace {

namespace fs = std::filesystem;

TEST(Suggestion, FilesOfTheFolderAreProposedWhereTheirNamesAreNear) {
    const fs::path folder =
        fs::path(testing::TempDir()) / ("overcast-suggestion-" + std::to_string(getpid()));
    fs::create_directories(folder / "dragnn.ply");
    for (const char* name : {"dragon.ply", "Bunny.PLY", "a", "lucy.obj", "lucy.ply"})
        std::ofstream(folder / name) << "x";
    const struct {
        const char* missing;
        const char* hint;
    } cases[] = {{"dragn.ply", "; did you mean 'dragon.ply'?"},
                 {"dargon.ply", "; did you mean 'dragon.ply'?"},
                 {"dragon.pl", "; did you mean 'dragon.ply'?"},
                 {"bunny.ply", "; did you mean 'Bunny.PLY'?"},
                 {"lucy.pyl", "; did you mean 'lucy.ply'?"},
                 {"teapot.ply", ""},
                 {"none/dragn.ply", ""},
                 {"", ""}};
    for (const auto& test : cases)
        EXPECT_EQ(did_you_mean_file(folder / test.missing), test.hint) << test.missing;
    fs::remove_all(folder);
}

} // namespace
} // namespace ovc
