// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/density.h"

#include "importers/file/text.h"
#include "importers/pov/words/files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace ovc::pov {

/// Three sizes of 16 bits come first, then values of 8, 16 or 32 bits, as many as fill the file.
/// All begin with the highest byte.
Result<DensityGrid> read_density(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto number = [&](size_t at, size_t size) {
        uint32_t value = 0;
        for (size_t i = 0; i < size; ++i)
            value = value << 8 | uint8_t(bytes[at + i]);
        return value;
    };
    constexpr size_t kHeader = 6;
    DensityGrid grid;
    uint64_t count = bytes.size() < kHeader ? 0 : 1;
    for (size_t axis = 0; axis < 3 && count > 0; ++axis) {
        grid.size[axis] = number(2 * axis, 2);
        count *= grid.size[axis];
    }
    const uint64_t room = bytes.size() - std::min(kHeader, bytes.size());
    const uint64_t width = count > 0 ? room / count : 0;
    if (width != 1 && width != 2 && width != 4)
        return Error{fmt::format("{}: found {} bytes of values, expected 1, 2 or 4 for each of {}",
                                 path.string(), room, count)};
    const double max_value = double((uint64_t(1) << (8 * width)) - 1);
    grid.values.reserve(count);
    for (uint64_t i = 0; i < count; ++i)
        grid.values.push_back(float(number(kHeader + i * width, width) / max_value));
    return grid;
}

} // namespace ovc::pov
