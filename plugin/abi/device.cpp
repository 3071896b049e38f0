// SPDX-License-Identifier: Apache-2.0
// Devices: listing, opening, describing.
#include "plugin/abi/device.h"

#include "core/system/blocked_signals.h"
#include "core/system/parallel.h"
#include "core/text/format_text.h"
#include "gpu/driver/vector_width.h"
#include "gpu/trace/tracer.h"
#include "plugin/abi/device_call.h"
#include "plugin/abi/struct_size.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>
#include <thread>

namespace ovc {
namespace {

/// Keeps the last message of a thread where no device does, and cuts it where it is too long. It is
/// trivial for the same reason as in_host_function.
class ThreadMessage {
public:
    void set(ovc_result, const std::string& text) {
        const std::string message = printable(text);
        const size_t length = std::min(message.size(), sizeof(text_) - 1);
        std::memcpy(text_, message.data(), length);
        text_[length] = '\0';
    }
    const char* get() const { return text_; }

private:
    char text_[2048]{};
};
constinit thread_local ThreadMessage no_device;

template <size_t N>
void copy(char (&to)[N], const std::string& from) {
    const size_t length = std::min(from.size(), N - 1);
    std::memcpy(to, from.data(), length);
    to[length] = '\0';
}

/// Fills in the fields that `to`, an info of this header or of an earlier one, has room for.
void fill(ovc_device_info& to, const DeviceInfo& from) {
    const size_t size = to.struct_size;
    check_size<ovc_device_info>("ovc_device_info", size, offsetof(ovc_device_info, is_tested));
    ovc_device_info all{size};
    copy(all.renderer, from.renderer);
    copy(all.vendor, from.vendor);
    copy(all.version, from.version);
    all.is_software = from.is_software;
    all.max_texture_size = from.max_texture_size;
    all.max_buffer_texels = from.max_buffer_texels;
    all.memory_bytes = from.memory_bytes;
    all.default_budget_bytes = from.default_budget_bytes();
    all.is_tested = from.is_tested;
    std::memcpy(&to, &all, size);
}

/// Whether a driver may have read the environment.
std::atomic<bool> drivers_loaded{false};

void check_environment() {
    if (const Result<Done> environment = check_egl_environment(); !environment)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT, environment.error().message};
}

Failure no_device_for(const Error& error) {
    return {error.kind == ErrorKind::OutOfMemory ? OVC_ERROR_OUT_OF_MEMORY : OVC_ERROR_NO_DEVICE,
            error.message};
}

void advise(const LogSink& log, const DeviceInfo& info) {
    if (const std::optional<std::string> advice = advice_on_vectors(info.renderer))
        say(log, LogLevel::Info, *advice);
}

/// EGL's idea of a current context is per thread: a thread of our own leaves the host's alone.
Result<std::vector<DeviceInfo>> list_on_own_thread() {
    Result<std::vector<DeviceInfo>> found = Error{};
    std::exception_ptr thrown;
    const BlockedSignals blocked;
    std::thread([&] {
        try {
            found = EglContext::list();
        } catch (...) {
            thrown = std::current_exception();
        }
    }).join();
    if (thrown)
        std::rethrow_exception(thrown);
    return found;
}

} // namespace

bool is_device(ovc_device device, const char* call) {
    if (!device || device->magic != kDeviceMagic)
        no_device.set(OVC_ERROR_INVALID_ARGUMENT,
                      format_text("{}: device is NULL or not a device", call));
    else if (device->mark.forked())
        no_device.set(OVC_ERROR_INVALID_ARGUMENT,
                      format_text("{}: the device belongs to the process that this one was forked "
                                  "from",
                                  call));
    else
        return true;
    return false;
}

ovc_result fail_without_device(ovc_result code, const std::string& message) {
    no_device.set(code, message);
    return code;
}

const char* last_error(ovc_device device) noexcept {
    if (!device || device->magic != kDeviceMagic || device->mark.forked())
        return no_device.get();
    const CallsInside::Call call(device->calls);
    return device->messages.get();
}

ovc_result list_devices(ovc_device_info* infos, uint32_t capacity, uint32_t* count) {
    return guard(no_device, [&] {
        if (!count || (capacity && !infos))
            throw Failure{OVC_ERROR_INVALID_ARGUMENT, "list_devices: infos or count is NULL"};
        check_environment();
        drivers_loaded = true;
        const Result<std::vector<DeviceInfo>> found = list_on_own_thread();
        if (!found)
            throw no_device_for(found.error());
        // Infos of an earlier header are smaller, and the caller's array of them is dense.
        auto* info = reinterpret_cast<std::byte*>(infos);
        for (uint32_t i = 0; i < std::min<size_t>(capacity, found->size()); ++i) {
            auto& to = *reinterpret_cast<ovc_device_info*>(info);
            fill(to, (*found)[i]);
            info += to.struct_size;
        }
        *count = uint32_t(found->size());
    });
}

ovc_result create_device(const ovc_device_config* given, ovc_device* device) {
    ovc_device_config config{sizeof(ovc_device_config)};
    const ovc_result result = guard(no_device, [&] {
        if (given)
            config = whole("ovc_device_config", given, offsetof(ovc_device_config, error));
        if (!device)
            throw Failure{OVC_ERROR_INVALID_ARGUMENT, "create_device: device is NULL"};
        *device = nullptr;
        if (config.reserved)
            throw Failure{
                OVC_ERROR_INVALID_ARGUMENT,
                format_text("ovc_device_config.reserved is {}, expected 0", config.reserved)};
        auto created = std::make_unique<ovc_device_t>(config.threads);
        const LoopThreads::Scope threads(created->loops);
        created->messages.tell(config.error, config.error_user);
        if (config.log)
            created->log = [log = config.log, user = config.log_user](LogLevel level,
                                                                      const std::string& text) {
                if (in_host_function)
                    return; // a call from within such a function only returns its code
                const HostFunction mark;
                log(user, ovc_log_level(level), printable(text).c_str());
            };
        check_environment();
        drivers_loaded = true;
        start_threads();
        Result<std::unique_ptr<GlThread>> gl =
            GlThread::start(config.name ? config.name : "", created->log,
                            {config.gpu_memory_bytes, config.threads, &created->loops});
        if (!gl)
            throw no_device_for(gl.error());
        if (const auto plan = plan_memory((*gl)->info().default_budget_bytes(), (*gl)->info());
            config.gpu_memory_bytes && !plan)
            throw Failure{OVC_ERROR_OUT_OF_BUDGET,
                          "ovc_device_config.gpu_memory_bytes: " + plan.error().message};
        created->gl = std::move(*gl);
        advise(created->log, created->gl->info());
        *device = created.release();
    });
    if (result != OVC_OK && config.error)
        config.error(config.error_user, result, no_device.get());
    return result;
}

ovc_result prepare_process(ovc_kernel kernel) {
    return guard(no_device, [&] {
        if (uint32_t(kernel) > OVC_KERNEL_COMPUTE)
            throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                          format_text("prepare_process: kernel is {}, expected 0 to {}",
                                      uint32_t(kernel), uint32_t(OVC_KERNEL_COMPUTE))};
        if (drivers_loaded)
            throw Failure{OVC_ERROR_INVALID_STATE,
                          "prepare_process: a device was listed or opened before; call it first"};
        use_wide_vectors(kernel == OVC_KERNEL_FRAGMENT);
    });
}

ovc_result describe_device(ovc_device device, ovc_device_info* info) {
    return on_device(device, "describe_device", [&] {
        if (!info)
            throw Failure{OVC_ERROR_INVALID_ARGUMENT, "describe_device: info is NULL"};
        fill(*info, device->gl->info());
    });
}

void destroy_device(ovc_device device) {
    if (!is_device(device, "destroy_device") || in_host_function)
        return;
    int scenes = 0, tickets = 0;
    const auto is_used = [&] {
        scenes = device->scenes;
        tickets = device->tickets;
        return scenes > 0 || tickets > 0;
    };
    if (!is_used()) {
        uint32_t alive = kDeviceMagic;
        if (!device->magic.compare_exchange_strong(alive, kDestroyed))
            return; // another thread destroys it
        device->calls.wait_until_none();
        if (!is_used()) {
            delete device;
            return;
        }
        device->magic = kDeviceMagic; // a call that was inside has made a scene or a ticket
    }
    say(device->log, LogLevel::Error,
        scenes > 0
            ? format_text("destroy_device: {} scenes are still alive; the device stays", scenes)
            : format_text("destroy_device: {} tickets are not released; the device stays",
                          tickets));
}

} // namespace ovc
