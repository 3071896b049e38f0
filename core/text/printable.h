// SPDX-License-Identifier: Apache-2.0
// Text that others made, as a terminal may have it.
#pragma once

#include <string>
#include <string_view>

namespace ovc {

/// UTF-8 that prints stays as it is. Control characters become \n, \t, \r or \x and their code,
/// those of more than a byte (C1, marks that turn the direction of writing, ends of lines) \u and
/// theirs, and bytes that are no UTF-8 \x and their value: what comes out is one line, moves no
/// cursor and changes no color. Done twice it is the same.
std::string printable(std::string_view text);

/// The same of so many bytes at most, whole characters, and "…" where there are more.
std::string printable(std::string_view text, size_t most);

} // namespace ovc
