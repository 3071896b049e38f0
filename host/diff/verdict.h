// SPDX-License-Identifier: Apache-2.0
// What a comparison is held to, and how it is told: for a person, and for a program.
#pragma once

#include "host/diff/compare.h"

#include <limits>
#include <string>

namespace ovc {

/// As OpenImageIO's idiff exits.
enum class Verdict { Ok = 0, Warning = 1, Failure = 2, NotComparable = 3, Unreadable = 4 };

/// More than `percent` of the pixels farther apart than `each`, or one farther than `any`.
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

Verdict judge(const Comparison& comparison, const Limits& limits);

/// The names of the two files and all that is known of them, with a line end.
std::string diff_text(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits);
/// As JSON (docs/guide/diff.md); what is infinite is null.
std::string diff_json(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits);

} // namespace ovc
