// SPDX-License-Identifier: Apache-2.0
// Writes rows of cells as a Markdown table that is also readable as plain text.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace ovc {

using TextRow = std::vector<std::string>;

/// Returns the table, with a line end. rows: the header first; all have as many cells as it. The
/// first column is aligned to the left, the others to the right.
std::string markdown_table(std::span<const TextRow> rows);

} // namespace ovc
