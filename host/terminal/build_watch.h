// SPDX-License-Identifier: Apache-2.0
// BuildWatch shows the progress of the plugin's building in a line on a terminal, and lets Ctrl-C
// cancel it.
#pragma once

#include "host/terminal/interrupt.h"
#include "host/terminal/terminal_line.h"
#include "plugin/overcast.h"

#include <optional>

namespace ovc {

class BuildWatch {
public:
    /// shown: false keeps it silent even on a terminal.
    explicit BuildWatch(bool shown) : shown_(shown) {}
    BuildWatch(const BuildWatch&) = delete;

    /// Makes a scene of this config report to this object, which must outlive the scene.
    void watch(ovc_scene_config& config);

    /// A commit is watched while one of these lives.
    class Building {
    public:
        explicit Building(BuildWatch& watch) : watch_(watch) {
            watch_.interrupt_.emplace("stopping");
            watch_.line_.emplace(watch_.shown_);
        }
        ~Building() {
            watch_.line_.reset();
            watch_.interrupt_.reset();
        }
        Building(const Building&) = delete;

    private:
        BuildWatch& watch_;
    };

private:
    static int told(void* self, double done, const char* stage);

    const bool shown_;
    std::optional<InterruptGuard> interrupt_;
    std::optional<TerminalLine> line_;
};

} // namespace ovc
