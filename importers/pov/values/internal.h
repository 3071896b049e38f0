// SPDX-License-Identifier: Apache-2.0
// The functions that functions.inc takes from POV-Ray itself: internal(60) is f_rounded_box.
#pragma once

#include <span>

namespace ovc::pov {

/// The arguments are x, y, z and then the function's parameters.
using InternalFunction = double (*)(std::span<const double>);

struct Internal {
    InternalFunction call = nullptr; // null where Overcast does not know the function
    int count = 0;                   // of arguments, at most 8
};

/// Finds a function by its number in functions.inc. Overcast knows some that compute a distance, a
/// direction or a simple body.
Internal find_internal(int number);

} // namespace ovc::pov
