// SPDX-License-Identifier: Apache-2.0
// Text to rays, hits to text.
#include "host/ray_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace ovc {

static constexpr std::string_view kBlanks = " \t,\r";

bool is_blank_line(std::string_view line) {
    const size_t first = line.find_first_not_of(kBlanks);
    return first == std::string_view::npos || line[first] == '#';
}

Result<Ray> parse_ray(std::string_view line) {
    double v[8];
    size_t count = 0;
    const char* const end = line.data() + line.size();
    for (size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = line.find_first_not_of(kBlanks, at)) {
        const size_t word_end = std::min(line.find_first_of(kBlanks, at), line.size());
        const std::string_view word = line.substr(at, word_end - at);
        if (count == 8)
            return Error{"found more than 8 numbers, expected ox oy oz dx dy dz [tmin tmax]"};
        const char* first = line.data() + at;
        if (*first == '+' && first + 1 < end && first[1] != '-')
            ++first;
        const auto [stop, failure] = std::from_chars(first, line.data() + word_end, v[count]);
        if (failure == std::errc::result_out_of_range)
            return Error{fmt::format("the number '{}' does not fit a double", word)};
        if (failure != std::errc{} || stop != line.data() + word_end)
            return Error{fmt::format("found '{}', expected a number", word)};
        ++count;
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
