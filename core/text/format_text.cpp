// SPDX-License-Identifier: Apache-2.0
// Turns values into text, and puts them into patterns.
#include "core/text/format_text.h"

#include <cassert>
#include <charconv>

namespace ovc {

std::string text_of(double value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

std::string hexadecimal(uint64_t value, size_t digits) {
    std::array<char, 16> found;
    const auto end = std::to_chars(found.data(), found.data() + found.size(), value, 16).ptr;
    const size_t count = size_t(end - found.data());
    return std::string(digits > count ? digits - count : 0, '0').append(found.data(), count);
}

std::string fill_in(std::string_view pattern, std::span<const std::string> values) {
    std::string text;
    for (const std::string& value : values) {
        const size_t place = pattern.find("{}");
        assert(place != pattern.npos);
        text.append(pattern.substr(0, place)).append(value);
        pattern.remove_prefix(place + 2);
    }
    return text.append(pattern);
}

} // namespace ovc
