// SPDX-License-Identifier: Apache-2.0
// Tests saving through the ABI: a later scene answers with the same bits without building. A scene
// notices bytes that are damaged or belong to another scene, and then builds.
#include "core/file/test_archive.h"
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <cstring>
#include <mutex>

namespace ovc {
namespace {

using test::api;
using testing::HasSubstr;

class Saved : public testing::Test {
protected:
    void SetUp() override {
        auto config = test::sized<ovc_device_config>();
        config.log = [](void* user, ovc_log_level, const char* message) {
            *static_cast<std::string*>(user) += std::string(message) + "\n";
        };
        config.log_user = &log;
        config.threads = 4; // a build out of core takes memory for each
        ovc_device opened = nullptr;
        api().create_device(&config, &opened);
        device.reset(opened);
        if (!device)
            GTEST_SKIP() << api().last_error(nullptr);
    }

    static int append(void* user, const void* bytes, size_t size) {
        static_cast<test::ArchiveMemory*>(user)->append(
            {static_cast<const std::byte*>(bytes), size});
        return 0;
    }

    /// Returns a committed scene, which starts from the saved bytes if there are any.
    test::AbiScene committed(const Soup& soup, Bytes saved, ovc_scene_config config) {
        config.saved = saved.data();
        config.saved_bytes = saved.size();
        test::AbiScene scene = test::add_soup(device, soup, config);
        EXPECT_TRUE(scene) << api().last_error(device.get());
        log.clear();
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << api().last_error(device.get());
        return scene;
    }
    test::AbiScene committed(const Soup& soup, Bytes saved) {
        return committed(soup, saved, leaves_of(200));
    }

    static ovc_scene_config leaves_of(uint64_t triangles) {
        auto config = test::sized<ovc_scene_config>();
        config.leaf_triangles = triangles;
        return config;
    }

    test::ArchiveMemory save(const test::AbiScene& scene) {
        test::ArchiveMemory memory;
        EXPECT_EQ(api().save(scene.get(), append, &memory), OVC_OK)
            << api().last_error(device.get());
        return memory;
    }

    std::string log;
    test::Device device;
};

TEST_F(Saved, AnswersAreTheSameBitsWithoutBuilding) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const auto rays = test::unpleasant_rays(soup, 3, 1500);
        for (const uint32_t precision : {OVC_PRECISION_CERTIFIED, OVC_PRECISION_FAST}) {
            ovc_scene_config config = leaves_of(200);
            config.precision = precision;
            const auto built = committed(soup, {}, config);
            const test::ArchiveMemory memory = save(built);
            const auto restored = committed(soup, memory.bytes(), config);
            const ovc_statistics before = statistics(built), after = statistics(restored);
            EXPECT_EQ(before.from_saved, 0u);
            EXPECT_EQ(after.from_saved, 1u) << log;
            EXPECT_EQ(after.leaves, before.leaves);
            EXPECT_EQ(after.leaf_references, before.leaf_references);
            EXPECT_EQ(after.level2_bytes, before.level2_bytes);
            EXPECT_EQ(after.dropped_degenerate, before.dropped_degenerate);
            EXPECT_EQ(after.dropped_not_finite, before.dropped_not_finite);
            EXPECT_EQ(after.twins, before.twins);
            const auto expected = answers(built, rays), found = answers(restored, rays);
            EXPECT_EQ(std::memcmp(expected.data(), found.data(), rays.size() * sizeof(ovc_hit)), 0);
            const test::ArchiveMemory again = save(restored);
            ASSERT_EQ(again.size(), memory.size());
            EXPECT_EQ(std::memcmp(again.bytes().data(), memory.bytes().data(), memory.size()), 0);
        }
    }
}

TEST_F(Saved, OtherMeshesAndOtherOptionsAreBuiltAnew) {
    const Soup soup = test::random_soup(2, 3000, 0.05), other = test::random_soup(3, 3000, 0.05);
    const test::ArchiveMemory memory = save(committed(soup, {}));
    EXPECT_EQ(statistics(committed(other, memory.bytes())).from_saved, 0u);
    EXPECT_THAT(log, HasSubstr("building anew: what was saved is of other meshes"));
    EXPECT_EQ(statistics(committed(soup, memory.bytes(), leaves_of(100))).from_saved, 0u);
    EXPECT_THAT(log, HasSubstr("or other options"));
    ovc_scene_config smaller = leaves_of(200);
    smaller.gpu_memory_bytes = 512 << 10;
    EXPECT_EQ(statistics(committed(soup, memory.bytes(), smaller)).from_saved, 1u)
        << "here they fit as well, all at once: " << log;
    smaller.gpu_memory_bytes = 64 << 10;
    EXPECT_EQ(statistics(committed(soup, memory.bytes(), smaller)).from_saved, 0u)
        << "here pages might decide";
}

TEST_F(Saved, DamageIsSaidAndBuiltAnew) {
    const Soup soup = test::random_soup(2, 3000, 0.05);
    const auto rays = test::unpleasant_rays(soup, 3, 500);
    const auto whole = committed(soup, {});
    const auto expected = answers(whole, rays);
    test::ArchiveMemory memory = save(whole);
    memory.data()[memory.size() / 2] ^= std::byte(1);
    const auto damaged = committed(soup, memory.bytes());
    EXPECT_EQ(log, "building anew: what was saved is damaged: the checksum of its part 'texels' is "
                   "wrong\n");
    EXPECT_EQ(statistics(damaged).from_saved, 0u);
    const auto found = answers(damaged, rays);
    EXPECT_EQ(std::memcmp(expected.data(), found.data(), rays.size() * sizeof(ovc_hit)), 0);
    committed(soup, memory.bytes().first(1000));
    EXPECT_EQ(log, "building anew: what was saved is cut off\n");
}

TEST_F(Saved, MisuseIsRefused) {
    const Soup soup = test::random_soup(2, 30, 0.05);
    ovc_scene scene = nullptr;
    ovc_scene_config config = leaves_of(10);
    config.saved_bytes = 1;
    EXPECT_EQ(api().create_scene(device.get(), &config, &scene), OVC_ERROR_INVALID_ARGUMENT);
    const auto uncommitted = test::add_soup(device, soup, leaves_of(10));
    test::ArchiveMemory memory;
    EXPECT_EQ(api().save(uncommitted.get(), append, &memory), OVC_ERROR_INVALID_STATE);
    const auto fine = committed(soup, {});
    EXPECT_EQ(api().save(fine.get(), nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().save(nullptr, append, &memory), OVC_ERROR_INVALID_ARGUMENT);
    const auto full = [](void*, const void*, size_t) { return 1; };
    EXPECT_EQ(api().save(fine.get(), full, nullptr), OVC_ERROR_CANCELLED);
}

/// A soup of one mesh as a scene that streams, and what is saved of it.
struct StreamedSoup {
    const Soup& soup;
    ovc_streamed_mesh mesh{};
    test::ArchiveMemory scratch, saved;
    std::mutex mutex;
    bool scratch_fails = false;

    explicit StreamedSoup(const Soup& of) : soup(of) {
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] = of.chunks[0].origin()[axis];
        mesh.triangle_count = of.chunks[0].size();
    }

    ovc_streamed_scene scene(uint64_t host_memory_bytes) {
        auto scene = test::sized<ovc_streamed_scene>();
        scene.host_memory_bytes = host_memory_bytes;
        scene.meshes = &mesh;
        scene.mesh_count = 1;
        scene.user = this;
        scene.read_corners = [](void* user, uint32_t, uint64_t first, uint64_t count, void* to) {
            const StreamedSoup& self = *static_cast<StreamedSoup*>(user);
            std::memcpy(to, &self.soup.chunks[0].corners()[3 * first], 36 * count);
            return 0;
        };
        scene.write_scratch = [](void* user, uint64_t at, const void* bytes, size_t size) {
            StreamedSoup& self = *static_cast<StreamedSoup*>(user);
            const std::lock_guard lock(self.mutex);
            if (self.scratch.size() < at + size)
                self.scratch.resize(at + size);
            std::memcpy(self.scratch.data() + at, bytes, size);
            return 0;
        };
        scene.read_scratch = [](void* user, uint64_t at, void* bytes, size_t size) {
            StreamedSoup& self = *static_cast<StreamedSoup*>(user);
            const std::lock_guard lock(self.mutex);
            std::memcpy(bytes, self.scratch.data() + at, size);
            return self.scratch_fails ? 1 : 0;
        };
        scene.write = [](void* user, const void* bytes, size_t size) {
            static_cast<StreamedSoup*>(user)->saved.append(
                {static_cast<const std::byte*>(bytes), size});
            return 0;
        };
        return scene;
    }
};

constexpr uint64_t kSmallHost = 8 << 20; // too small to build 51,200 triangles in memory

TEST_F(Saved, AStreamedSceneAnswersWithTheSameBits) {
    const Soup soup = test::closed_grid(160);
    const auto rays = test::unpleasant_rays(soup, 5, 3000);
    const auto expected = answers(committed(soup, {}, test::sized<ovc_scene_config>()), rays);
    StreamedSoup streamed(soup);
    const ovc_streamed_scene scene = streamed.scene(kSmallHost);
    ASSERT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_OK)
        << api().last_error(device.get());
    EXPECT_GT(streamed.scratch.size(), 36u * soup.triangle_count());
    for (const uint64_t gpu_memory : {0u, 8u << 20, 1u << 20}) { // all of its pages fit, or some
        auto config = test::sized<ovc_scene_config>();
        config.gpu_memory_bytes = gpu_memory;
        const auto restored = committed(soup, streamed.saved.bytes(), config);
        EXPECT_EQ(statistics(restored).from_saved, 1u) << log;
        EXPECT_GT(statistics(restored).leaves, 5u);
        const auto found = answers(restored, rays);
        EXPECT_EQ(std::memcmp(expected.data(), found.data(), rays.size() * sizeof(ovc_hit)), 0);
        // They may be saved again, and remain what they are.
        const test::ArchiveMemory again = save(restored);
        ASSERT_EQ(again.size(), streamed.saved.size());
        EXPECT_EQ(std::memcmp(again.bytes().data(), streamed.saved.bytes().data(), again.size()),
                  0);
    }
    EXPECT_EQ(statistics(committed(soup, streamed.saved.bytes(), leaves_of(200))).from_saved, 0u)
        << "the host asks for leaves of its own";
}

TEST_F(Saved, AStreamedSceneThatFitsIsSavedAsIfItDidNotStream) {
    const Soup soup = test::closed_grid(40);
    StreamedSoup streamed(soup);
    const ovc_streamed_scene scene = streamed.scene(kSmallHost);
    ASSERT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_OK)
        << api().last_error(device.get());
    EXPECT_EQ(streamed.scratch.size(), 0u);
    const test::ArchiveMemory memory = save(committed(soup, {}, test::sized<ovc_scene_config>()));
    ASSERT_EQ(memory.size(), streamed.saved.size());
    EXPECT_EQ(std::memcmp(memory.bytes().data(), streamed.saved.bytes().data(), memory.size()), 0);
}

TEST_F(Saved, AStreamedSceneGoesOnWhereACallEnded) {
    const Soup soup = test::closed_grid(160);
    struct Kept : StreamedSoup {
        using StreamedSoup::StreamedSoup;
        std::vector<std::string> steps;
        size_t allowed = ~size_t(0);
        test::ArchiveMemory before; // what an earlier call wrote
    };
    const auto scene_of = [](Kept& of) {
        ovc_streamed_scene scene = of.scene(kSmallHost);
        scene.keep_step = [](void* user, const void* bytes, size_t size) {
            Kept& self = *static_cast<Kept*>(static_cast<StreamedSoup*>(user));
            if (self.steps.size() == self.allowed)
                return 1;
            self.steps.emplace_back(static_cast<const char*>(bytes), size);
            return 0;
        };
        scene.read_written = [](void* user, uint64_t at, void* bytes, size_t size) {
            const Kept& self = *static_cast<Kept*>(static_cast<StreamedSoup*>(user));
            std::memcpy(bytes, self.before.bytes().data() + at, size);
            return 0;
        };
        return scene;
    };
    Kept whole(soup);
    const ovc_streamed_scene scene = scene_of(whole);
    ASSERT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_OK);
    ASSERT_GT(whole.steps.size(), 5u);
    for (const size_t allowed : {size_t(0), size_t(2), whole.steps.size() - 2}) {
        Kept ended(soup);
        ended.allowed = allowed;
        const ovc_streamed_scene first = scene_of(ended);
        EXPECT_EQ(api().save_streamed(device.get(), nullptr, &first), OVC_ERROR_CANCELLED);
        ASSERT_EQ(ended.steps.size(), allowed);
        ended.before.append(ended.saved.bytes());
        ended.saved.resize(0);
        ended.allowed = ~size_t(0);
        ovc_streamed_scene again = scene_of(ended);
        std::vector<ovc_kept_step> kept;
        const std::vector<std::string> steps = ended.steps;
        for (const std::string& step : steps)
            kept.push_back({step.data(), step.size()});
        again.kept = kept.data();
        again.kept_count = kept.size();
        ASSERT_EQ(api().save_streamed(device.get(), nullptr, &again), OVC_OK)
            << api().last_error(device.get());
        EXPECT_EQ(ended.steps.size(), whole.steps.size());
        EXPECT_TRUE(std::ranges::equal(ended.saved.bytes(), whole.saved.bytes()));
        again.host_memory_bytes += 1;
        EXPECT_EQ(api().save_streamed(device.get(), nullptr, &again),
                  allowed ? OVC_ERROR_UNREADABLE : OVC_OK);
    }
}

TEST_F(Saved, AStreamedSceneIsPlanned) {
    std::vector<Soup> soups(1);
    const Soup half = test::random_soup(1, 30'000, 0.01);
    std::vector<vec3> corners; // every triangle has a duplicate
    for (int i = 0; i < 2; ++i)
        corners.insert(corners.end(), half.chunks[0].corners().begin(),
                       half.chunks[0].corners().end());
    soups[0].chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    soups.push_back(test::closed_grid(160));
    soups.push_back(test::random_soup(2, 40'000, 0.05));
    for (const Soup& soup : soups) {
        StreamedSoup streamed(soup);
        ovc_streamed_scene scene = streamed.scene(kSmallHost);
        ASSERT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_OK)
            << api().last_error(device.get());
        scene.write_scratch = nullptr;
        scene.read_scratch = nullptr;
        scene.write = nullptr;
        auto plan = test::sized<ovc_plan>();
        ASSERT_EQ(api().plan_streamed(device.get(), nullptr, &scene, &plan), OVC_OK)
            << api().last_error(device.get());
        EXPECT_EQ(plan.triangles, soup.triangle_count());
        EXPECT_EQ(plan.hittable, soup.triangle_count());
        EXPECT_TRUE(plan.fits);
        const double saved = double(streamed.saved.size());
        EXPECT_NEAR(double(plan.saved_bytes), saved, 0.1 * saved);
        const ovc_statistics made =
            statistics(committed(soup, streamed.saved.bytes(), test::sized<ovc_scene_config>()));
        EXPECT_EQ(made.from_saved, 1u) << log;
        EXPECT_NEAR(double(plan.level2_bytes), double(made.level2_bytes),
                    0.1 * double(made.level2_bytes));
        EXPECT_NEAR(double(plan.leaves), double(made.leaves), 0.1 * double(made.leaves) + 1);
        EXPECT_NEAR(double(plan.leaf_references), double(made.leaf_references),
                    0.1 * double(made.leaf_references));
        EXPECT_LE(plan.host_bytes, kSmallHost);
        scene.host_memory_bytes = plan.smallest_host_bytes;
        EXPECT_EQ(api().plan_streamed(device.get(), nullptr, &scene, &plan), OVC_OK);
        scene.host_memory_bytes -= 1;
        EXPECT_EQ(api().plan_streamed(device.get(), nullptr, &scene, &plan),
                  OVC_ERROR_OUT_OF_BUDGET);
    }
}

/// Whatever triangles lie where: what a call names, a plan says, and one byte less is refused.
TEST_F(Saved, TheSmallestHostMemoryWorksWithAnyStreamedScene) {
    const auto soup_of = [&](size_t kind) {
        const size_t count = kind == 0 ? 1'000 : 20'000; // a small one is built in memory
        const Soup few = test::random_soup(3, 7, 1.0);
        const auto copy = [&] {
            const auto corners = few.chunks[0].corners();
            return Chunk::owning(dvec3(0), {corners.begin(), corners.end()});
        };
        Soup soup = kind == 1 ? test::random_soup(4, count, 3.0) : test::closed_grid(12);
        for (size_t at = soup.triangle_count(); at < count && kind != 3; at = soup.triangle_count())
            soup.chunks.push_back(copy());
        for (int m = 0; m < 9'000 && kind == 3; ++m) // many meshes
            soup.chunks.push_back(copy());
        return soup;
    };
    for (size_t kind = 0; kind < 4; ++kind) {
        SCOPED_TRACE(kind);
        const Soup soup = soup_of(kind);
        const auto refused = [&](uint64_t host_bytes) {
            StreamedSoup streamed(soup);
            const ovc_streamed_scene scene = streamed.scene(host_bytes);
            EXPECT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_ERROR_OUT_OF_BUDGET);
            const std::string sentence = api().last_error(device.get());
            return std::stoull(sentence.substr(sentence.rfind(' ') + 1));
        };
        const uint64_t smallest = refused(1);
        EXPECT_EQ(refused(smallest - 1), smallest);
        StreamedSoup streamed(soup);
        ovc_streamed_scene scene = streamed.scene(smallest);
        ASSERT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_OK)
            << api().last_error(device.get());
        const auto rays = test::unpleasant_rays(soup, 5, 300);
        const auto expected = answers(committed(soup, {}, test::sized<ovc_scene_config>()), rays);
        const auto found =
            answers(committed(soup, streamed.saved.bytes(), test::sized<ovc_scene_config>()), rays);
        EXPECT_EQ(std::memcmp(expected.data(), found.data(), rays.size() * sizeof(ovc_hit)), 0);
        for (const uint64_t host_bytes : {smallest, 3 * smallest, uint64_t(0)}) {
            scene.host_memory_bytes = host_bytes;
            auto plan = test::sized<ovc_plan>();
            EXPECT_EQ(api().plan_streamed(device.get(), nullptr, &scene, &plan), OVC_OK);
            EXPECT_EQ(plan.smallest_host_bytes, smallest);
        }
    }
}

TEST_F(Saved, AStreamedSceneTellsWhyItCannotBeSaved) {
    const Soup soup = test::closed_grid(160);
    StreamedSoup streamed(soup);
    ovc_streamed_scene scene = streamed.scene(1 << 20);
    EXPECT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_ERROR_OUT_OF_BUDGET);
    EXPECT_THAT(api().last_error(device.get()),
                testing::MatchesRegex("1048576 bytes of host memory are too few for 51200 "
                                      "triangles on [0-9]+ threads: the smallest number that "
                                      "works is [0-9]+"));
    scene = streamed.scene(kSmallHost);
    streamed.scratch_fails = true;
    EXPECT_EQ(api().save_streamed(device.get(), nullptr, &scene), OVC_ERROR_CANCELLED);
    EXPECT_STREQ(api().last_error(device.get()),
                 "save_streamed: cancelled by a function of the host's");
}

} // namespace
} // namespace ovc
