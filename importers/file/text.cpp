// SPDX-License-Identifier: Apache-2.0
// std::from_chars parses numbers exactly, whatever the locale.
#include "importers/file/text.h"

#include "core/text/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>

namespace ovc {

namespace {

/// Old Windows runtimes print "1.#IND", "1.#QNAN0" and "1.#INF" for NaN and infinity.
template <class T>
std::optional<T> parse_windows_non_number(std::string_view word) {
    const bool negative = word.starts_with('-');
    word.remove_prefix(negative ? 1 : 0);
    if (word.starts_with("1.#INF"))
        return std::numeric_limits<T>::infinity() * T(negative ? -1 : 1);
    if (word.starts_with("1.#IND") || word.starts_with("1.#QNAN") || word.starts_with("1.#SNAN"))
        return std::numeric_limits<T>::quiet_NaN();
    return std::nullopt;
}

template <class T>
std::optional<T> parse_real(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1);
    const char* last = word.data() + word.size();
    T value{};
    auto [end, ec] = std::from_chars(word.data(), last, value);
    if (ec == std::errc::result_out_of_range) {
        // A number too large becomes infinity, one too small zero; from_chars leaves that to us.
        long double wide = 0;
        const auto again = std::from_chars(word.data(), last, wide);
        ec = again.ec;
        end = again.ptr;
        value = T(wide);
    }
    if (ec == std::errc() && end == last)
        return value;
    return parse_windows_non_number<T>(word);
}

/// Returns the double nearest to a word of the form that most files write, -12.345 or 12, if its
/// digits are a whole number below 2^53. That number and the power of ten are exact doubles, so
/// their quotient rounds once. Based on: Clinger 1990, "How to Read Floating Point Numbers
/// Accurately".
std::optional<double> parse_plain(std::string_view word) {
    static constexpr double kPowers[] = {1e0, 1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,
                                         1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17};
    const char* at = word.data();
    const char* const last = at + word.size();
    const bool negative = at != last && *at == '-';
    at += negative;
    uint64_t digits = 0;
    const auto take_digits = [&] {
        const char* const first = at;
        for (; at != last && *at >= '0' && *at <= '9'; ++at)
            digits = digits * 10 + uint64_t(*at - '0');
        return size_t(at - first);
    };
    const size_t whole = take_digits();
    size_t behind_point = 0;
    if (at != last && *at == '.') {
        ++at;
        behind_point = take_digits();
        if (behind_point == 0)
            return std::nullopt;
    }
    if (at != last || whole == 0 || whole + behind_point >= std::size(kPowers) || digits >> 53 != 0)
        return std::nullopt;
    const double value = double(digits) / kPowers[behind_point];
    return negative ? -value : value;
}

/// Returns whether the value lies halfway between two floats, as one text in 2^29 does once it is
/// rounded to double.
bool is_between_floats(double value) {
    return (std::bit_cast<uint64_t>(value) & 0x1fffffff) == 0x10000000;
}

} // namespace

std::optional<float> parse_float(std::string_view word) {
    // Rounded to double, a text is on the same side of halfway as before, or there.
    if (const auto value = parse_plain(word); value && !is_between_floats(*value))
        return float(*value);
    return parse_real<float>(word);
}

std::optional<double> parse_double(std::string_view word) {
    const std::optional<double> plain = parse_plain(word);
    const std::optional<double> value = plain ? plain : parse_real<double>(word);
    if (value && is_between_floats(*value))
        if (const auto nearest = parse_real<float>(word); nearest && *nearest != float(*value))
            return std::nextafter(*value, double(*nearest));
    return value;
}

std::string quoted(std::string_view word) {
    constexpr size_t kShown = 40;
    return fmt::format("'{}'", printable(word, kShown));
}

std::string found(std::string_view word, std::string_view what) {
    if (word.empty())
        return "the end of the line";
    return what.empty() ? quoted(word) : fmt::format("{} {}", what, quoted(word));
}

std::string counted(uint64_t count, std::string_view noun) {
    const std::string_view of = noun.substr(std::min(noun.find(" of "), noun.size()));
    noun.remove_suffix(of.size());
    return fmt::format("{} {}{}{}", count, noun, count == 1 ? "" : "s", of);
}

static std::optional<char> byte_of(std::string_view digits) {
    unsigned value = 0;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value, 16);
    return error == std::errc() && end == last && value != 0 ? std::optional(char(value))
                                                             : std::nullopt;
}

std::string decoded_uri(std::string_view uri) {
    std::string plain;
    for (size_t i = 0; i < uri.size(); ++i) {
        const auto code =
            uri[i] == '%' && i + 2 < uri.size() ? byte_of(uri.substr(i + 1, 2)) : std::nullopt;
        plain += code ? *code : uri[i];
        i += code ? 2 : 0;
    }
    return plain;
}

std::string listed(std::span<const std::string> items) {
    constexpr size_t kShown = 3;
    const auto shown = items.first(std::min(items.size(), kShown));
    if (items.size() > kShown)
        return fmt::format("{} and {} more", fmt::join(shown, ", "), items.size() - kShown);
    return fmt::format("{}", fmt::join(shown, ", "));
}

} // namespace ovc
