// SPDX-License-Identifier: Apache-2.0
// These functions take words and numbers out of a line of text.
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline void skip_blanks(std::string_view& text) {
    size_t n = 0;
    while (n < text.size() && is_blank(text[n]))
        ++n;
    text.remove_prefix(n);
}

/// Takes the next word off `text`; returns an empty word at its end.
inline std::string_view next_word(std::string_view& text) {
    skip_blanks(text);
    size_t n = 0;
    while (n < text.size() && !is_blank(text[n]))
        ++n;
    const std::string_view word = text.substr(0, n);
    text.remove_prefix(n);
    return word;
}

/// Returns the text without its comment, which begins with a # at its start or behind a blank. A
/// digit right behind the # makes it part of a name ("Material #25", as 3ds Max writes).
inline std::string_view without_comment(std::string_view text) {
    for (size_t i = 0; i < text.size(); ++i) {
        const bool begins = text[i] == '#' && (i == 0 || is_blank(text[i - 1]));
        const bool numbers = i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
        if (begins && !numbers)
            return text.substr(0, i);
    }
    return text;
}

inline std::string_view trimmed(std::string_view text) {
    skip_blanks(text);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

/// Returns the whole word as an integer; nothing if it is none or out of the range of T.
template <std::integral T>
std::optional<T> parse_number(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1);
    T value{};
    const auto [end, ec] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (ec != std::errc() || end != word.data() + word.size())
        return std::nullopt;
    return value;
}

/// Takes a word of one to nine digits off `text`, as nearly every index is. Returns false, and
/// takes at most blanks, for any other word. parse_number() took a quarter of the time of reading a
/// PLY file as text.
inline bool take_digits(std::string_view& text, uint32_t& value) {
    skip_blanks(text);
    value = 0;
    size_t n = 0;
    for (; n < text.size() && n < 10 && text[n] >= '0' && text[n] <= '9'; ++n)
        value = value * 10 + uint32_t(text[n] - '0');
    if (n == 0 || n == 10 || (n < text.size() && !is_blank(text[n])))
        return false;
    text.remove_prefix(n);
    return true;
}

/// Return the float or double nearest to the whole word, infinity and NaN included; nothing if it
/// is no number. A double rounds to the float nearest to the text, not only to the one nearest to
/// the double, so that a reader may keep doubles until it knows that floats suffice.
std::optional<float> parse_float(std::string_view word);
std::optional<double> parse_double(std::string_view word);

/// Returns the word as a message shows it: in quotes, cut short, printable.
std::string quoted(std::string_view word);

/// Returns the word in quotes, behind `what` if that is given; "the end of the line" if it is
/// empty.
std::string found(std::string_view word, std::string_view what = {});

/// Returns "1 row", "2 rows".
std::string counted(uint64_t count, std::string_view noun);

/// Returns the name that a URI stands for: "a b.png" for "a%20b.png".
std::string decoded_uri(std::string_view uri);

/// Returns "a, b, c and 5 more": at most three in full.
std::string listed(std::span<const std::string> items);

} // namespace ovc
