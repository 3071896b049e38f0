// SPDX-License-Identifier: Apache-2.0
// The fuzzers' seeds of PLY, OBJ and pictures, whole and damaged: what the fuzzers do for longer.
#include "importers/pov/pictures/picture.h"
#include "importers/test_files.h"
#include "tests/fuzz/importers.h"

#include <random>

namespace ovc {
namespace {

namespace fs = std::filesystem;

void survive(const std::string& kind, void (*fuzz)(const uint8_t*, size_t), size_t min_seeds) {
    size_t seeds = 0;
    for (const auto& entry : fs::directory_iterator(OVC_SOURCE_DIR "/tests/fuzz/" + kind)) {
        SCOPED_TRACE(entry.path());
        ++seeds;
        if (kind == "pictures") {
            EXPECT_TRUE(pov::read_picture(entry.path()));
        } else {
            EXPECT_FALSE(triangles_of(load(entry.path())).empty());
        }
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string whole{std::istreambuf_iterator<char>(file), {}};
        const auto run = [&](const std::string& bytes) {
            fuzz(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
        };
        for (size_t length = 0; length <= whole.size(); ++length)
            run(whole.substr(0, length));
        std::mt19937 random(uint32_t(whole.size()));
        for (int i = 0; i < 4000; ++i) {
            std::string damaged = whole;
            for (uint32_t n = random() % 4; n < 4; ++n)
                damaged[random() % whole.size()] =
                    char(random() % 2 ? random() : "0-9/ \n"[random() % 6]);
            run(damaged);
        }
    }
    EXPECT_GE(seeds, min_seeds);
}

TEST(FuzzSeeds, DamagedPlyFilesAreScenesOrErrors) {
    survive("ply", fuzz_ply, 6);
}

TEST(FuzzSeeds, DamagedObjFilesAreScenesOrErrors) {
    survive("obj", fuzz_obj, 3);
}

TEST(FuzzSeeds, DamagedPicturesArePicturesOrErrors) {
    survive("pictures", fuzz_pictures, 7);
}

} // namespace
} // namespace ovc
