// SPDX-License-Identifier: Apache-2.0
// The limits that a comparison must keep, and its report for a person and for a program.
#pragma once

#include "host/diff/compare.h"

#include <limits>
#include <string>

namespace ovc {

/// The exit codes of OpenImageIO's idiff.
enum class Verdict { Ok = 0, Warning = 1, Failure = 2, NotComparable = 3, Unreadable = 4 };

/// A limit is passed where more than `percent` of the pixels are farther apart than `each`, or one
/// is farther than `any`.
struct Limit {
    double each = 1e-6;
    double percent = 0;
    double any = std::numeric_limits<double>::infinity();

    bool is_passed_by(const Comparison& comparison) const;
};

struct Limits {
    Limit fail;
    Limit warn;
};

/// Returns Ok, Warning or Failure.
Verdict judge(const Comparison& comparison, const Limits& limits);

/// Returns the comparison of the files `a` and `b` as a text, with a line end.
std::string diff_text(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits);
/// Returns the same as JSON (docs/guide/diff.md); infinite numbers are null.
std::string diff_json(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits);

} // namespace ovc
