// SPDX-License-Identifier: Apache-2.0
// Finds which entries of the table a driver matches.
#include "gpu/gl/workarounds.h"

#include "gpu/gl/gl.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace ovc {

bool has_defect(Workaround which, std::string_view renderer, std::string_view version) {
    const WorkaroundEntry& entry = entry_of(which);
    const auto alike = [](char a, char b) {
        return std::tolower(uint8_t(a)) == std::tolower(uint8_t(b));
    };
    const bool named =
        entry.driver.empty() || !std::ranges::search(renderer, entry.driver, alike).empty();
    return named && version.find(entry.version) != version.npos;
}

bool is_switched_off(Workaround which) {
    const char* const value = std::getenv("OVERCAST_NO_WORKAROUNDS");
    std::string_view names = value ? value : "";
    while (!names.empty()) {
        const size_t comma = names.find(',');
        if (names.substr(0, comma) == entry_of(which).name)
            return true;
        names.remove_prefix(comma == names.npos ? names.size() : comma + 1);
    }
    return false;
}

bool needs(Workaround which) {
    const auto text = [](GLenum name) -> std::string_view {
        const auto* found = reinterpret_cast<const char*>(glGetString(name));
        return found ? found : "";
    };
    return !is_switched_off(which) && has_defect(which, text(GL_RENDERER), text(GL_VERSION));
}

} // namespace ovc
