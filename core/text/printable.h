// SPDX-License-Identifier: Apache-2.0
// Makes text from elsewhere fit for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace ovc {

/// Returns the text as one line that moves no cursor and changes no color. UTF-8 that prints stays
/// as it is. Control characters become \n, \t, \r or \x and their code; those of more than a byte
/// (C1, marks that turn the direction of writing, ends of lines) become \u and theirs; and bytes
/// that are no UTF-8 become \x and their value. Doing it twice changes nothing more.
std::string printable(std::string_view text);

/// Returns the same for up to `max_bytes` bytes of the text, in whole characters, then "…" for
/// more.
std::string printable(std::string_view text, size_t max_bytes);

} // namespace ovc
