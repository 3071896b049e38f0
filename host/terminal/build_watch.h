// SPDX-License-Identifier: Apache-2.0
// BuildWatch: while the plugin builds, a line on a terminal that says how far it is, and Ctrl-C,
// which cancels it.
#pragma once

#include "host/terminal/interrupt.h"
#include "host/terminal/terminal_line.h"
#include "plugin/overcast.h"

namespace ovc {

class BuildWatch {
public:
    /// shown: false keeps it silent even on a terminal. At most one at a time, as InterruptGuard.
    explicit BuildWatch(bool shown);

    /// Makes the config's scene report to this, which must outlive its commit.
    void watch(ovc_scene_config& config);

private:
    static int told(void* self, double done, const char* stage);

    const InterruptGuard interrupt_{"stopping"};
    TerminalLine line_;
};

} // namespace ovc
