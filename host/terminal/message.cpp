// SPDX-License-Identifier: Apache-2.0
#include "host/terminal/message.h"

#include "core/text/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace ovc {

void print_message(std::string_view sentence) {
    fmt::print(stderr, "overcast: {}\n", printable(sentence));
}

void print_lines(std::string_view lines) {
    while (!lines.empty()) {
        const size_t end = std::min(lines.find('\n'), lines.size());
        fmt::print("{}{}", printable(lines.substr(0, end)), end < lines.size() ? "\n" : "");
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

} // namespace ovc
