// SPDX-License-Identifier: Apache-2.0
// Makes the numbers of a page as readers see them.
#include "host/report/page/page_model.h"

#include "host/arguments/memory_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

std::string shown_number(double value) {
    constexpr double most = 1e15; // doubles below it hold whole numbers exactly
    if (value == std::floor(value) && std::abs(value) < most)
        return fmt::format("{}{}", value < 0 ? "-" : "", human_count(uint64_t(std::abs(value))));
    const double size = std::abs(value);
    if (size >= 100 && size < 1e6)
        return fmt::format("{:.0f}", value);
    return fmt::format("{:.3g}", value);
}

int height_of_bars(size_t lines) {
    constexpr int rest = 110, line = 17; // axis and margins; a line of letters of size 11
    return std::max(Plot().height, rest + line * int(lines));
}

Json megabytes(const Json& bytes) {
    return bytes.is_null() ? bytes : Json(1e-6 * bytes.get<double>());
}

Piece number(const Json& figures, const std::string& pointer) {
    const Json& value = figures.at(Json::json_pointer(pointer));
    assert(value.is_number() || value.is_null());
    return Number{pointer, value, value.is_null() ? "-" : shown_number(value.get<double>())};
}

} // namespace ovc
