// SPDX-License-Identifier: Apache-2.0
// std::from_chars parses numbers exactly, whatever the locale.
#include "importers/file/text.h"

#include "core/text/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

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

/// Returns whether the value lies halfway between two floats, as one text in 2^29 does once it is
/// rounded to double.
bool is_between_floats(double value) {
    return (std::bit_cast<uint64_t>(value) & 0x1fffffff) == 0x10000000;
}

} // namespace

std::optional<float> parse_float(std::string_view word) {
    return parse_real<float>(word);
}

std::optional<double> parse_double(std::string_view word) {
    const std::optional<double> value = parse_real<double>(word);
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
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string listed(std::span<const std::string> items) {
    constexpr size_t kShown = 3;
    const auto shown = items.first(std::min(items.size(), kShown));
    if (items.size() > kShown)
        return fmt::format("{} and {} more", fmt::join(shown, ", "), items.size() - kShown);
    return fmt::format("{}", fmt::join(shown, ", "));
}

} // namespace ovc
