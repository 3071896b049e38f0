// SPDX-License-Identifier: Apache-2.0
// The words that POV-Ray 3.7 reserves: a scene cannot declare them.
#pragma once

#include <string>
#include <string_view>

namespace ovc::pov {

bool is_keyword(std::string_view word);

/// Returns "; did you mean 'location'?", or nothing.
std::string did_you_mean_keyword(std::string_view word);

} // namespace ovc::pov
