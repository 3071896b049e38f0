// SPDX-License-Identifier: Apache-2.0
// format_text(): writes values into sentences. The library has nothing else to format, and so it
// needs no library for that, whose headers would take half of its compile time.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

/// A text with `arguments` places {}. Any other number does not compile.
template <size_t arguments>
struct FormatPattern {
    std::string_view text;

    consteval FormatPattern(const char* pattern) : text(pattern) {
        size_t places = 0;
        for (size_t at = text.find("{}"); at != text.npos; at = text.find("{}", at + 2))
            ++places;
        if (places != arguments)
            throw "as many {} as arguments";
    }
};

inline std::string text_of(std::string_view value) {
    return std::string(value);
}
template <std::integral Integer>
std::string text_of(Integer value) {
    return std::to_string(value); // a bool becomes 0 or 1
}
/// Returns as few digits as tell the value from its neighbours.
std::string text_of(double value);

/// Returns the value in hexadecimal, with zeros in front where it has fewer than `digits`.
std::string hexadecimal(uint64_t value, size_t digits);

/// Returns the pattern with its {} in turn replaced by the values, which are as many.
std::string fill_in(std::string_view pattern, std::span<const std::string> values);

/// Returns the pattern with each {} in turn replaced by the text of an argument: strings as they
/// are, numbers in decimal.
template <class... Args>
std::string format_text(FormatPattern<sizeof...(Args)> pattern, const Args&... args) {
    const std::array<std::string, sizeof...(Args)> values{text_of(args)...};
    return fill_in(pattern.text, values);
}

} // namespace ovc
