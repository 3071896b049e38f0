// SPDX-License-Identifier: Apache-2.0
// Lower case of ASCII, whatever the locale says.
#pragma once

#include <string>
#include <string_view>

namespace ovc {

/// Returns the text with the letters A to Z in lower case; other bytes stay.
inline std::string lower_case(std::string_view mixed) {
    std::string text(mixed);
    for (char& c : text)
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return text;
}

} // namespace ovc
