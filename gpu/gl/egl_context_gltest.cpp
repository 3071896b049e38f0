// SPDX-License-Identifier: Apache-2.0
// Devices are found by number and by name, and each failure has its sentence.
#include "gpu/gl/egl_context.h"

#include "gpu/gl/gl_thread.h"
#include "gpu/gl/workarounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

namespace ovc {
namespace {

TEST(EglContextGl, ListedDevicesOpenByNumberAndByName) {
    const Result<std::vector<DeviceInfo>> devices = EglContext::list();
    if (!devices)
        GTEST_SKIP() << devices.error().message;
    for (size_t i = 0; i < devices->size(); ++i) {
        const DeviceInfo& info = (*devices)[i];
        EXPECT_FALSE(info.renderer.empty());
        EXPECT_GT(info.memory_bytes, info.default_budget_bytes());
        const Result<EglContext> by_number = EglContext::create(std::to_string(i), {});
        ASSERT_TRUE(by_number) << by_number.error().message;
        EXPECT_EQ(by_number->info().renderer, info.renderer);
        EXPECT_TRUE(EglContext::create(info.renderer, {}));
    }
}

TEST(EglContextGl, AnUnknownNameListsWhatThereIs) {
    const Result<std::vector<DeviceInfo>> devices = EglContext::list();
    if (!devices)
        GTEST_SKIP() << devices.error().message;
    const Result<EglContext> context = EglContext::create("no such card", {});
    ASSERT_FALSE(context);
    EXPECT_THAT(
        context.error().message,
        testing::AllOf(testing::StartsWith("no device is called 'no such card'; there is 0 '"),
                       testing::HasSubstr((*devices)[0].renderer)));
}

TEST(EglContextGl, ANonsensePlatformSaysWhatWasTried) {
    setenv("EGL_PLATFORM", "nonsense", 1);
    const Result<EglContext> context = EglContext::create("", {});
    unsetenv("EGL_PLATFORM");
    ASSERT_FALSE(context);
    EXPECT_EQ(context.error().message,
              "EGL cannot start: EGL_PLATFORM is set to 'nonsense', which is no EGL platform; "
              "Overcast tried 'device' "
              "and 'surfaceless'; unset EGL_PLATFORM or set it to one of these; "
              "`overcast doctor` says what is missing");
}

TEST(EglContextGl, DriversThatEndTheProcessArePassedOver) {
    const auto passed_over = [](const char* renderer, const char* version) {
        return has_defect(Workaround::PassedOver, renderer, version);
    };
    EXPECT_TRUE(
        passed_over("zink (llvmpipe (LLVM 15.0.6, 256 bits))", "4.5 (Core Profile) Mesa 22.3.6"));
    EXPECT_FALSE(passed_over("llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6"));
    EXPECT_FALSE(passed_over("zink (NVIDIA H200)", "4.6 (Core Profile) Mesa 25.0.1"));
}

TEST(EglContextGl, FallingBackToSoftwareIsSaid) {
    std::string said;
    const Result<EglContext> context =
        EglContext::create("", [&](LogLevel level, const std::string& message) {
            EXPECT_EQ(level, LogLevel::Info) << "the answers are those of a GPU";
            said = message;
        });
    if (!context)
        GTEST_SKIP() << context.error().message;
    if (context->info().is_software) {
        EXPECT_EQ(said, "no GPU found; using the software renderer " + context->info().renderer);
    } else {
        EXPECT_EQ(said, "");
    }
}

/// A log for whose copies there is no memory, once that is set.
struct LargeLog {
    explicit LargeLog(const std::atomic<bool>& is_full) : is_full_(&is_full) {}
    LargeLog(const LargeLog& other) : is_full_(other.is_full_) {
        if (*is_full_)
            throw std::bad_alloc();
    }
    void operator()(LogLevel, const std::string&) const {}

private:
    const std::atomic<bool>* is_full_;
};

TEST(EglContextGl, ADeviceForWhichThereIsNoMemoryIsAnError) {
    if (const auto device = GlThread::start("", {}); !device)
        GTEST_SKIP() << device.error().message;
    std::atomic<bool> is_full{false};
    LogSink log{LargeLog(is_full)};
    is_full = true; // the device's thread copies it, beside its context
    const auto device = GlThread::start("", std::move(log));
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().kind, ErrorKind::OutOfMemory);
    EXPECT_EQ(device.error().message, "out of memory");
}

} // namespace
} // namespace ovc
