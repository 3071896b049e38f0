// SPDX-License-Identifier: Apache-2.0
// The words that POV-Ray 3.7 keeps for itself: none of them can be declared.
#pragma once

#include <string_view>

namespace ovc::pov {

bool is_keyword(std::string_view word);

} // namespace ovc::pov
