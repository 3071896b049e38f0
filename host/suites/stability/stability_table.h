// SPDX-License-Identifier: Apache-2.0
// Writes the results of the stability suite for people (an aligned Markdown table) and for programs
// (JSON).
#pragma once

#include "host/suites/optics/optics.h"
#include "host/suites/stability/stability.h"

#include <span>
#include <string>

namespace ovc {

/// Returns the title, the legend of the columns, the table, and the sums. Columns of peers that did
/// not run are left out.
std::string stability_markdown(const std::string& title, std::span<const StabilityResult> results);

/// Returns {"renderer", "cases": [{...}], "optics": [{...}]} with one object for each case, in
/// order. Infinite numbers are null; without optics cases there is no "optics".
std::string stability_json(std::span<const StabilityResult> results,
                           std::span<const OpticsResult> optics);

} // namespace ovc
