// SPDX-License-Identifier: Apache-2.0
// Tests what users ask of bench: names, lists, sweeps, and mistakes in them.
#include "host/bench/bench_arguments.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

std::vector<std::string> labels(const BenchWords& words) {
    const Result<BenchJob> job = understand_bench(words);
    EXPECT_TRUE(bool(job)) << (job ? "" : job.error().message);
    std::vector<std::string> labels;
    for (const Contender& contender : job->contenders)
        labels.push_back(contender.label());
    return labels;
}

std::string error(const BenchWords& words) {
    const Result<BenchJob> job = understand_bench(words);
    return job ? "" : job.error().message;
}

TEST(BenchArguments, HaveDefaults) {
    const Result<BenchJob> job = understand_bench({});
    ASSERT_TRUE(bool(job));
    EXPECT_THAT(job->scenes, testing::ElementsAre("knot"));
    EXPECT_EQ(job->size.width, 1024u);
    EXPECT_EQ(job->size.height, 1024u);
    EXPECT_EQ(job->repeats, 5u);
    EXPECT_EQ(job->json, "");
    EXPECT_THAT(labels({}), testing::IsSupersetOf({"certified-fragment", "certified-compute",
                                                   "fast-fragment", "fast-compute", "cpu-kdtree"}));
}

TEST(BenchArguments, ChooseContendersByNameOrFirstWord) {
    EXPECT_THAT(labels({.only = "fast-compute,certified"}),
                testing::ElementsAre("certified-fragment", "certified-compute", "fast-compute"));
    EXPECT_THAT(
        labels({.only = "embree"}),
        testing::ElementsAre("embree-medium", "embree-high", "embree-packets", "embree-robust"));
    EXPECT_THAT(labels({.only = "thesis"}),
                testing::ElementsAre("thesis-single-texture", "thesis-multi-texture",
                                     "thesis-gpu-grid", "thesis-gpu-kdtree", "thesis-skip-bvh",
                                     "thesis-two-level"));
    EXPECT_THAT(labels({}), testing::Not(testing::Contains("thesis-gpu-grid")));
    EXPECT_THAT(error({.only = "fast-comput"}),
                testing::AllOf(testing::HasSubstr("there is no contender 'fast-comput'"),
                               testing::HasSubstr("did you mean 'fast-compute'?")));
    EXPECT_THAT(error({.only = "fast,"}), testing::HasSubstr("empty item"));
    EXPECT_THAT(error({.only = "fast-"}), testing::HasSubstr("no contender 'fast-'"));
}

TEST(BenchArguments, GiveAVariantToTheKernelThatItIsOf) {
    const std::string variant = "compute,group=32,branches,array,textures";
    const Result<BenchJob> job =
        understand_bench({.only = "certified,cpu-kdtree", .kernel_variant = variant});
    ASSERT_TRUE(bool(job));
    for (const Contender& contender : job->contenders)
        EXPECT_EQ(contender.kernel_variant, contender.name == "certified-compute" ? variant : "");
    EXPECT_THAT(error({.only = "certified-fragment", .kernel_variant = variant}),
                testing::HasSubstr("none of the contenders has that kernel"));
}

TEST(BenchArguments, SweepThePluginAlone) {
    EXPECT_THAT(
        labels({.only = "certified-compute,cpu-kdtree", .leaves = "1,32", .gpu_memory = "all,12M"}),
        testing::ElementsAre("certified-compute, 1 leaf, budget all",
                             "certified-compute, 1 leaf, budget 12M",
                             "certified-compute, 32 leaves, budget all",
                             "certified-compute, 32 leaves, budget 12M", "cpu-kdtree"));
    EXPECT_THAT(labels({.only = "certified-compute,cpu-kdtree", .instances = "baked,shared"}),
                testing::ElementsAre("certified-compute, baked", "certified-compute, shared",
                                     "cpu-kdtree"));
}

TEST(BenchArguments, UnderstandTheValuesOfSweeps) {
    const auto leaves = parse_leaves_sweep("auto,8,128");
    ASSERT_TRUE(bool(leaves));
    EXPECT_EQ((*leaves)[0].leaves, 0u);
    EXPECT_EQ((*leaves)[2].leaves, 128u);
    const auto instances = parse_instances_sweep("baked,shared");
    ASSERT_TRUE(bool(instances));
    EXPECT_TRUE((*instances)[0].baked);
    EXPECT_FALSE((*instances)[1].baked);
    const auto memory = parse_memory_sweep("all,12M,50%");
    ASSERT_TRUE(bool(memory));
    EXPECT_EQ((*memory)[0].memory.of(1000), 0u);
    EXPECT_EQ((*memory)[1].memory.of(1000), 12u << 20);
    EXPECT_EQ((*memory)[2].memory.of(1000), 500u);
    EXPECT_EQ((*memory)[2].pages_share, 0);
    const auto resident = parse_resident_sweep("30%,all");
    ASSERT_TRUE(bool(resident));
    EXPECT_DOUBLE_EQ((*resident)[0].pages_share, 0.3);
    EXPECT_EQ((*resident)[0].memory.of(1000), 0u);
    EXPECT_EQ((*resident)[1].pages_share, 0);
}

TEST(BenchArguments, ChooseWorkloadsAndHowFarASweepGoes) {
    const Result<BenchJob> job = understand_bench({.workloads = "edges,primary"});
    ASSERT_TRUE(bool(job));
    EXPECT_THAT(job->workloads, testing::ElementsAre("edges", "primary"));
    EXPECT_TRUE(understand_bench({})->workloads.empty());
    EXPECT_EQ(understand_bench({.sweep = "leaves", .most = "300"})->most, 300u);
}

TEST(BenchArguments, LeaveOutWhoeverHoldsAScene) {
    const Result<BenchJob> job = understand_bench(
        {.scenes = {"a.ovc"}, .only = "cpu-kdtree,certified,fast", .host_memory = "2G"});
    ASSERT_TRUE(bool(job)) << job.error().message;
    EXPECT_EQ(job->host_bytes, uint64_t(2) << 30);
    EXPECT_EQ(job->contenders.size(), 4u);
    ASSERT_EQ(job->beyond.size(), 1u);
    EXPECT_EQ(job->beyond[0].name, "cpu-kdtree");
}

TEST(BenchArguments, SayWhatIsWrong) {
    const struct {
        BenchWords words;
        const char* part;
    } cases[] = {
        {{.size = "40"}, "--size needs WIDTHxHEIGHT"},
        {{.repeats = "0"}, "--repeats needs a whole number from 1 to 1000, not '0'"},
        {{.leaves = "8,0"}, "--leaves needs a whole number from 1 to 1000000, not '0'"},
        {{.leaves = "8,,9"}, "--leaves has an empty item"},
        {{.leaves = "8,9,8"}, "--leaves has '8' twice"},
        {{.instances = "kept"}, "--instances"},
        {{.instances = "baked,baked"}, "--instances has 'baked' twice"},
        {{.scenes = {"a.ovc"}, .instances = "baked", .host_memory = "2G"},
         "--instances means nothing with"},
        {{.gpu_memory = "abc"}, "--gpu-memory: 'abc' is no memory size"},
        {{.workloads = "primary,shadows"}, "did you mean 'shadow'?"},
        {{.sweep = "rays", .workloads = "primary"}, "measured itself, without --workloads"},
        {{.most = "5"}, "--most goes with --sweep rays, triangles, instances or leaves"},
        {{.sweep = "budget", .most = "5"},
         "--most goes with --sweep rays, triangles, instances or leaves"},
        {{.sweep = "rays", .most = "x"}, "--most needs a whole number"},
        {{.scenes = {"a.ovc"}, .host_memory = "50%"}, "expected bytes, such as 2G"},
        {{.scenes = {"a.ovc", "knot"}, .host_memory = "2G"},
         "--host-memory goes with .ovc files, which overcast convert makes; found 'knot'"},
        {{.scenes = {"a.ovc"}, .only = "embree", .host_memory = "2G"},
         "--only: none of these keeps to --host-memory"},
        {{.scenes = {"a.ovc"}, .leaves = "8", .host_memory = "2G"}, "--leaves means nothing with"},
        {{.bars = true, .host_memory = "2G"}, "measured itself, without --host-memory"},
        {{.bars = true, .float_rays = true}, "measured itself, without --float-rays"},
        {{.sweep = "rays", .kernel_variant = "array"}, "itself, without --kernel-variant"},
        {{.sweep = "rays", .ranks_own = "all"}, "measured itself, without --ranks-own"},
        {{.programs = true, .device = "0"}, "measured itself, without --device"},
        {{.pictures = "samples", .device = "0"}, "measured itself, without --device"},
        {{.scenes = {"knot"}, .bars = true, .size = "64x32"},
         "--bars draws squares, such as 256x256, not 64x32"},
        {{.resident = "12M"}, "--resident needs a share such as 30%, or all, not '12M'"},
        {{.json = "no/such/folder/b.json"}, "does not exist"},
        {{.scenes = {OVC_SOURCE_DIR "/README.md"}, .json = OVC_SOURCE_DIR "/README.md"},
         "same file"},
    };
    for (const auto& c : cases)
        EXPECT_THAT(error(c.words), testing::HasSubstr(c.part));
}

TEST(BenchArguments, DrawPicturesBySamplesOrTolerance) {
    const Result<BenchJob> samples =
        understand_bench({.scenes = {"sphere-4"}, .pictures = "samples", .most = "16"});
    ASSERT_TRUE(bool(samples)) << samples.error().message;
    EXPECT_EQ(samples->kind, BenchKind::Pictures);
    EXPECT_EQ(samples->pictures, PicturesBy::Samples);
    EXPECT_EQ(samples->most, 16u);
    EXPECT_EQ(samples->size.width, 256u);
    EXPECT_EQ(understand_bench({.pictures = "samples"})->most, 64u);
    EXPECT_EQ(understand_bench({.pictures = "tolerance"})->pictures, PicturesBy::Tolerance);
    const auto error = [](const BenchWords& words) {
        const Result<BenchJob> job = understand_bench(words);
        return job ? "" : job.error().message;
    };
    EXPECT_EQ(error({.scenes = {"knot"}, .pictures = "tolerance"}),
              "--pictures tolerance takes no scene: it has round shapes of its own");
    EXPECT_EQ(error({.scenes = {"knot", "city"}, .pictures = "samples"}),
              "--pictures takes one scene");
    EXPECT_EQ(error({.pictures = "samples", .size = "64x32"}),
              "--pictures draws squares, such as 256x256, not 64x32");
    EXPECT_THAT(
        error({.pictures = "tolerance", .most = "5"}),
        testing::HasSubstr("--most goes with --sweep rays, triangles, instances or leaves, and "
                           "--pictures samples"));
    EXPECT_THAT(error({.pictures = "samples", .most = "1025"}),
                testing::HasSubstr("--most needs a whole number from 1 to 1024"));
    EXPECT_THAT(error({.pictures = "sample"}), testing::HasSubstr("did you mean 'samples'?"));
    EXPECT_THAT(error({.pictures = "samples", .only = "fast"}),
                testing::HasSubstr("--pictures chooses what is measured itself, without --only"));
}

TEST(BenchArguments, ChooseOneKindOfBench) {
    EXPECT_EQ(understand_bench({})->kind, BenchKind::Contenders);
    const Result<BenchJob> leaves = understand_bench({.sweep = "leaves"});
    ASSERT_TRUE(bool(leaves));
    EXPECT_EQ(leaves->kind, BenchKind::Sweep);
    EXPECT_EQ(leaves->sweep, SweepOver::Leaves);
    BenchWords programs;
    programs.scenes = {OVC_SOURCE_DIR "/README.md"}; // any file
    programs.programs = true;
    ASSERT_TRUE(bool(understand_bench(programs)));
    EXPECT_EQ(understand_bench(programs)->size.width, 512u);
    EXPECT_THAT(error({.bars = true}), testing::HasSubstr("--bars needs one mesh file"));
    EXPECT_TRUE(understand_bench({.scenes = {"knot"}, .bars = true}));
    EXPECT_FALSE(understand_bench({.scenes = {"knot"}, .bars = true})->scene_alone);
    EXPECT_TRUE(
        understand_bench({.scenes = {"knot"}, .bars = true, .scene_alone = true})->scene_alone);
    EXPECT_THAT(error({.scenes = {"no-such-file.ply"}, .programs = true}),
                testing::HasSubstr("--programs needs one mesh file"));
    EXPECT_THAT(error({.sweep = "rats"}), testing::HasSubstr("did you mean 'rays'?"));
    EXPECT_THAT(error({.sweep = "rays", .only = "fast"}),
                testing::HasSubstr("--sweep chooses what is measured itself, without --only"));
    EXPECT_THAT(error({.scenes = {"knot"}, .sweep = "triangles"}),
                testing::HasSubstr("takes no scene"));
}

} // namespace
} // namespace ovc
