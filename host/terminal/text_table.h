// SPDX-License-Identifier: Apache-2.0
// TextTable: rows of cells as a Markdown table that is also readable as plain text.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace ovc {

using TextRow = std::vector<std::string>;

/// rows: the header first; all as long as it. The first column stands to the left, numbers to the
/// right. With a line end.
std::string markdown_table(std::span<const TextRow> rows);

} // namespace ovc
