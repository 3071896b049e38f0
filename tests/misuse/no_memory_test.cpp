// SPDX-License-Identifier: Apache-2.0
// Calls without memory return a code, throw nothing through the C ABI, and leave every handle
// either whole or gone.
#include "tests/misuse/field.h"
#include "tests/misuse/no_memory.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace ovc {
namespace {

using test::api;
using test::NoMemory;
using test::sized;
using testing::AnyOf;

/// Calls misses(allocations) with memory for no allocation, for one, and so on, until it returns
/// false. Returns how many allocations it takes.
int with_ever_more_memory(const std::function<bool(int)>& misses) {
    int allocations = 0;
    while (misses(allocations))
        ++allocations;
    return allocations;
}

/// Returns whether the call asked for more memory than for so many allocations.
template <class Call>
bool misses(int allocations, Call&& call) {
    const NoMemory none(allocations);
    call();
    return none.was_missed();
}

class WithoutMemory : public test::DeviceTest {};

TEST_F(WithoutMemory, CallsOnHandlesThatAreNoneReturnACode) {
    ovc_scene destroyed = test::make_field(device.get());
    api().destroy_scene(destroyed);
    auto info = sized<ovc_device_info>();
    auto statistics = sized<ovc_statistics>();
    const std::vector<std::function<ovc_result()>> calls{
        [&] { return api().describe_device(nullptr, &info); },
        [&] { return api().commit(nullptr); },
        [&] { return api().statistics(destroyed, &statistics); },
        [&] { return api().push(nullptr, nullptr, nullptr, 0, 0, nullptr); },
        [&] { return api().wait(nullptr); },
        [&] { return api().list_devices(nullptr, 1, nullptr); },
    };
    for (size_t i = 0; i < calls.size(); ++i) {
        const int needed = with_ever_more_memory([&](int allocations) {
            ovc_result result = OVC_OK;
            const bool missed = misses(allocations, [&] { result = calls[i](); });
            EXPECT_EQ(result, missed ? OVC_ERROR_OUT_OF_MEMORY : OVC_ERROR_INVALID_ARGUMENT);
            return missed;
        });
        EXPECT_GT(needed, 0) << "call " << i << " makes a sentence";
    }
    with_ever_more_memory([&](int allocations) {
        return misses(allocations, [&] {
            api().destroy_device(nullptr);
            api().destroy_scene(nullptr);
            api().destroy_scene(destroyed);
            api().release(nullptr);
        });
    });
}

TEST_F(WithoutMemory, AThreadWithoutErrorsHasAnEmptyMessage) {
    std::string said = "nothing";
    std::thread([&] {
        const NoMemory none(0);
        said.assign(api().last_error(device.get()));
    }).join();
    EXPECT_EQ(said, "");
}

/// Collects what a device says.
struct Said {
    std::vector<std::string> errors;

    static void hear(void* self, ovc_log_level level, const char* text) {
        if (level == OVC_LOG_ERROR)
            static_cast<Said*>(self)->errors.emplace_back(text);
    }
};

TEST_F(WithoutMemory, ScenesAndTicketsAreGoneOnceTheyAreDestroyed) {
    Said said;
    auto config = sized<ovc_device_config>();
    config.log = Said::hear;
    config.log_user = &said;
    ovc_device other = nullptr;
    ASSERT_EQ(api().create_device(&config, &other), OVC_OK);
    const ovc_ray ray = test::into_cell(3, 1);
    with_ever_more_memory([&](int allocations) {
        ovc_scene scene = test::make_field(other);
        ovc_hit hits[8]{};
        ovc_ticket tickets[8]{};
        for (int i = 0; i < 8; ++i)
            EXPECT_EQ(api().submit_intersect(scene, &ray, 1, &hits[i], nullptr, &tickets[i]),
                      OVC_OK);
        api().wait(tickets[0]);
        const bool missed = misses(allocations, [&] {
            api().release(tickets[0]);
            api().destroy_scene(scene); // which cancels the calls that wait
        });
        for (int i = 1; i < 8; ++i)
            api().release(tickets[i]);
        EXPECT_EQ(api().commit(scene), OVC_ERROR_INVALID_ARGUMENT) << "it is destroyed";
        return missed;
    });
    api().destroy_device(other);
    EXPECT_THAT(said.errors, testing::IsEmpty()) << "the device has gone";
}

TEST_F(WithoutMemory, ADeviceThatIsUsedStays) {
    ovc_scene scene = test::make_field(device.get());
    with_ever_more_memory([&](int allocations) {
        return misses(allocations, [&] { api().destroy_device(device.get()); });
    });
    EXPECT_TRUE(test::field_answers(scene));
    api().destroy_scene(scene);
}

/// Each call of a scene's life, one of them without memory.
TEST_F(WithoutMemory, ASceneAnswersAsSoonAsThereIsMemoryAgain) {
    const ovc_mesh mesh = test::field_mesh();
    const ovc_ray ray = test::into_cell(7, 2);
    ovc_hit hit{};
    const std::vector<std::function<ovc_result(ovc_scene)>> calls{
        [&](ovc_scene scene) { return api().add_mesh(scene, &mesh, nullptr); },
        [](ovc_scene scene) { return api().commit(scene); },
        [&](ovc_scene scene) { return api().intersect(scene, &ray, 1, &hit, nullptr); },
        [&](ovc_scene scene) { return api().intersect1(scene, &ray, &hit, nullptr); },
    };
    for (size_t hungry = 0; hungry < calls.size(); ++hungry)
        with_ever_more_memory([&](int allocations) {
            ovc_scene scene = nullptr;
            EXPECT_EQ(api().create_scene(device.get(), nullptr, &scene), OVC_OK);
            bool missed = false;
            for (size_t i = 0; i < calls.size(); ++i) {
                ovc_result result = OVC_ERROR_OUT_OF_MEMORY;
                if (i == hungry) {
                    missed = misses(allocations, [&] { result = calls[i](scene); });
                    EXPECT_THAT(result, AnyOf(OVC_OK, OVC_ERROR_OUT_OF_MEMORY)) << "call " << i;
                }
                if (result != OVC_OK) {
                    EXPECT_EQ(calls[i](scene), OVC_OK) << "call " << i;
                }
            }
            EXPECT_TRUE(test::is_in_cell(hit, 7, 2));
            api().destroy_scene(scene);
            return missed;
        });
}

} // namespace
} // namespace ovc
