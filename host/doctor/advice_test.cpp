// SPDX-License-Identifier: Apache-2.0
// Each thing that a machine may lack has its sentence, and a machine that lacks nothing has none.
#include "host/doctor/machine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ovc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Machine with_mesa() {
    Machine machine;
    machine.drivers = {"/usr/share/glvnd/egl_vendor.d/50_mesa.json"};
    return machine;
}

TEST(Doctor, HasNothingToSayOfAMachineThatWorks) {
    EXPECT_THAT(advice(with_mesa(), /* has_device= */ true, /* has_gpu= */ false), IsEmpty());
    Machine gpu = with_mesa();
    gpu.device_files = {{"/dev/nvidia0", ""}, {"/dev/dri/renderD128", "Permission denied"}};
    EXPECT_THAT(advice(gpu, true, true), IsEmpty());
}

TEST(Doctor, NamesThePackagesThatAreMissing) {
    Machine machine;
    machine.egl_refusal = machine.gl_refusal = "cannot open shared object file";
    EXPECT_THAT(advice(machine, false, false),
                ElementsAre(HasSubstr("libegl1"), HasSubstr("libopengl0")));
    EXPECT_THAT(advice(Machine{}, false, false), ElementsAre(HasSubstr("libgl1-mesa-dri")));
    EXPECT_THAT(advice(with_mesa(), false, false), ElementsAre(HasSubstr("libgl1-mesa-dri")));
}

TEST(Doctor, NamesTheCapabilitiesThatAContainerLacks) {
    Machine machine = with_mesa();
    machine.in_container = true;
    EXPECT_THAT(advice(machine, true, false), ElementsAre(HasSubstr("--gpus all")));
    machine.device_files = {{"/dev/nvidia0", ""}};
    EXPECT_THAT(advice(machine, true, false), ElementsAre(HasSubstr("libEGL_nvidia.so.0")));
    machine.nvidia_capabilities = "compute,utility";
    EXPECT_THAT(advice(machine, true, false),
                ElementsAre(HasSubstr("NVIDIA_DRIVER_CAPABILITIES=compute,utility")));
    machine.nvidia_capabilities = "compute,graphics";
    EXPECT_THAT(advice(machine, true, false), ElementsAre(HasSubstr("libEGL_nvidia.so.0")));
    machine.has_nvidia_egl = true;
    EXPECT_THAT(advice(machine, true, true), IsEmpty());
}

TEST(Doctor, NamesFilesThatTheUserMayNotOpen) {
    Machine machine = with_mesa();
    machine.device_files = {{"/dev/dri/renderD128", "Permission denied"}};
    EXPECT_THAT(advice(machine, true, false),
                ElementsAre(HasSubstr("/dev/dri/renderD128 cannot be opened (Permission denied)")));
}

TEST(Doctor, NamesVariablesThatHideDrivers) {
    Machine machine = with_mesa();
    machine.overrides = {"GALLIUM_DRIVER=softpipe"};
    EXPECT_THAT(advice(machine, false, false), ElementsAre(HasSubstr("GALLIUM_DRIVER=softpipe")));
    EXPECT_THAT(advice(machine, true, false), IsEmpty());
}

} // namespace
} // namespace ovc
