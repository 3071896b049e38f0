// SPDX-License-Identifier: Apache-2.0
#include "host/backend/device_opening.h"

#include <gmock/gmock.h>

#include <cstdlib>

namespace ovc {

struct Said {
    std::vector<std::string> messages;
    LogSink sink() {
        return [this](LogLevel, const std::string& message) { messages.push_back(message); };
    }
};

TEST(DeviceOpening, HoldsWhatIsSaidUntilTheDeviceIsWanted) {
    Said told;
    {
        ovc_result code = OVC_OK;
        DeviceOpening opening(BackendOptions{});
        const Result<PluginDevice> device = opening.finish(told.sink(), code);
        if (!device)
            GTEST_SKIP() << device.error().message;
        EXPECT_EQ(code, OVC_OK);
        const Result<ovc_device_info> info = device->describe();
        ASSERT_TRUE(info);
        if (info->is_software) {
            ASSERT_FALSE(told.messages.empty());
            EXPECT_THAT(told.messages[0], testing::HasSubstr("no GPU found"));
        }
    }
    const size_t before = told.messages.size();
    DeviceOpening{BackendOptions{}}; // opens, closes, and says nothing
    EXPECT_EQ(told.messages.size(), before);
}

TEST(DeviceOpening, TellsAMissingPluginFromAMissingDevice) {
    BackendOptions options;
    options.device = "no such device";
    ovc_result code = OVC_OK;
    Said told;
    const Result<PluginDevice> none = DeviceOpening(options).finish(told.sink(), code);
    ASSERT_FALSE(none);
    EXPECT_EQ(code, OVC_ERROR_NO_DEVICE);

    setenv("OVC_PLUGIN", "/no/such/plugin.so", 1);
    const Result<PluginDevice> unloaded = DeviceOpening(options).finish(told.sink(), code);
    unsetenv("OVC_PLUGIN");
    ASSERT_FALSE(unloaded);
    EXPECT_EQ(code, OVC_OK);
    EXPECT_THAT(unloaded.error().message, testing::HasSubstr("/no/such/plugin.so"));
}

TEST(DeviceOpening, IsWhatABackendIsMadeOf) {
    const Soup empty;
    for (const BackendKind kind : {BackendKind::Auto, BackendKind::CpuKdTree}) {
        BackendOptions options;
        options.kind = kind;
        DeviceOpening opening(options);
        const Result<std::unique_ptr<Backend>> backend = make_backend(empty, options, {}, opening);
        ASSERT_TRUE(backend) << backend.error().message;
        Hit hit;
        const Ray ray;
        ASSERT_TRUE((*backend)->intersect({&ray, 1}, {}, {&hit, 1}));
        EXPECT_FALSE(hit.is_hit());
    }
}

} // namespace ovc
