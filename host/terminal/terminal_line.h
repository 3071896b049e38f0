// SPDX-License-Identifier: Apache-2.0
// TerminalLine is one line on standard error that overwrites itself; it writes nothing where that
// is no terminal.
#pragma once

#include <string>

namespace ovc {

/// At most one may live at a time. While it shows something, nobody else may write to the terminal;
/// call clear() before whole lines.
class TerminalLine {
public:
    /// wanted: false keeps it silent even on a terminal.
    explicit TerminalLine(bool wanted = true);
    ~TerminalLine() { clear(); }
    TerminalLine(const TerminalLine&) = delete;
    TerminalLine& operator=(const TerminalLine&) = delete;

    bool shown() const { return shown_; }
    /// Shows the text, cut to the width of the terminal, since a line that wraps cannot be
    /// overwritten. It writes in one go, and only where the text differs from the one that is
    /// there, so that the line does not flicker. text: ASCII.
    void show(const std::string& text);
    void clear() { show(""); }

private:
    const bool shown_;
    std::string there_;
};

/// Returns "40 s left", "12 min left" or "3 h left", as precise as an estimate is.
std::string time_left(double seconds);

} // namespace ovc
