// SPDX-License-Identifier: Apache-2.0
// The frames of a camera path to render, and the names of their files.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace ovc {

/// Every step-th frame from first to last, both included.
struct FrameRange {
    uint32_t first = 0, last = 0, step = 1;

    uint32_t count() const { return (last - first) / step + 1; }
};

/// Parses "7", "0:99" or "0:99:10" for a camera path of `frames` frames, at least 1. path: its name
/// in the error.
Result<FrameRange> parse_frames(std::string_view text, uint32_t frames, std::string_view path);

/// Returns whether `pattern` has a place for the frame's number: a run of # in the file's name.
bool has_frame_number(std::string_view pattern);

/// Returns the pattern with its last run of # replaced by the number, padded with zeros to as many
/// digits: "out-####.png" and 7 give "out-0007.png". It is unchanged where it has no such run.
std::string frame_file(std::string_view pattern, uint32_t frame);

} // namespace ovc
