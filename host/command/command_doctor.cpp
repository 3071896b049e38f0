// SPDX-License-Identifier: Apache-2.0
// overcast doctor: what this machine has of what a device needs, whether the device answers right,
// and what to do about the rest.
#include "host/arguments/arguments.h"
#include "host/arguments/memory_size.h"
#include "host/backend/plugin_loader.h"
#include "host/command/command.h"
#include "host/doctor/machine.h"
#include "host/doctor/right_answers.h"
#include "host/terminal/interrupt.h"

#include <fmt/format.h>

namespace ovc {

static void print_machine(const Machine& machine) {
    const auto state = [](const std::string& refusal) {
        return refusal.empty() ? std::string("loads") : "does not load: " + refusal;
    };
    fmt::print("EGL        {}\n", state(machine.egl_refusal));
    fmt::print("OpenGL     {}\n", state(machine.gl_refusal));
    fmt::print("extensions {}\n", machine.egl_extensions.empty() ? "none" : machine.egl_extensions);
    for (const std::string& file : machine.drivers)
        fmt::print("driver     {}\n", file);
    if (machine.drivers.empty())
        fmt::print("driver     none is listed in /usr/share/glvnd/egl_vendor.d\n");
    for (const DeviceFile& file : machine.device_files)
        fmt::print("GPU        {}: {}\n", file.path,
                   file.refusal.empty() ? "may be opened" : file.refusal);
    if (machine.device_files.empty())
        fmt::print("GPU        no /dev/dri/renderD* and no /dev/nvidia*\n");
    fmt::print("container  {}\n", machine.in_container ? "yes" : "none that we know");
    for (const std::string& variable : machine.overrides)
        fmt::print("variable   {}\n", variable);
}

/// Prints the devices and which one is taken: the first that fits `name`, if any is asked for.
/// Returns that one, or the sentence that tells why there is none.
static Result<ovc_device_info> print_devices(const ovc_api* api, const std::string& name) {
    const Result<std::vector<ovc_device_info>> infos = list_devices(api);
    if (!infos)
        return infos.error();
    for (size_t i = 0; i < infos->size(); ++i)
        fmt::print("device     {}  {}, OpenGL {}{}\n", i, (*infos)[i].renderer, (*infos)[i].version,
                   (*infos)[i].is_software ? " (software)" : "");
    std::string said;
    Result<PluginDevice> device =
        PluginDevice::open(api, name, [&](LogLevel, const std::string& message) {
            said += (said.empty() ? "" : "; ") + message;
        });
    if (!device)
        return device.error();
    Result<ovc_device_info> taken = device->describe();
    if (taken)
        fmt::print("taken      {}: {}\n", taken->renderer,
                   !name.empty()        ? "asked for"
                   : taken->is_software ? said
                                        : "the first that is no software renderer");
    return taken;
}

/// Prints how the device answers. Returns what to do about it; empty: its answers are right.
static std::string print_answers(const std::string& device) {
    const Result<std::vector<CheckedScene>> scenes = check_device(device);
    if (!scenes) {
        fmt::print("answers    none: {}\n", scenes.error().message);
        return "No ray could be traced on the device, for the reason above.";
    }
    uint64_t wrong = 0;
    for (const CheckedScene& scene : *scenes) {
        wrong += scene.wrong;
        fmt::print("answers    {}: {}\n", scene.name,
                   scene.wrong == 0
                       ? fmt::format("right, of {} rays", human_count(scene.rays))
                       : fmt::format("{} of {} rays are answered unlike double precision's",
                                     human_count(scene.wrong), human_count(scene.rays)));
    }
    return wrong == 0 ? ""
                      : "The device's driver computes wrong: take another driver, another device, "
                        "or --backend cpu-kdtree, and send us what this command says.";
}

namespace {

class Doctor final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Says what EGL and OpenGL offer on this machine, which device is taken and "
                        "why, whether it answers rays right, what is missing and what to do about "
                        "it.");
        app.add_option("--device", device_,
                       "Which one to trace rays on: a number or a part of a name from `overcast "
                       "devices`; default: as render chooses")
            ->type_name("NAME");
        app.footer(
            "The exit code is 1 where no device can be used, or it answers wrong.\n\nExamples:\n"
            "  overcast doctor");
    }

    Result<int> run() override {
        const Machine machine = look_at_machine();
        print_machine(machine);
        const Result<const ovc_api*> api = load_plugin();
        if (!api)
            return api.error();
        fmt::print("library    {}\n", find_plugin());
        prepare_process(OVC_KERNEL_AUTO); // so that kernels are those that rays are traced by
        const Result<ovc_device_info> taken = print_devices(*api, device_);
        if (!taken)
            fmt::print("device     none: {}\n", taken.error().message);
        const std::string trouble = taken ? print_answers(device_) : "";
        auto todo = advice(machine, bool(taken), taken && !taken->is_software);
        if (!trouble.empty())
            todo.push_back(trouble);
        for (const std::string& sentence : todo)
            fmt::print("to do      {}\n", sentence);
        if (todo.empty())
            fmt::print("to do      nothing\n");
        return taken && trouble.empty() ? kExitOk : kExitError;
    }

private:
    std::string device_;
};

} // namespace

std::unique_ptr<Subcommand> make_doctor() {
    return std::make_unique<Doctor>();
}

} // namespace ovc
