// SPDX-License-Identifier: Apache-2.0
// Tests that purge gives GPU memory back and that answers have the same bits afterwards. Also tests
// that the error callback gets the text of last_error at the same time.
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <thread>
#include <utility>

namespace ovc {
namespace {

using test::api;
using test::sized;
using testing::HasSubstr;

class Purge : public test::DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped())
            return;
        test::Random random(1);
        for (int i = 0; i < 5000; ++i)
            rays.push_back({random.point(-2, 2), 0, random.point(-1, 1)});
    }

    Soup soup = test::closed_grid(40);
    std::vector<Ray> rays;
};

TEST_F(Purge, GivesBackAllGpuMemoryAndAnswersStayTheSame) {
    // All pages are resident at once, or are moved in as they are needed.
    for (const uint64_t budget : {0, 120'000}) {
        SCOPED_TRACE(budget);
        auto config = sized<ovc_scene_config>();
        config.gpu_memory_bytes = budget;
        config.leaf_triangles = 200;
        const test::AbiScene scene = test::add_soup(device, soup, config);
        ASSERT_TRUE(scene) << api().last_error(device.get());
        EXPECT_EQ(api().purge(scene.get()), OVC_OK) << "nothing to give back yet";
        ASSERT_EQ(api().commit(scene.get()), OVC_OK) << api().last_error(device.get());
        const std::vector<ovc_hit> before = answers(scene, rays);
        const ovc_statistics used = statistics(scene);
        EXPECT_GT(used.gpu_bytes, 50'000u);
        EXPECT_EQ(used.level2_bytes > used.gpu_budget_bytes, budget != 0);
        EXPECT_LE(used.gpu_bytes, used.gpu_peak_bytes);
        for (int times = 0; times < 3; ++times) {
            ASSERT_EQ(api().purge(scene.get()), OVC_OK) << api().last_error(device.get());
            ASSERT_EQ(api().purge(scene.get()), OVC_OK) << "a second time is nothing to do";
            EXPECT_EQ(statistics(scene).gpu_bytes, 0u);
            const std::vector<ovc_hit> after = answers(scene, rays);
            EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size() * sizeof(ovc_hit)), 0);
            EXPECT_EQ(statistics(scene).gpu_bytes, used.gpu_bytes);
        }
        EXPECT_GT(statistics(scene).bytes_in, used.bytes_in) << "pages came in again";
        EXPECT_LE(statistics(scene).gpu_peak_bytes, statistics(scene).gpu_budget_bytes);
    }
}

TEST_F(Purge, EveryKindOfCallBringsItInAgain) {
    auto config = sized<ovc_scene_config>();
    config.tell_active = 1;
    const test::AbiScene scene = test::add_soup(device, soup, config);
    ASSERT_EQ(api().commit(scene.get()), OVC_OK);
    const std::vector<ovc_hit> hits = answers(scene, rays);
    const auto* abi_rays = reinterpret_cast<const ovc_ray*>(rays.data());

    ASSERT_EQ(api().purge(scene.get()), OVC_OK);
    std::vector<uint8_t> shadows(rays.size());
    ASSERT_EQ(api().occluded(scene.get(), abi_rays, rays.size(), shadows.data(), nullptr), OVC_OK);
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(shadows[i], hits[i].mesh != OVC_NONE);

    ASSERT_EQ(api().purge(scene.get()), OVC_OK);
    auto active = sized<ovc_active>();
    EXPECT_EQ(api().active(scene.get(), &active), OVC_OK) << api().last_error(device.get());

    ASSERT_EQ(api().purge(scene.get()), OVC_OK);
    struct Streamed {
        const std::vector<Ray>& rays;
        size_t answered = 0, hits = 0;
        bool pushed = false;
        ovc_scene scene;
    } streamed{rays, 0, 0, false, scene.get()};
    auto host = sized<ovc_stream_host>();
    host.user = &streamed;
    host.more = [](void* user, ovc_stream stream, size_t) {
        auto& s = *static_cast<Streamed*>(user);
        if (std::exchange(s.pushed, true))
            return 0;
        EXPECT_EQ(api().purge(s.scene), OVC_ERROR_INVALID_STATE) << "within its own stream";
        const std::vector<uint64_t> tokens(s.rays.size());
        return int(api().push(stream, reinterpret_cast<const ovc_ray*>(s.rays.data()),
                              tokens.data(), s.rays.size(), 0, nullptr));
    };
    host.answered = [](void* user, ovc_stream, const ovc_stream_answers* answers) {
        auto& s = *static_cast<Streamed*>(user);
        s.answered += answers->count;
        for (size_t i = 0; i < answers->count; ++i)
            s.hits += answers->hits[i].mesh != OVC_NONE;
        return 0;
    };
    ASSERT_EQ(api().stream(scene.get(), &host), OVC_OK) << api().last_error(device.get());
    EXPECT_EQ(streamed.answered, rays.size());
    EXPECT_EQ(streamed.hits, size_t(std::count(shadows.begin(), shadows.end(), 1)));
}

struct Told {
    ovc_result result = OVC_OK;
    std::string message;
    std::string last_error;
    std::thread::id thread;
    int times = 0;
    ovc_device device = nullptr;
};

void tell(void* user, ovc_result result, const char* message) {
    auto& told = *static_cast<Told*>(user);
    told = {result,         message,    api().last_error(told.device), std::this_thread::get_id(),
            told.times + 1, told.device};
}

TEST(ErrorCallback, SaysWhatLastErrorSaysWithItsCode) {
    Told told;
    auto config = sized<ovc_device_config>();
    config.error = tell;
    config.error_user = &told;
    ovc_device opened = nullptr;
    if (api().create_device(&config, &opened) == OVC_ERROR_NO_DEVICE)
        GTEST_SKIP() << api().last_error(nullptr);
    const test::Device device(opened);
    EXPECT_EQ(told.times, 0);
    told.device = opened;

    const Soup soup = test::closed_grid(4);
    const test::AbiScene scene = test::add_soup(device, soup, sized<ovc_scene_config>());
    EXPECT_EQ(told.times, 0) << "nothing has failed";
    std::thread([&] {
        ovc_hit hit;
        const ovc_ray ray{};
        EXPECT_EQ(api().intersect(scene.get(), &ray, 1, &hit, nullptr), OVC_ERROR_INVALID_STATE);
        EXPECT_EQ(told.thread, std::this_thread::get_id());
    }).join();
    EXPECT_EQ(told.times, 1);
    EXPECT_EQ(told.result, OVC_ERROR_INVALID_STATE);
    EXPECT_EQ(told.message,
              "intersect: the scene is not committed yet, or has changed since it was");
    EXPECT_EQ(told.last_error, told.message);

    ovc_device_info info{};
    EXPECT_EQ(api().describe_device(device.get(), &info), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(told.times, 2);
    EXPECT_THAT(told.message, HasSubstr("ovc_device_info.struct_size is 0"));
    EXPECT_EQ(told.last_error, told.message);

    // The callback also hears of a create_device that fails.
    told.device = nullptr;
    config.name = "no such card";
    EXPECT_EQ(api().create_device(&config, &opened), OVC_ERROR_NO_DEVICE);
    EXPECT_EQ(told.times, 3);
    EXPECT_EQ(told.result, OVC_ERROR_NO_DEVICE);
    EXPECT_THAT(told.message, HasSubstr("no device is called 'no such card'"));
    EXPECT_EQ(told.last_error, told.message);
}

TEST(ErrorCallback, TheConfigOfAnEarlierHeaderHasNone) {
    ovc_device_config config;
    // Bytes behind the earlier struct must not be read.
    std::memset(&config, 0xff, sizeof(config));
    std::memset(&config, 0, offsetof(ovc_device_config, error));
    config.struct_size = offsetof(ovc_device_config, error);
    config.name = "no such card";
    ovc_device device;
    EXPECT_EQ(api().create_device(&config, &device), OVC_ERROR_NO_DEVICE);
}

} // namespace
} // namespace ovc
