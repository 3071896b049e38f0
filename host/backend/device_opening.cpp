// SPDX-License-Identifier: Apache-2.0
// A thread opens the device, and holds back its messages until finish(). Where reading the scene
// fails, its error is then the only message, as if the device had been opened afterwards.
#include "host/backend/device_opening.h"

#include <cassert>
#include <mutex>
#include <utility>
#include <vector>

namespace ovc {

struct DeviceOpening::HeldLog {
    std::mutex mutex;
    bool released = false;
    LogSink log;
    std::vector<std::pair<LogLevel, std::string>> messages;

    void hold(LogLevel level, const std::string& message) {
        const std::lock_guard lock(mutex);
        if (released)
            say(log, level, message);
        else
            messages.emplace_back(level, message);
    }

    void release(const LogSink& to) {
        const std::lock_guard lock(mutex);
        released = true;
        log = to;
        for (const auto& [level, message] : messages)
            say(log, level, message);
        messages.clear();
    }
};

static bool needs_device(const BackendOptions& options) {
    return options.kind != BackendKind::CpuKdTree && options.kind != BackendKind::Embree;
}

void prepare_process(const BackendOptions& options) {
    if (!needs_device(options))
        return;
    if (structure_of(options.kind) != OVC_STRUCTURE_TWO_LEVEL) {
        prepare_process(OVC_KERNEL_FRAGMENT, kThesis); // its systems have fragment kernels
        return;
    }
    const bool is_fragment = options.kernel_variant.starts_with("fragment");
    prepare_process(is_fragment ? OVC_KERNEL_FRAGMENT : options.kernel);
}

DeviceOpening::DeviceOpening(const BackendOptions& options) : held_(std::make_shared<HeldLog>()) {
    if (!needs_device(options))
        return;
    const auto open = [held = held_, name = options.device,
                       structure = structure_of(options.kind)]() -> Opened {
        const Result<const ovc_api*> api =
            load_plugin(structure == OVC_STRUCTURE_TWO_LEVEL ? kProduct : kThesis);
        if (!api)
            return {api.error(), OVC_OK};
        const LogSink log = [held](LogLevel level, const std::string& message) {
            held->hold(level, message);
        };
        ovc_result code = OVC_OK;
        Result<PluginDevice> device = PluginDevice::open(*api, name, log, &code);
        return {std::move(device), code};
    };
    opened_ = std::async(std::launch::async, open);
}

Result<PluginDevice> DeviceOpening::finish(const LogSink& log, ovc_result& code) {
    assert(opened_.valid());
    Opened opened = opened_.get();
    held_->release(log);
    code = opened.code;
    return std::move(opened.device);
}

} // namespace ovc
