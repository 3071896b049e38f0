// SPDX-License-Identifier: Apache-2.0
// The results of the stability suite, for people (a Markdown table, aligned) and for programs
// (JSON).
#pragma once

#include "host/report/optics/optics.h"
#include "host/report/stability/stability.h"

#include <span>
#include <string>

namespace ovc {

/// title, what the columns mean, the table, and the sums. Columns of peers that were not asked are
/// left out.
std::string stability_markdown(const std::string& title, std::span<const StabilityResult> results);

/// {"renderer", "cases": [{...}], "optics": [{...}]}: one object a case, in order. Infinite numbers
/// are null; without optics cases there is no "optics".
std::string stability_json(std::span<const StabilityResult> results,
                           std::span<const OpticsResult> optics);

} // namespace ovc
