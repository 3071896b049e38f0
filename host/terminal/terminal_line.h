// SPDX-License-Identifier: Apache-2.0
// TerminalLine: one line on standard error that overwrites itself, where that is a terminal;
// nothing elsewhere.
#pragma once

#include <string>

namespace ovc {

/// At most one at a time. Nobody else writes to the terminal while it shows something, but for
/// whole lines that come after clear().
class TerminalLine {
public:
    /// wanted: false keeps it silent even on a terminal.
    explicit TerminalLine(bool wanted = true);
    ~TerminalLine() { clear(); }
    TerminalLine(const TerminalLine&) = delete;
    TerminalLine& operator=(const TerminalLine&) = delete;

    bool shown() const { return shown_; }
    /// Cut to what the terminal is wide, for a line that wraps cannot be overwritten. Written in
    /// one go, and only where it differs from what stands there: so it does not flicker. text:
    /// ASCII.
    void show(const std::string& text);
    void clear() { show(""); }

private:
    const bool shown_;
    std::string there_;
};

/// "40 s left", "12 min left", "3 h left", as precise as an estimate is.
std::string time_left(double seconds);

} // namespace ovc
