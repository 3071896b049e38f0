// SPDX-License-Identifier: Apache-2.0
// Memory sizes, from text and to text.
#include "host/arguments/memory_size.h"

#include "core/text/lower_case.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace ovc {

/// More than any device has.
static constexpr uint64_t kMaxBytes = uint64_t(1) << 50;

/// Returns the factor that a unit stands for; 0 where it is no unit.
static double unit_factor(const std::string& text) {
    const std::string unit = lower_case(text);
    if (unit.empty() || unit == "b" || unit == "bytes")
        return 1;
    const size_t power = std::string_view("kmgt").find(unit[0]);
    if (power == std::string_view::npos)
        return 0;
    const std::string_view rest = std::string_view(unit).substr(1);
    if (rest.empty() || rest == "i" || rest == "ib")
        return std::pow(1024.0, double(power + 1));
    return rest == "b" ? std::pow(1000.0, double(power + 1)) : 0;
}

Result<MemorySize> parse_memory_size(std::string_view text) {
    const Error not_a_size{
        fmt::format("'{}' is no memory size; write bytes (268435456), 256M, 1.5GiB or 50%", text)};
    double number = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc{} || !std::isfinite(number) || number < 0)
        return not_a_size;
    std::string_view unit(end, size_t(text.data() + text.size() - end));
    while (!unit.empty() && unit.front() == ' ')
        unit.remove_prefix(1);

    if (text.starts_with("0x") || text.starts_with("0X"))
        return Error{fmt::format("'{}' is hexadecimal; a memory size is decimal", text)};
    const double factor = unit == "%" ? 0.01 : unit_factor(std::string(unit));
    if (factor == 0)
        return not_a_size;
    if (number == 0)
        return Error{fmt::format("the memory size '{}' is zero; it must be more", text)};
    // Zero means the default to the plugin, and that was not asked for.
    const Error too_small{fmt::format("the memory size '{}' is less than one byte", text)};
    if (unit == "%") {
        if (number > 100)
            return Error{
                fmt::format("'{}' is more memory than the device has; 100% is the most", text)};
        const MemorySize share{0, number / 100};
        return share.of(kMaxBytes) > 0 ? Result<MemorySize>(share) : too_small;
    }
    const double bytes = number * factor;
    if (bytes >= double(kMaxBytes))
        return Error{fmt::format("'{}' is more memory than any device has", text)};
    return bytes >= 1 ? Result<MemorySize>(MemorySize{uint64_t(bytes), 0}) : too_small;
}

Result<uint64_t> parse_bytes(std::string_view option, std::string_view text) {
    const Result<MemorySize> size = parse_memory_size(text);
    if (!size)
        return Error{fmt::format("{}: {}", option, size.error().message)};
    if (size->share > 0)
        return Error{fmt::format("{}: found '{}', expected bytes, such as 2G", option, text)};
    return size->bytes;
}

std::string human_bytes(uint64_t bytes) {
    if (bytes < 1024)
        return fmt::format("{} byte{}", bytes, bytes == 1 ? "" : "s");
    double value = double(bytes) / 1024;
    size_t unit = 0;
    for (; value >= 1023.95 && unit < 3; ++unit)
        value /= 1024;
    return fmt::format("{:.1f} {}iB", value, "KMGT"[unit]);
}

std::string human_count(uint64_t count) {
    std::string digits = fmt::format("{}", count);
    for (size_t at = digits.size(); at > 3; at -= 3)
        digits.insert(at - 3, 1, ',');
    return digits;
}

} // namespace ovc
