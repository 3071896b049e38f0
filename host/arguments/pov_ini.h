// SPDX-License-Identifier: Apache-2.0
// POV-Ray's .ini files: settings and words of the command line, by sections.
// Source: the documentation of POV-Ray 3.7, section 3.2.1.2, "Using INI Files".
#pragma once

#include "core/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// Width=640: the key in small letters; or a word as the command line has it, and no key.
struct IniItem {
    std::string key;
    std::string value;
    std::string place; // "FILE:LINE: " before a message; empty on the command line
};

/// "FILE.ini" or "FILE.ini[SECTION]".
bool names_ini(std::string_view word);

/// What stands before the first section, and in the section that `word` names. Error: no such file.
Result<std::vector<IniItem>> read_ini(const std::string& word);

/// "Key=value"; nothing where the word has no '=' behind letters, digits and underscores.
std::optional<IniItem> as_setting(std::string_view word);

} // namespace ovc
