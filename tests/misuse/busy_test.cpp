// SPDX-License-Identifier: Apache-2.0
// Tests many threads at once, and handles that are destroyed while others use them. Every call must
// end with the right answer or an error.
#include "tests/misuse/field.h"

#include <gmock/gmock.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace ovc {
namespace {

using test::api;
using test::sized;

/// Calls body(i) on so many threads at once.
void on_threads(int count, const std::function<void(int)>& body) {
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&body, i] { body(i); });
    for (std::thread& thread : threads)
        thread.join();
}

class Busy : public test::DeviceTest {};

TEST_F(Busy, SixtyFourThreadsOnTwoDevicesAndFourScenesGetTheirAnswers) {
    const test::Device other = test::open_device();
    ASSERT_TRUE(other);
    std::vector<test::AbiScene> scenes;
    for (ovc_device of : {device.get(), device.get(), other.get(), other.get()})
        scenes.emplace_back(test::make_field(of));
    std::atomic<int> wrong{0};
    on_threads(64, [&](int i) {
        for (int round = 0; round < 5; ++round)
            wrong += !test::field_answers(scenes[size_t(i + round) % 4].get());
    });
    EXPECT_EQ(wrong, 0);
}

TEST_F(Busy, ThreadsWithBatchesAreServedFirstComeFirstServed) {
    const test::AbiScene scene(test::make_field(device.get()));
    ASSERT_TRUE(scene);
    constexpr int kThreads = 8;
    std::array<std::atomic<int>, kThreads> calls{};
    std::atomic<bool> stop{false};
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i)
        threads.emplace_back([&, i] {
            while (!stop) {
                test::field_answers(scene.get());
                ++calls[size_t(i)];
            }
        });
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    const auto [least, most] = std::minmax_element(calls.begin(), calls.end());
    EXPECT_GE(*least, *most / 2 - 1) << "of " << *most << " calls of the busiest thread";
    EXPECT_GT(*least, 0);
}

/// overcast.h promises that so much stack is enough.
TEST_F(Busy, AThreadOf256KibOfStackMayCall) {
    struct Call {
        ovc_device device;
        bool right = false;
    } call{device.get()};
    const auto body = [](void* given) -> void* {
        auto& asked = *static_cast<Call*>(given);
        const test::AbiScene scene(test::make_field(asked.device));
        ovc_ray far = test::into_cell(5, 3); // Only integers can decide this ray.
        far.org[2] = 1e200;
        ovc_hit hits[2]{};
        const bool traced = scene && test::field_answers(scene.get()) &&
                            api().intersect(scene.get(), &far, 1, &hits[0], nullptr) == OVC_OK &&
                            api().intersect1(scene.get(), &far, &hits[1], nullptr) == OVC_OK;
        asked.right =
            traced && test::is_in_cell(hits[0], 5, 1e200) && test::is_in_cell(hits[1], 5, 1e200);
        return nullptr;
    };
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, 256 << 10), 0);
    pthread_t thread;
    ASSERT_EQ(pthread_create(&thread, &attributes, body, &call), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    EXPECT_TRUE(call.right);
}

TEST_F(Busy, SixtyFourThreadsMakeAndDestroyScenesOfOneDevice) {
    std::atomic<int> wrong{0};
    on_threads(64, [&](int) {
        const test::AbiScene scene(test::make_field(device.get()));
        wrong += !scene || !test::field_answers(scene.get());
    });
    EXPECT_EQ(wrong, 0);
}

TEST_F(Busy, ASceneDestroyedWhileThreadsUseItAnswersThemOrSaysSo) {
    for (int round = 0; round < 20; ++round) {
        ovc_scene scene = test::make_field(device.get());
        ASSERT_TRUE(scene);
        std::atomic<int> started{0}, wrong{0};
        on_threads(17, [&](int i) {
            if (i == 16) {
                while (started < 16)
                    std::this_thread::yield();
                api().destroy_scene(scene);
                return;
            }
            ++started;
            ovc_result result = OVC_OK;
            while (result == OVC_OK) {
                const ovc_ray ray = test::into_cell(uint32_t(i), 3);
                ovc_hit hit{};
                result = api().intersect(scene, &ray, 1, &hit, nullptr);
                wrong += result == OVC_OK && !test::is_in_cell(hit, uint32_t(i), 3);
            }
            wrong += result != OVC_ERROR_INVALID_STATE && result != OVC_ERROR_INVALID_ARGUMENT;
        });
        EXPECT_EQ(wrong, 0);
    }
}

TEST_F(Busy, ThreadsThatAllDestroyOneSceneDestroyItOnce) {
    const test::AbiScene stays(test::make_field(device.get()));
    for (int round = 0; round < 50; ++round) {
        ovc_scene scene = test::make_field(device.get());
        on_threads(8, [&](int) { api().destroy_scene(scene); });
    }
    EXPECT_TRUE(test::field_answers(stays.get()));
}

TEST_F(Busy, ADestroyedSceneIsAnErrorAsLongAsItsDeviceLives) {
    ovc_scene scene = test::make_field(device.get());
    api().destroy_scene(scene);
    EXPECT_EQ(api().commit(scene), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(api().last_error(device.get()), "commit: the scene is destroyed");
    EXPECT_STREQ(api().last_error(nullptr), "commit: the scene is destroyed");
    api().destroy_scene(scene);
    // More scenes are destroyed than the library remembers.
    for (int later = 0; later < 2000; ++later) {
        ovc_scene other = nullptr;
        ASSERT_EQ(api().create_scene(device.get(), nullptr, &other), OVC_OK);
        api().destroy_scene(other);
    }
}

TEST_F(Busy, ADeviceDestroyedWhileScenesAreMadeStaysOrGoesWhole) {
    for (int round = 0; round < 20; ++round) {
        ovc_device other = nullptr;
        ASSERT_EQ(api().create_device(nullptr, &other), OVC_OK);
        // One scene is alive throughout, so that the device must stay.
        ovc_scene alive = nullptr;
        ASSERT_EQ(api().create_scene(other, nullptr, &alive), OVC_OK);
        on_threads(8, [&](int i) {
            if (i == 0)
                return api().destroy_device(other);
            ovc_scene scene = nullptr;
            if (api().create_scene(other, nullptr, &scene) == OVC_OK)
                api().destroy_scene(scene);
        });
        auto info = sized<ovc_device_info>();
        EXPECT_EQ(api().describe_device(other, &info), OVC_OK);
        api().destroy_scene(alive);
        api().destroy_device(other);
    }
}

/// Scenes of which the device has room for one at a time, and what is asked from within a stream of
/// the first while another thread asks the second.
struct Nested {
    ovc_device device = nullptr;
    ovc_scene scenes[2]{};
    std::function<ovc_result(ovc_scene)> ask;
    bool has_pushed = false;
    std::vector<ovc_result> results;

    static int more(void* self, ovc_stream stream, size_t) {
        auto& nested = *static_cast<Nested*>(self);
        const ovc_ray ray = test::into_cell(1, 1);
        const uint64_t token = 0;
        const bool pushes = !std::exchange(nested.has_pushed, true);
        return pushes ? api().push(stream, &ray, &token, 1, 0, nullptr) : 0;
    }
    static int answered(void* self, ovc_stream, const ovc_stream_answers*) {
        auto& nested = *static_cast<Nested*>(self);
        // By now the other thread has the second scene's turn, and waits for room.
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        nested.results.push_back(nested.ask(nested.scenes[1]));
        return 0;
    }
};

TEST_F(Busy, AStreamsCallOnASceneThatWaitsForItsRoomIsRefused) {
    auto config = sized<ovc_device_config>();
    config.gpu_memory_bytes = 60000;
    Nested nested;
    ASSERT_EQ(api().create_device(&config, &nested.device), OVC_OK);
    for (ovc_scene& scene : nested.scenes)
        ASSERT_TRUE(scene = test::make_field(nested.device));
    std::vector<ovc_ray> rays(5000, test::into_cell(2, 1));
    std::vector<ovc_hit> hits(rays.size());
    const auto intersect = [&](ovc_scene scene, size_t count) {
        return api().intersect(scene, rays.data(), count, hits.data(), nullptr);
    };
    const std::function<ovc_result(ovc_scene)> asks[]{
        [&](ovc_scene scene) { return intersect(scene, 100); }, // may share a pass
        [&](ovc_scene scene) { return intersect(scene, 5000); },
        [&](ovc_scene scene) {
            ovc_ticket ticket = nullptr;
            EXPECT_EQ(api().submit_intersect(scene, rays.data(), 10, hits.data(), nullptr, &ticket),
                      OVC_OK);
            const ovc_result result = api().wait(ticket);
            api().release(ticket);
            return result;
        },
        [&](ovc_scene scene) {
            api().destroy_scene(scene); // which would wait for the other thread
            return intersect(scene, 100);
        },
    };
    for (const auto& ask : asks) {
        nested.ask = ask;
        nested.has_pushed = false;
        nested.results.clear();
        std::thread other([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            EXPECT_TRUE(test::field_answers(nested.scenes[1]));
        });
        auto host = sized<ovc_stream_host>();
        host.user = &nested;
        host.more = Nested::more;
        host.answered = Nested::answered;
        EXPECT_EQ(api().stream(nested.scenes[0], &host), OVC_OK);
        other.join();
        EXPECT_THAT(nested.results, testing::ElementsAre(OVC_ERROR_OUT_OF_BUDGET));
    }
    for (ovc_scene scene : nested.scenes)
        api().destroy_scene(scene);
    api().destroy_device(nested.device);
}

} // namespace
} // namespace ovc
