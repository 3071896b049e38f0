// SPDX-License-Identifier: Apache-2.0
// EGL without windows: EGL_EXT_platform_device for each listed device, or
// EGL_MESA_platform_surfaceless if none is listed.
#include "gpu/gl/egl_context.h"

#include "core/text/format_text.h"
#include "core/text/lower_case.h"
#include "gpu/gl/fork_mark.h"
#include "gpu/gl/gl.h"
#include "gpu/gl/gl_libraries.h"
#include "gpu/gl/requirements.h"
#include "gpu/gl/texel_reads.h"
#include "gpu/gl/workarounds.h"
#include "shaders/layout.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

namespace ovc {

struct EglContext::Platform {
    std::string name; // "EGL device 0"
    EGLenum platform;
    void* native; // EGLDeviceEXT, or EGL_DEFAULT_DISPLAY
};

namespace {

constexpr uint64_t kSoftwareMemory = uint64_t(1) << 30;
// A stack word can count no more, and llvmpipe (Mesa 22.3) crashes on larger buffers that are bound
// as images.
constexpr uint64_t kMaxBufferTexels = uint64_t(OVC_UNIT_TEXELS) << OVC_MAX_BUFFER_BITS;

/// Returns the most frequent cause of a display that does not start.
std::string likely_cause() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        return format_text("; this process may have too little address space for its driver: "
                           "ulimit -v is {} KiB",
                           limit.rlim_cur / 1024);
    return "; its driver may be missing: install libgl1-mesa-dri for Mesa's, or your GPU's";
}

std::string egl_error() {
    switch (eglGetError()) {
    case EGL_SUCCESS:
        return "no error given";
    case EGL_NOT_INITIALIZED:
        return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
        return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
        return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
        return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
        return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
        return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
        return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
        return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
        return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST:
        return "EGL_CONTEXT_LOST";
    default:
        return "an unknown EGL error";
    }
}

bool lists(const char* extensions, std::string_view wanted) {
    const std::string_view all = extensions ? extensions : "";
    for (size_t at = all.find(wanted); at != std::string_view::npos;
         at = all.find(wanted, at + 1)) {
        const size_t end = at + wanted.size();
        if ((at == 0 || all[at - 1] == ' ') && (end == all.size() || all[end] == ' '))
            return true;
    }
    return false;
}

std::string gl_string(GLenum name) {
    const char* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

int gl_integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

/// Returns what a driver offers that has no context of the version needed, for a sentence; nothing
/// where it has no context at all.
std::string older_context(EGLDisplay display) {
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    if (context == EGL_NO_CONTEXT)
        return {};
    std::string offer;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        offer =
            format_text("; '{}' offers OpenGL {}", gl_string(GL_RENDERER), gl_string(GL_VERSION));
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return offer;
}

uint64_t free_memory() {
    GLint kib = 0;
    if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info"))
        glGetIntegerv(GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX, &kib);
    else if (epoxy_has_gl_extension("GL_ATI_meminfo")) {
        std::array<GLint, 4> values{};
        glGetIntegerv(GL_TEXTURE_FREE_MEMORY_ATI, values.data());
        kib = values[0];
    }
    return kib > 0 ? uint64_t(kib) * 1024 : kSoftwareMemory;
}

GLint limit_of(GLenum limit) {
    GLint value = 0;
    glGetIntegerv(limit, &value);
    return value;
}

/// Returns how many buffers of the pool both kernels can read in a way that has these limits.
uint32_t max_pool_buffers(const std::array<GLenum, 3>& limits) {
    GLint smallest = std::numeric_limits<GLint>::max();
    for (const GLenum limit : limits)
        smallest = std::min(smallest, limit_of(limit));
    constexpr GLint kMaxUnitNumberBuffers = int(1u << (31 - OVC_MAX_BUFFER_BITS));
    return uint32_t(std::clamp(smallest - OVC_BINDING_POOL, 0, kMaxUnitNumberBuffers));
}

/// Fills in how many buffers of the pool a kernel can read, for each of TexelReads.
void describe_reads(DeviceInfo& info) {
    info.pool_buffers_by_reads = {
        max_pool_buffers({GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS, GL_MAX_TEXTURE_IMAGE_UNITS,
                          GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS}),
        max_pool_buffers(
            {GL_MAX_COMPUTE_IMAGE_UNIFORMS, GL_MAX_FRAGMENT_IMAGE_UNIFORMS, GL_MAX_IMAGE_UNITS}),
        max_pool_buffers({GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS,
                          GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS,
                          GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS})};
    if (needs(Workaround::ConfusedTexels))
        info.pool_buffers_by_reads[size_t(TexelReads::Textures)] = 0;
    const TexelReads usual = info.is_software ? TexelReads::Images : TexelReads::Textures;
    info.max_pool_buffers = std::max(1u, info.pool_buffers_by_reads[size_t(usual)]);
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    info.max_storage_bytes = uint64_t(std::max<GLint64>(bytes, 0));
    if (epoxy_has_gl_extension("GL_KHR_shader_subgroup"))
        info.subgroup_lanes = uint32_t(std::max(limit_of(GL_SUBGROUP_SIZE_KHR), 0));
}

/// Adds to a sentence that ends without a device where the user learns more.
Error without_device(Error error) {
    error.message += "; `overcast doctor` says what is missing";
    return error;
}

DeviceInfo describe() {
    DeviceInfo info;
    info.renderer = gl_string(GL_RENDERER);
    info.vendor = gl_string(GL_VENDOR);
    info.version = gl_string(GL_VERSION);
    const std::string name = lower_case(info.renderer);
    info.is_software = name.find("llvmpipe") != std::string::npos ||
                       name.find("softpipe") != std::string::npos ||
                       name.find("swrast") != std::string::npos;
    info.is_tested = name.starts_with("llvmpipe") || name.starts_with("nvidia h200");
    info.has_ballots = epoxy_has_gl_extension("GL_ARB_shader_ballot") &&
                       epoxy_has_gl_extension("GL_ARB_gpu_shader_int64");
    info.passes_in_flight = needs(Workaround::FinishedPass) ? 1 : 2;
    info.takes_host_pages = info.is_software && epoxy_has_gl_extension("GL_AMD_pinned_memory");
    GLint value = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &value);
    info.max_texture_size = uint32_t(value);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &value);
    info.max_buffer_texels = std::min(uint64_t(value), kMaxBufferTexels);
    describe_reads(info);
    glGetIntegerv(GL_TEXTURE_BUFFER_OFFSET_ALIGNMENT, &value);
    info.buffer_alignment = std::max<uint64_t>(uint64_t(value), 16);
    info.memory_bytes = info.is_software ? kSoftwareMemory : free_memory();
    return info;
}

} // namespace

Result<Done> check_egl_environment() {
    const char* value = std::getenv("EGL_PLATFORM");
    if (!value || !*value)
        return Done{};
    static constexpr std::array known{"surfaceless", "device", "x11",  "xcb",     "wayland",
                                      "drm",         "gbm",    "null", "android", "haiku"};
    if (std::any_of(known.begin(), known.end(),
                    [&](const char* name) { return lower_case(value) == name; }))
        return Done{};
    return Error{format_text(
        "EGL cannot start: EGL_PLATFORM is set to '{}', which is no EGL platform; Overcast tried "
        "'device' and 'surfaceless'; unset EGL_PLATFORM or set it to one of these",
        value)};
}

Result<std::vector<EglContext::Platform>> EglContext::platforms() {
    // A process has one EGL. If it began before a fork, it looks open in the child, but llvmpipe's
    // threads do not exist there, and libGLX forgets which context is current.
    static const ForkMark began_here;
    if (began_here.forked())
        return Error{"OpenGL began in the process that this one was forked from, and does not "
                     "work on both sides; fork before a device is opened or listed"};
    if (Result<Done> checked = check_egl_environment(); !checked)
        return checked.error();
    if (Result<Done> there = open_gl_libraries(); !there)
        return there.error();
    if (const auto cache = mesa_shader_cache();
        cache && !is_switched_off(Workaround::ReservedCacheIndex))
        if (Result<Done> reserved = reserve_shader_cache_index(*cache); !reserved)
            return reserved.error();
    std::vector<Platform> found;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool devices = lists(extensions, "EGL_EXT_platform_device") &&
                         (lists(extensions, "EGL_EXT_device_enumeration") ||
                          lists(extensions, "EGL_EXT_device_base"));
    if (devices) {
        std::array<EGLDeviceEXT, 64> handles{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(EGLint(handles.size()), handles.data(), &count))
            for (EGLint i = 0; i < count; ++i)
                found.push_back(
                    {format_text("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, handles[i]});
    }
    if (found.empty() && lists(extensions, "EGL_MESA_platform_surfaceless"))
        found.push_back({"Mesa's surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA,
                         reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY)});
    if (found.empty())
        return Error{format_text("EGL offers no headless device: tried EGL_EXT_platform_device and "
                                 "EGL_MESA_platform_surfaceless, EGL lists "
                                 "'{}'; install libegl-mesa0 and libgl1-mesa-dri for the software "
                                 "renderer, or your GPU's EGL driver",
                                 extensions ? extensions : egl_error())};
    return found;
}

Result<EglContext> EglContext::open(const Platform& platform) {
    EglContext context;
    const EGLDisplay display =
        eglGetPlatformDisplayEXT(platform.platform, platform.native, nullptr);
    if (display == EGL_NO_DISPLAY)
        return Error{
            format_text("{}: eglGetPlatformDisplay failed: {}", platform.name, egl_error())};
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor))
        return Error{format_text("{}: eglInitialize failed: {}{}", platform.name, egl_error(),
                                 likely_cause())};
    context.display_ = display;
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    for (const char* needed : kEglExtensions)
        if (!lists(extensions, needed))
            return Error{
                format_text("{}: no {}, which headless rendering needs", platform.name, needed)};
    if (!eglBindAPI(EGL_OPENGL_API))
        return Error{format_text("{}: no desktop OpenGL: {}", platform.name, egl_error())};
    const std::array<EGLint, 11> attributes{EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                            EGL_LOSE_CONTEXT_ON_RESET,
                                            EGL_CONTEXT_MAJOR_VERSION,
                                            kGlMajor,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            kGlMinor,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifdef NDEBUG
                                            EGL_NONE,
                                            EGL_NONE,
#else
                                            EGL_CONTEXT_OPENGL_DEBUG,
                                            EGL_TRUE,
#endif
                                            EGL_NONE};
    // The first attempt asks for notification of resets. A driver that lacks it ends the process on
    // a reset, or says nothing.
    context.context_ =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context.context_ == EGL_NO_CONTEXT)
        context.context_ =
            eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data() + 2);
    if (context.context_ == EGL_NO_CONTEXT)
        return Error{format_text("{}: no OpenGL {}.{} core context: {}{}", platform.name, kGlMajor,
                                 kGlMinor, egl_error(), older_context(display))};
    if (!context.make_current())
        return Error{format_text("{}: eglMakeCurrent failed: {}", platform.name, egl_error())};
    context.info_ = describe();
    if (Result<Done> met = check_requirements(context.info_.renderer, gl_integer); !met)
        return Error{format_text("{}: {}", platform.name, met.error().message)};
    if (needs(Workaround::PassedOver)) {
        const WorkaroundEntry& entry = entry_of(Workaround::PassedOver);
        return Error{format_text("{}: '{}' {}; {}", platform.name, context.info_.renderer,
                                 entry.symptom, entry.answer)};
    }
    return context;
}

Result<std::vector<DeviceInfo>> EglContext::list() {
    Result<std::vector<Platform>> found = platforms();
    if (!found)
        return without_device(found.error());
    std::vector<DeviceInfo> infos;
    std::string failures;
    for (const Platform& platform : *found) {
        Result<EglContext> context = open(platform);
        if (context)
            infos.push_back(context->info());
        else
            failures += (failures.empty() ? "" : "; ") + context.error().message;
    }
    if (infos.empty())
        return without_device({"no EGL device works: " + failures});
    return infos;
}

Result<EglContext> EglContext::create(const std::string& name, const LogSink& log) {
    Result<std::vector<Platform>> found = platforms();
    if (!found)
        return without_device(found.error());
    const bool by_number =
        !name.empty() &&
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
    std::vector<EglContext> working;
    std::string failures;
    for (const Platform& platform : *found) {
        Result<EglContext> context = open(platform);
        if (!context) {
            failures += (failures.empty() ? "" : "; ") + context.error().message;
            continue;
        }
        const DeviceInfo& info = context->info();
        const bool fits =
            name.empty() ? !info.is_software
            : by_number  ? std::to_string(working.size()) == name
                         : lower_case(info.renderer).find(lower_case(name)) != std::string::npos;
        if (fits) {
            if (!failures.empty())
                say(log, LogLevel::Warning, "passed over: " + failures);
            return std::move(*context);
        }
        working.push_back(std::move(*context));
    }
    if (working.empty())
        return without_device({"no EGL device works: " + failures});
    if (name.empty()) {
        say(log, LogLevel::Info, // not a warning, because answers are the same
            format_text("no GPU found{}; using the software renderer {}",
                        failures.empty() ? "" : " (" + failures + ")", working[0].info().renderer));
        if (!working[0].make_current())
            return Error{"eglMakeCurrent failed: " + egl_error()};
        return std::move(working[0]);
    }
    std::string names;
    for (size_t i = 0; i < working.size(); ++i)
        names += format_text("{}{} '{}'", i ? ", " : "", i, working[i].info().renderer);
    return without_device({format_text("no device is called '{}'; there is {}{}", name, names,
                                       failures.empty() ? "" : "; failed: " + failures)});
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)),
      info_(std::move(other.info_)) {}

EglContext& EglContext::operator=(EglContext&& other) noexcept {
    std::swap(display_, other.display_);
    std::swap(context_, other.context_);
    std::swap(info_, other.info_);
    return *this;
}

EglContext::~EglContext() {
    // The display stays initialised, because EGL shares it with everyone in the process who asked
    // for the same device, such as the host.
    if (!context_)
        return;
    if (eglGetCurrentContext() == context_)
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
}

bool EglContext::alive() const {
    // Another user of the display may have ended it by eglTerminate(). EGL is asked before GL:
    // libepoxy may have to look GL's functions up, and without a context that ends the process.
    EGLint type = 0;
    return context_ && eglGetCurrentContext() == context_ &&
           eglQueryContext(display_, context_, EGL_CONTEXT_CLIENT_TYPE, &type) &&
           glGetGraphicsResetStatus() == GL_NO_ERROR;
}

void EglContext::lose() {
    if (!context_)
        return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, std::exchange(context_, nullptr));
}

bool EglContext::make_current() const {
    return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

} // namespace ovc
