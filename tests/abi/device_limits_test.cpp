// SPDX-License-Identifier: Apache-2.0
// Tests the limits of a device's config: the GPU memory of all its scenes together, and threads.
// Also tests turns: no caller waits much longer than the others.
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numeric>
#include <thread>

namespace ovc {
namespace {

using test::AbiScene;
using test::api;
using test::as_abi;
using test::sized;
using testing::HasSubstr;

test::Device device_of(const ovc_device_config& config) {
    ovc_device device = nullptr;
    EXPECT_EQ(api().create_device(&config, &device), OVC_OK) << api().last_error(nullptr);
    return test::Device(device);
}

bool same(const std::vector<ovc_hit>& a, const std::vector<ovc_hit>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(ovc_hit)) == 0;
}

class DeviceLimits : public test::DeviceTest {
protected:
    struct Scene {
        Soup soup;
        std::vector<Ray> rays;
        std::vector<ovc_hit> expected; // the answers of a scene with a budget of its own
        AbiScene scene;                // a scene of the limited device
    };

    static AbiScene committed(const test::Device& on, const Soup& soup, uint64_t leaf_triangles) {
        auto config = sized<ovc_scene_config>();
        config.leaf_triangles = leaf_triangles;
        AbiScene scene = test::add_soup(on, soup, config);
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << api().last_error(on.get());
        return scene;
    }

    /// Returns scenes of at least 2,000 triangles, which take at least some 100 KiB.
    std::vector<Scene> scenes_of(size_t count) {
        std::vector<Scene> scenes(count);
        for (size_t i = 0; i < count; ++i) {
            scenes[i].soup = test::random_soup(i, 2000 + 1500 * i, 0.05);
            scenes[i].rays = test::unpleasant_rays(scenes[i].soup, i, 1500);
            scenes[i].expected =
                test::answers(committed(device, scenes[i].soup, 300), scenes[i].rays);
        }
        return scenes;
    }
};

TEST_F(DeviceLimits, ScenesShareABudgetAndAnswerAsWithOneOfTheirOwn) {
    std::vector<Scene> scenes = scenes_of(4);
    for (const uint64_t budget : {uint64_t(64) << 20, uint64_t(1) << 20, uint64_t(400) << 10}) {
        SCOPED_TRACE(budget);
        auto config = sized<ovc_device_config>();
        config.gpu_memory_bytes = budget;
        const test::Device limited = device_of(config);
        auto info = sized<ovc_device_info>();
        ASSERT_EQ(api().describe_device(limited.get(), &info), OVC_OK);
        EXPECT_EQ(info.default_budget_bytes, budget);
        const auto bytes_of_all = [&] {
            return std::accumulate(
                scenes.begin(), scenes.end(), uint64_t(0), [](uint64_t sum, const Scene& s) {
                    return s.scene ? sum + test::statistics(s.scene).gpu_bytes : sum;
                });
        };
        for (Scene& s : scenes) {
            s.scene = committed(limited, s.soup, 300);
            EXPECT_LE(bytes_of_all(), budget);
        }
        test::Random random(7);
        for (int call = 0; call < 24; ++call) {
            const Scene& s = scenes[random.below(uint32_t(scenes.size()))];
            EXPECT_TRUE(same(test::answers(s.scene, s.rays), s.expected));
            EXPECT_LE(bytes_of_all(), budget);
        }
        std::vector<std::thread> threads;
        for (const Scene& s : scenes)
            threads.emplace_back([&s] {
                for (int call = 0; call < 6; ++call)
                    EXPECT_TRUE(same(test::answers(s.scene, s.rays), s.expected));
            });
        for (std::thread& thread : threads)
            thread.join();
        EXPECT_LE(bytes_of_all(), budget);
        for (Scene& s : scenes) {
            EXPECT_EQ(api().purge(s.scene.get()), OVC_OK);
            EXPECT_EQ(test::statistics(s.scene).gpu_bytes, 0u);
            s.scene.reset();
        }
    }
}

TEST_F(DeviceLimits, ScenesThatFitBesideEachOtherStay) {
    std::vector<Scene> scenes = scenes_of(3);
    auto config = sized<ovc_device_config>();
    config.gpu_memory_bytes = 256 << 20;
    const test::Device limited = device_of(config);
    for (Scene& s : scenes)
        s.scene = committed(limited, s.soup, 300);
    for (int round = 0; round < 3; ++round)
        for (const Scene& s : scenes) {
            const uint64_t before = test::statistics(s.scene).pages_in;
            EXPECT_TRUE(same(test::answers(s.scene, s.rays), s.expected));
            EXPECT_EQ(test::statistics(s.scene).pages_in, before);
        }
    scenes.clear();
}

TEST_F(DeviceLimits, ABudgetThatIsTooSmallIsRefused) {
    auto config = sized<ovc_device_config>();
    config.gpu_memory_bytes = 1000;
    ovc_device none = nullptr;
    EXPECT_EQ(api().create_device(&config, &none), OVC_ERROR_OUT_OF_BUDGET);
    EXPECT_THAT(api().last_error(nullptr), HasSubstr("the smallest that works"));
    config.gpu_memory_bytes = 1 << 20;
    const test::Device limited = device_of(config);
    auto scene_config = sized<ovc_scene_config>();
    scene_config.gpu_memory_bytes = (1 << 20) + 1;
    ovc_scene scene = nullptr;
    EXPECT_EQ(api().create_scene(limited.get(), &scene_config, &scene), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(api().last_error(limited.get()), HasSubstr("share 1048576"));
}

/// The functions of a stream's host may ask another scene, which must fit beside the stream's.
TEST_F(DeviceLimits, AScenesStreamMayAskAnother) {
    std::vector<Scene> scenes = scenes_of(2);
    auto config = sized<ovc_device_config>();
    config.gpu_memory_bytes = 1 << 20;
    const test::Device limited = device_of(config);
    for (Scene& s : scenes)
        s.scene = committed(limited, s.soup, 300);
    struct Asking {
        Scene& streamed;
        Scene& other;
        bool pushed = false;
        size_t answered = 0;
        static int fill(void* user, ovc_stream stream, size_t) {
            auto& self = *static_cast<Asking*>(user);
            if (std::exchange(self.pushed, true))
                return 0;
            const std::vector<uint64_t> tokens(self.streamed.rays.size(), 0);
            EXPECT_EQ(api().push(stream, as_abi(self.streamed.rays), tokens.data(), tokens.size(),
                                 0, nullptr),
                      OVC_OK);
            return 0;
        }
        static int take(void* user, ovc_stream, const ovc_stream_answers* answers) {
            auto& self = *static_cast<Asking*>(user);
            self.answered += answers->count;
            EXPECT_TRUE(
                same(test::answers(self.other.scene, self.other.rays), self.other.expected));
            return 0;
        }
    } asking{scenes[0], scenes[1]};
    auto host = sized<ovc_stream_host>();
    host.user = &asking;
    host.more = Asking::fill;
    host.answered = Asking::take;
    EXPECT_EQ(api().stream(scenes[0].scene.get(), &host), OVC_OK)
        << api().last_error(limited.get());
    EXPECT_EQ(asking.answered, scenes[0].rays.size());
    scenes.clear();
}

TEST_F(DeviceLimits, AnyNumberOfThreadsAnswersAlike) {
    const Soup soup = test::random_soup(3, 20000, 0.05);
    const std::vector<Ray> rays = test::unpleasant_rays(soup, 3, 3000);
    const auto expected = test::answers(committed(device, soup, 2000), rays);
    for (const uint32_t threads : {1u, 2u, 3u, 4'000'000'000u}) {
        SCOPED_TRACE(threads);
        auto config = sized<ovc_device_config>();
        config.threads = threads;
        const test::Device limited = device_of(config);
        const AbiScene scene = committed(limited, soup, 2000);
        std::vector<std::thread> callers;
        for (int caller = 0; caller < 3; ++caller)
            callers.emplace_back([&] { EXPECT_TRUE(same(test::answers(scene, rays), expected)); });
        for (std::thread& caller : callers)
            caller.join();
    }
}

/// Lets callers call as often as they can, for OVC_FAIRNESS_SECONDS or until they have called 400
/// times together, and returns how often each one was served.
std::vector<size_t> calls_of(size_t callers, const std::function<void(size_t)>& call) {
    const char* const seconds = std::getenv("OVC_FAIRNESS_SECONDS");
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::duration<double>(seconds ? std::atof(seconds) : 0);
    std::vector<size_t> served(callers);
    std::atomic<size_t> all{0}, ready{0};
    const auto goes_on = [&] {
        return seconds ? std::chrono::steady_clock::now() < end : all < 50 * callers;
    };
    std::vector<std::thread> threads;
    for (size_t i = 0; i < callers; ++i)
        threads.emplace_back([&, i] {
            for (++ready; ready < callers;)
                std::this_thread::yield();
            for (; goes_on(); ++served[i], ++all)
                call(i);
        });
    for (std::thread& thread : threads)
        thread.join();
    return served;
}

void expect_fair(const std::vector<size_t>& served) {
    const auto [least, most] = std::ranges::minmax(served);
    EXPECT_GE(2 * least, most) << testing::PrintToString(served);
    testing::Test::RecordProperty("served", testing::PrintToString(served));
    if (std::getenv("OVC_FAIRNESS_SECONDS"))
        std::printf("calls of each thread: %s\n", testing::PrintToString(served).c_str());
}

TEST_F(DeviceLimits, TurnsOnASceneAreFair) {
    const Soup soup = test::random_soup(5, 20000, 0.05);
    const std::vector<Ray> rays = test::unpleasant_rays(soup, 5, 1024);
    const AbiScene scene = committed(device, soup, 2000);
    expect_fair(calls_of(8, [&](size_t) { test::answers(scene, rays); }));
}

TEST_F(DeviceLimits, TurnsOfScenesOnADeviceAreFair) {
    const Soup soup = test::random_soup(6, 20000, 0.05);
    const std::vector<Ray> rays = test::unpleasant_rays(soup, 6, 1024);
    std::vector<AbiScene> scenes;
    for (size_t i = 0; i < 8; ++i)
        scenes.push_back(committed(device, soup, 2000));
    expect_fair(calls_of(8, [&](size_t i) { test::answers(scenes[i], rays); }));
}

TEST_F(DeviceLimits, TurnsOfScenesThatShareABudgetAreFair) {
    const Soup soup = test::random_soup(7, 5000, 0.05);
    const std::vector<Ray> rays = test::unpleasant_rays(soup, 7, 1024);
    auto config = sized<ovc_device_config>();
    // Two scenes fit at a time.
    config.gpu_memory_bytes = 1 << 20;
    const test::Device limited = device_of(config);
    std::vector<AbiScene> scenes;
    for (size_t i = 0; i < 8; ++i)
        scenes.push_back(committed(limited, soup, 1 << 20));
    expect_fair(calls_of(8, [&](size_t i) { test::answers(scenes[i], rays); }));
    scenes.clear();
}

} // namespace
} // namespace ovc
