// SPDX-License-Identifier: Apache-2.0
// Parses frame numbers in arguments, and writes them into names of files.
#include "host/render/frames.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <charconv>
#include <optional>
#include <vector>

namespace ovc {

/// Returns the whole numbers between colons; empty where one of them is no whole number.
static std::vector<uint32_t> parse_numbers(std::string_view text) {
    std::vector<uint32_t> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;; ++at) {
        uint32_t number = 0;
        const auto [stop, failure] = std::from_chars(at, end, number);
        if (failure != std::errc{} || (stop != end && *stop != ':'))
            return {};
        numbers.push_back(number);
        if (stop == end)
            return numbers;
        at = stop;
    }
}

Result<FrameRange> parse_frames(std::string_view text, uint32_t frames, std::string_view path) {
    assert(frames > 0);
    const std::vector<uint32_t> n = parse_numbers(text);
    if (n.empty() || n.size() > 3)
        return Error{
            fmt::format("--frames needs FIRST:LAST, such as 0:99, or one number, not '{}'", text)};
    const FrameRange range{n[0], n.size() > 1 ? n[1] : n[0], n.size() > 2 ? n[2] : 1};
    if (range.step == 0)
        return Error{fmt::format("--frames needs a step of at least 1, not '{}'", text)};
    if (range.first > range.last)
        return Error{fmt::format("--frames goes from the first to the last, not '{}'", text)};
    if (range.last >= frames)
        return Error{fmt::format("--frames: there is no frame {}; {} has frames 0 to {}",
                                 range.last, path, frames - 1)};
    return range;
}

/// A run of # in a name.
struct Run {
    size_t at, length;
};

static std::optional<Run> number_run(std::string_view pattern) {
    const size_t last = pattern.rfind('#');
    const size_t slash = pattern.rfind('/');
    if (last == pattern.npos || (slash != pattern.npos && last < slash))
        return std::nullopt;
    const size_t before = pattern.find_last_not_of('#', last);
    const size_t first = before == pattern.npos ? 0 : before + 1;
    return Run{first, last + 1 - first};
}

bool has_frame_number(std::string_view pattern) {
    return number_run(pattern).has_value();
}

std::string frame_file(std::string_view pattern, uint32_t frame) {
    const std::optional<Run> run = number_run(pattern);
    if (!run)
        return std::string(pattern);
    return fmt::format("{}{:0{}}{}", pattern.substr(0, run->at), frame, run->length,
                       pattern.substr(run->at + run->length));
}

} // namespace ovc
