// SPDX-License-Identifier: Apache-2.0
// Prints the command's messages on standard error and its tables on standard output.
#pragma once

#include <string_view>

namespace ovc {

/// Prints "overcast: sentence" to standard error, in a line of its own. Control characters, as in
/// names of files, are made printable.
void print_message(std::string_view sentence);

/// Prints lines of text to standard output, each of them made printable.
void print_lines(std::string_view lines);

} // namespace ovc
