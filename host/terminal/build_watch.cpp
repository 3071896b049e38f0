// SPDX-License-Identifier: Apache-2.0
// Shows the line about a build, and answers whether the build should stop.
#include "host/terminal/build_watch.h"

#include <fmt/format.h>

namespace ovc {

void BuildWatch::watch(ovc_scene_config& config) {
    config.progress = told;
    config.progress_user = this;
}

int BuildWatch::told(void* self, double done, const char* stage) {
    auto& watch = *static_cast<BuildWatch*>(self);
    if (!watch.interrupt_)
        return 0;
    watch.line_->show(fmt::format("building: {:3.0f} %, {}", 100 * done, stage));
    return watch.interrupt_->interrupted();
}

} // namespace ovc
