// SPDX-License-Identifier: Apache-2.0
// The line about a build, and the answer whether to go on.
#include "host/build_watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace ovc {

BuildWatch::BuildWatch(bool shown) : shown_(shown && isatty(STDERR_FILENO)) {}

BuildWatch::~BuildWatch() {
    if (shown_)
        fmt::print(stderr, "\r\033[K");
}

void BuildWatch::watch(ovc_scene_config& config) {
    config.progress = told;
    config.progress_user = this;
}

int BuildWatch::told(void* self, double done, const char* stage) {
    const auto& watch = *static_cast<const BuildWatch*>(self);
    if (watch.shown_) {
        fmt::print(stderr, "\r\033[Kbuilding: {:3.0f} %, {}", 100 * done, stage);
        std::fflush(stderr);
    }
    return watch.interrupt_.interrupted();
}

} // namespace ovc
