// SPDX-License-Identifier: Apache-2.0
// Pads each column to its widest cell.
#include "host/terminal/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc {

static std::string line_of(const TextRow& row, std::span<const size_t> widths) {
    std::string line = fmt::format("| {:<{}} |", row[0], widths[0]);
    for (size_t i = 1; i < row.size(); ++i)
        line += fmt::format(" {:>{}} |", row[i], widths[i]);
    return line + "\n";
}

static std::string rule_of(std::span<const size_t> widths) {
    std::string line = fmt::format("|{:-<{}}|", "", widths[0] + 2);
    for (size_t i = 1; i < widths.size(); ++i)
        line += fmt::format("{:->{}}|", ":", widths[i] + 2);
    return line + "\n";
}

std::string markdown_table(std::span<const TextRow> rows) {
    assert(!rows.empty() && !rows[0].empty());
    std::vector<size_t> widths(rows[0].size());
    for (const TextRow& row : rows) {
        assert(row.size() == widths.size());
        for (size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text = line_of(rows[0], widths) + rule_of(widths);
    for (const TextRow& row : rows.subspan(1))
        text += line_of(row, widths);
    return text;
}

} // namespace ovc
