// SPDX-License-Identifier: Apache-2.0
// What the command says: sentences on standard error, tables on standard output.
#pragma once

#include <string_view>

namespace ovc {

/// "overcast: sentence" in a line of its own, printable whatever names are in it.
void print_message(std::string_view sentence);

/// Lines of text for a person on standard output, each of them printable.
void print_lines(std::string_view lines);

} // namespace ovc
