// SPDX-License-Identifier: Apache-2.0
// Prints the command's messages on standard error and its tables on standard output.
#pragma once

#include <string>
#include <string_view>

namespace ovc {

/// Prints "overcast: message" to standard error, in lines of its own. A message is a sentence and
/// any number of lines that begin with four blanks, such as those of a scene. Control characters,
/// as in names of files, are made printable, and so is every other line break: no file's name can
/// look like a message of its own.
void print_message(std::string_view message);

/// Writes the text to standard error as it stands. Where nothing can be written there, as on a full
/// disk, it is lost: what the program was asked for does not depend on its messages.
void write_to_standard_error(const std::string& text);

/// Prints lines of text to standard output, each of them made printable.
void print_lines(std::string_view lines);

} // namespace ovc
