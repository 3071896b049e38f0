// SPDX-License-Identifier: Apache-2.0
// Watchers show a rendering while it goes on.
#pragma once

#include "host/terminal/progress_lines.h"
#include "host/view/window.h"

#include <memory>

namespace ovc {

struct Watchers {
    ProgressLines lines;
    std::unique_ptr<Window> window; // null: none
};

} // namespace ovc
