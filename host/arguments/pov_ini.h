// SPDX-License-Identifier: Apache-2.0
// Reads POV-Ray's .ini files, which hold settings and words of the command line, by sections.
// Source: the documentation of POV-Ray 3.7, section 3.2.1.2, "Using INI Files".
#pragma once

#include "core/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// A setting such as Width=640, with its key in small letters. A word of the command line has no
/// key, and is the value.
struct IniItem {
    std::string key;
    std::string value;
    std::string place; // "FILE:LINE: " before a message; empty on the command line
};

/// Returns whether `word` is "FILE.ini" or "FILE.ini[SECTION]", in any case.
bool names_ini(std::string_view word);

/// Returns the items before the first section, and those in the section that `word` names, in the
/// order of the file. word: names_ini() holds. Error: the file cannot be opened.
Result<std::vector<IniItem>> read_ini(const std::string& word);

/// Parses "Key=value". Returns nothing where the word has no '=' behind letters, digits and
/// underscores.
std::optional<IniItem> as_setting(std::string_view word);

} // namespace ovc
