// SPDX-License-Identifier: Apache-2.0
// overcast devices: the GPUs and software renderers that the plugin can run on.
#include "host/arguments/arguments.h"
#include "host/arguments/memory_size.h"
#include "host/backend/plugin_loader.h"
#include "host/command/command.h"
#include "host/terminal/interrupt.h"
#include "host/tuning/tune_device.h"

#include <fmt/format.h>

#include <cstdio>

namespace ovc {

static constexpr const char* kDevicesExamples = R"(Examples:
  overcast devices
  overcast devices --tune
  overcast render dragon.ply --device 1
  overcast render dragon.ply --device llvmpipe

The environment variable OVC_PLUGIN names another libovercast.so than the one beside this program.)";

static std::string describe(size_t number, const ovc_device_info& info) {
    return fmt::format("{}  {}{}{}\n"
                       "   vendor   {}\n"
                       "   version  {}\n"
                       "   memory   {}, of which {} by default\n"
                       "   limits   textures of {} texels a side, buffer textures of {} texels\n",
                       number, info.renderer, info.is_software ? " (software)" : "",
                       info.is_tested ? "" : " (untested: see what overcast doctor says)",
                       info.vendor, info.version, human_bytes(info.memory_bytes),
                       human_bytes(info.default_budget_bytes), human_count(info.max_texture_size),
                       human_count(info.max_buffer_texels));
}

namespace {

class Devices final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Lists the devices that rays can be traced on, by number and name.");
        app.add_flag("--tune", tunes_,
                     "Measure all variants of the kernel on a device, show what each takes, and "
                     "keep the fastest for later runs");
        app.add_option("--device", device_, "Which one to measure; default: as render chooses")
            ->type_name("NAME");
        app.footer(kDevicesExamples);
    }

    Result<int> run() override {
        if (!device_.empty() && !tunes_)
            return Error{"--device means nothing without --tune"};
        if (tunes_)
            return tune();
        const Result<const ovc_api*> api = load_plugin();
        if (!api)
            return api.error();
        prepare_process(OVC_KERNEL_AUTO); // names are those that render and trace know
        const Result<std::vector<ovc_device_info>> infos = list_devices(*api);
        if (!infos)
            return infos.error();
        for (size_t i = 0; i < infos->size(); ++i)
            fmt::print("{}", describe(i, (*infos)[i]));
        if (infos->empty())
            fmt::print("no devices; --backend cpu-kdtree traces on the CPU\n");
        return kExitOk;
    }

private:
    Result<int> tune() const {
        const Result<Done> done = tune_device(device_, [](const std::string& line) {
            // fmt::print() would throw through the library, in whose log this runs.
            std::fputs((line + "\n").c_str(), stdout);
            std::fflush(stdout);
        });
        return done ? Result<int>(kExitOk) : done.error();
    }

    bool tunes_ = false;
    std::string device_;
};

} // namespace

std::unique_ptr<Subcommand> make_devices() {
    return std::make_unique<Devices>();
}

} // namespace ovc
