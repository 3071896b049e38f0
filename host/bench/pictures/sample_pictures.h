// SPDX-License-Identifier: Apache-2.0
// Measures time against a picture's error, by samples a pixel: overcast in each precision, povray
// and tachyon on the same triangles.
#pragma once

#include "core/scene.h"
#include "host/bench/pictures/picture_race.h"
#include "host/bench/scene_bench.h"

#include <string>
#include <vector>

namespace ovc {

struct SamplePicturesJob {
    std::string scene;   // its triangles, in one gray material, under one light with shadows
    uint32_t size = 256; // of the square picture
    uint32_t most = 64;  // samples a pixel
    uint32_t runs = 5;   // of each choice
};

struct SamplePictures {
    struct Choice {
        std::string program; // "certified", "povray"
        uint32_t samples;
    };
    std::string scene;
    uint64_t triangles = 0;
    uint32_t size = 0;
    uint32_t reference_samples = 0; // a pixel, with cpu-kdtree
    std::vector<std::string> not_installed;
    std::vector<Choice> choices;
    PictureRace race; // in the order of choices
};

/// Returns pictures with 1, 4, 16, ... samples a pixel, up to job.most. The reference is drawn by
/// the CPU's KD-tree in double precision with four times job.most. Times are those of whole
/// processes, from file to picture. Error: a scene that cannot be read, a program that fails, a
/// full disk.
Result<SamplePictures> run_sample_pictures(const SamplePicturesJob& job,
                                           const BenchSurroundings& around);

std::string sample_pictures_table(const SamplePictures& result);
std::string sample_pictures_json(const SamplePictures& result);

} // namespace ovc
