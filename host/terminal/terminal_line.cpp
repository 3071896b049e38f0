// SPDX-License-Identifier: Apache-2.0
// Writes a carriage return, the text, and then "erase to the end of the line" (ECMA-48, EL).
// Erasing first would flicker.
#include "host/terminal/terminal_line.h"

#include "core/text/printable.h"
#include "host/terminal/message.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace ovc {

/// Returns the columns of the terminal; 80 where it does not say.
static size_t terminal_width() {
    winsize size{};
    const bool told = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return told ? size.ws_col : 80;
}

TerminalLine::TerminalLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)) {}

void TerminalLine::show(const std::string& text) {
    if (!shown_)
        return;
    // We leave one column, since a cursor behind the last may stand on the next line.
    const std::string fitting = printable(text).substr(0, terminal_width() - 1);
    if (fitting == there_)
        return;
    there_ = fitting;
    write_to_standard_error(fmt::format("\r{}\033[K", fitting));
}

std::string time_left(double seconds) {
    if (seconds < 10)
        return fmt::format("{:.0f} s left", std::ceil(seconds));
    if (seconds < 100)
        return fmt::format("{:.0f} s left", 5 * std::ceil(seconds / 5));
    if (seconds < 100 * 60)
        return fmt::format("{:.0f} min left", std::ceil(seconds / 60));
    return fmt::format("{:.0f} h left", std::ceil(seconds / 3600));
}

} // namespace ovc
