// SPDX-License-Identifier: Apache-2.0
// Parses rays from text, and writes hits as text.
#include "host/backend/ray_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace ovc {

static constexpr std::string_view kBlanks = " \t\r";

/// Returns the word in quotes, cut short, with unprintable bytes as \x and their code.
static std::string quoted(std::string_view word) {
    constexpr size_t kShown = 40;
    std::string text = "'";
    for (const char c : word.substr(0, kShown))
        text += c >= ' ' && c <= '~' ? std::string(1, c)
                                     : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    return text + (word.size() > kShown ? "...'" : "'");
}

static Error not_a_number(std::string_view word) {
    const char* hint = "";
    if (word.find(',') != std::string_view::npos)
        hint = "; numbers are separated by blanks and have a decimal point, no comma";
    else if (word.find('\0') != std::string_view::npos)
        hint = "; rays that are no text need --binary";
    return {fmt::format("found {}, expected a number{}", quoted(word), hint)};
}

/// Returns whether a number that no double holds is too small rather than too large. Where a long
/// double does not hold it either, only the exponent can say so, because a line is too short for so
/// many zeros.
static bool is_underflow(const char* first, const char* last) {
    long double wide = 1;
    const auto [stop, failure] = std::from_chars(first, last, wide);
    if (failure == std::errc{})
        return wide > -1 && wide < 1;
    const std::string_view word(first, size_t(last - first));
    return word.find("e-") != word.npos || word.find("E-") != word.npos;
}

bool is_blank_line(std::string_view line) {
    const size_t first = line.find_first_not_of(kBlanks);
    return first == std::string_view::npos || line[first] == '#';
}

/// Parses the whole word as a number; one too small for a double is 0.
static Result<double> parse_number(std::string_view word) {
    const char* first = word.data();
    const char* const last = first + word.size();
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        ++first;
    double value = 0;
    const auto [stop, failure] = std::from_chars(first, last, value);
    if (stop != last || failure == std::errc::invalid_argument)
        return not_a_number(word);
    if (failure == std::errc{})
        return value;
    if (!is_underflow(first, last))
        return Error{fmt::format("the number {} does not fit a double", quoted(word))};
    return *first == '-' ? -0.0 : 0.0;
}

Result<Ray> parse_ray(std::string_view line) {
    line = line.substr(0, line.find('#'));
    double v[8];
    size_t count = 0;
    for (size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = line.find_first_not_of(kBlanks, at)) {
        const size_t word_end = std::min(line.find_first_of(kBlanks, at), line.size());
        if (count == 8)
            return Error{"found more than 8 numbers, expected ox oy oz dx dy dz [tmin tmax]"};
        const Result<double> number = parse_number(line.substr(at, word_end - at));
        if (!number)
            return number.error();
        v[count++] = *number;
        at = word_end;
    }
    if (count != 6 && count != 8)
        return Error{fmt::format("found {} number{}, expected ox oy oz dx dy dz [tmin tmax]", count,
                                 count == 1 ? "" : "s")};
    Ray ray{{v[0], v[1], v[2]}, 0, {v[3], v[4], v[5]}};
    if (count == 8) {
        ray.t_min = v[6];
        ray.t_max = v[7];
    }
    return ray;
}

void append_hit(std::string& text, const Hit& hit) {
    if (hit.is_hit())
        fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", hit.t, hit.u, hit.v,
                       hit.id.mesh, hit.id.prim);
    else
        text += "miss\n";
}

} // namespace ovc
