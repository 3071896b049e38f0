// SPDX-License-Identifier: Apache-2.0
// Functions that functions.inc takes from POV-Ray itself: internal(60) is f_rounded_box.
#pragma once

#include <span>

namespace ovc::pov {

/// x, y, z, and what the function is told besides.
using InternalFunction = double (*)(std::span<const double>);

struct Internal {
    InternalFunction call = nullptr; // null: Overcast does not know it
    int count = 0;                   // of arguments
};

/// Of those numbers in functions.inc that say a distance, a direction or a simple body.
Internal find_internal(int number);

} // namespace ovc::pov
