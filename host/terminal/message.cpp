// SPDX-License-Identifier: Apache-2.0
#include "host/terminal/message.h"

#include "core/text/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace ovc {

/// Returns where the first line of the message ends.
static size_t line_end(std::string_view message) {
    constexpr std::string_view kBreak = "\n    ";
    return std::min(message.find(kBreak), message.size());
}

void print_message(std::string_view message) {
    std::string text = "overcast: " + printable(message.substr(0, line_end(message)));
    message.remove_prefix(line_end(message));
    while (!message.empty()) {
        message.remove_prefix(1);
        text += "\n" + printable(message.substr(0, line_end(message)));
        message.remove_prefix(line_end(message));
    }
    write_to_standard_error(text + "\n");
}

void write_to_standard_error(const std::string& text) {
    // fmt::print() would throw, through callbacks of the C ABI too.
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

void print_lines(std::string_view lines) {
    while (!lines.empty()) {
        const size_t end = std::min(lines.find('\n'), lines.size());
        fmt::print("{}{}", printable(lines.substr(0, end)), end < lines.size() ? "\n" : "");
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

} // namespace ovc
