// SPDX-License-Identifier: Apache-2.0
// Tests that the host's state is the same, byte for byte, before and after a use or misuse of each
// function of the table, in all floating-point modes and with the host's own GL context current.
#include "tests/misuse/host_state.h"

#include "gpu/gl/egl_context.h"
#include "gpu/gl/gl.h"
#include "tests/misuse/entries.h"

#include <csignal>
#include <cstdlib>
#include <fenv.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>
#include <xmmintrin.h>

namespace ovc {
namespace {

using test::api;

/// A mode that a host may run in: MXCSR and the x87's control word.
struct FloatMode {
    const char* name;
    uint32_t mxcsr;
    uint16_t x87_control;
};

constexpr uint32_t kMasked = 0x1f80, kFlushes = 0x8040;
constexpr FloatMode kModes[] = {
    {"default", kMasked, 0x37f},
    {"down", kMasked | 0x2000, 0x77f},
    {"up", kMasked | 0x4000, 0xb7f},
    {"to zero", kMasked | 0x6000, 0xf7f},
    {"FTZ and DAZ", kMasked | kFlushes, 0x37f},
    {"FTZ, DAZ, up, x87 in single", kMasked | kFlushes | 0x4000, 0x87f},
    {"all flags raised", kMasked | 0x3f, 0x37f},
    {"exceptions that trap", 0x0000, 0x340},
};

void set(const FloatMode& mode) {
    asm volatile("fnclex; fldcw %0" ::"m"(mode.x87_control));
    _mm_setcsr(mode.mxcsr);
}

/// Calls the function in a mode, and compares the host's state before and after.
template <class Function>
void expect_untouched(const FloatMode& mode, const std::string& what, Function&& function) {
    set(mode);
    const uint32_t before_mxcsr = _mm_getcsr();
    const test::HostState before = test::host_state();
    set(mode); // host_state() computed and changed flags.
    function();
    const uint32_t after_mxcsr = _mm_getcsr();
    const test::HostState after = test::host_state();
    set(kModes[0]);
    EXPECT_EQ(before_mxcsr, after_mxcsr) << what << ", " << mode.name;
    EXPECT_EQ(test::difference(before, after), "") << what << ", " << mode.name;
}

void expect_all_untouched(ovc_device device) {
    test::Subject subject(device);
    for (const FloatMode& mode : kModes)
        for (const test::Entry& entry : test::entries()) {
            ovc_result result = OVC_ERROR_INTERNAL;
            expect_untouched(mode, entry.name, [&] { result = entry.use(subject); });
            EXPECT_EQ(result, OVC_OK) << entry.name << ", " << mode.name;
            expect_untouched(mode, std::string(entry.name) + " misused", [&] {
                for (const test::Misuse& misuse : entry.misuse(subject))
                    if (misuse.got != misuse.expected)
                        result = misuse.got;
            });
            EXPECT_EQ(result, OVC_OK) << entry.name << " misused, " << mode.name;
        }
}

class Host : public test::DeviceTest {};

TEST_F(Host, KeepsItsFloatingPointEnvironmentAndSignals) {
    setenv("OVC_MISUSE_TEST", "mine", 1);
    std::signal(SIGUSR1, [](int) {});
    std::signal(SIGFPE, SIG_DFL);
    expect_all_untouched(device.get());
    std::signal(SIGUSR1, SIG_DFL);
    unsetenv("OVC_MISUSE_TEST");
}

/// The host waits for SIGTERM, which is then blocked on its threads. Where it is open on another it
/// ends the process.
TEST_F(Host, TakesTheSignalsThatItWaitsFor) {
    test::Subject subject(device.get());
    for (const test::Entry& entry : test::entries())
        EXPECT_EQ(entry.use(subject), OVC_OK) << entry.name;
    size_t others = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        if (task.path().filename() == std::to_string(gettid()))
            continue;
        std::ifstream status(task.path() / "status");
        std::string name, line;
        std::getline(status, name);
        while (std::getline(status, line) && !line.starts_with("SigBlk:"))
            ;
        ASSERT_FALSE(line.empty());
        const uint64_t blocked = std::stoull(line.substr(line.find('\t') + 1), nullptr, 16);
        EXPECT_TRUE(blocked >> (SIGTERM - 1) & 1) << name;
        EXPECT_FALSE(blocked >> (SIGSEGV - 1) & 1) << name;
        ++others;
    }
    EXPECT_GT(others, 0u);
}

/// The host has a context on the same display as the plugin's device, in the middle of work.
TEST_F(Host, KeepsItsGlContextWithAllThatIsSetInIt) {
    const Result<EglContext> mine = EglContext::create("", {});
    ASSERT_TRUE(mine) << mine.error().message;
    GLuint names[4];
    glGenTextures(1, &names[0]);
    glBindTexture(GL_TEXTURE_2D, names[0]);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 4, 4);
    glGenFramebuffers(1, &names[1]);
    glBindFramebuffer(GL_FRAMEBUFFER, names[1]);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, names[0], 0);
    glClearColor(0.25f, 0.5f, 0.75f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glGenBuffers(1, &names[2]);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, names[2]);
    glGenVertexArrays(1, &names[3]);
    glBindVertexArray(names[3]);
    glViewport(1, 2, 3, 4);
    glEnable(GL_SCISSOR_TEST);
    glScissor(1, 1, 2, 2);
    glPixelStorei(GL_PACK_ALIGNMENT, 2);
    ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    expect_all_untouched(device.get());
    EXPECT_TRUE(mine->alive());
}

/// Ends all displays of the machine's EGL devices, as a host that needs them no more does.
void end_displays() {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    ASSERT_TRUE(eglQueryDevicesEXT(16, devices, &count));
    std::vector<EGLDisplay> displays = {
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)};
    for (EGLint i = 0; i < count; ++i)
        displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    for (const EGLDisplay display : displays)
        eglTerminate(display);
}

/// The plugin's context goes with the display that it shares with the host.
TEST_F(Host, MayEndTheDisplayThatItShares) {
    const ovc_scene traced = test::make_field(device.get());
    ASSERT_TRUE(test::field_answers(traced));
    const ovc_scene fresh = test::make_field(device.get());
    const ovc_scene idle = test::make_field(device.get());
    end_displays();
    const ovc_ray ray = test::into_cell(7, 1);
    const std::vector<ovc_ray> rays(10000, ray);
    std::vector<ovc_hit> hits(rays.size());
    for (const ovc_scene scene : {fresh, traced}) {
        ovc_result result = api().intersect(scene, rays.data(), rays.size(), hits.data(), nullptr);
        if (result == OVC_ERROR_DEVICE_LOST) {
            EXPECT_STREQ(api().last_error(device.get()),
                         "the GPU's context was lost; the device is open again, and the next "
                         "call will work");
            result = api().intersect(scene, rays.data(), rays.size(), hits.data(), nullptr);
        }
        ASSERT_EQ(result, OVC_OK) << api().last_error(device.get());
        EXPECT_TRUE(test::is_in_cell(hits.back(), 7, 1));
        EXPECT_TRUE(test::field_answers(scene));
    }
    end_displays();
    for (const ovc_scene scene : {fresh, traced, idle})
        api().destroy_scene(scene);
    const ovc_scene later = test::make_field(device.get());
    // The first call that needs the device reports that it was lost.
    const bool again = !later;
    const ovc_scene last = again ? test::make_field(device.get()) : later;
    ASSERT_TRUE(last) << api().last_error(device.get());
    EXPECT_TRUE(test::field_answers(last));
    api().destroy_scene(last);
}

TEST_F(Host, KeepsItsChoiceOfAnotherClientApi) {
    ASSERT_TRUE(eglBindAPI(EGL_OPENGL_ES_API));
    expect_all_untouched(device.get());
    EXPECT_EQ(eglQueryAPI(), EGLenum(EGL_OPENGL_ES_API));
    eglBindAPI(EGL_OPENGL_API);
}

} // namespace
} // namespace ovc
