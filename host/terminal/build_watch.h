// SPDX-License-Identifier: Apache-2.0
// BuildWatch shows the progress of the plugin's building in a line on a terminal, and lets Ctrl-C
// cancel it.
#pragma once

#include "host/terminal/interrupt.h"
#include "host/terminal/terminal_line.h"
#include "plugin/overcast.h"

namespace ovc {

class BuildWatch {
public:
    /// shown: false keeps it silent even on a terminal. At most one may live, and no InterruptGuard
    /// besides.
    explicit BuildWatch(bool shown);

    /// Makes a scene of this config report to this object, which must outlive the scene's commit.
    void watch(ovc_scene_config& config);

private:
    static int told(void* self, double done, const char* stage);

    const InterruptGuard interrupt_{"stopping"};
    TerminalLine line_;
};

} // namespace ovc
