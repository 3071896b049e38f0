// SPDX-License-Identifier: Apache-2.0
// Reads and calls function { }: a formula of floats, a transform or a spline.
#pragma once

#include "importers/pov/values/expression.h"

#include <span>

namespace ovc::pov {

/// Reads `(a, b) { formula }` from behind the word `function`. usual: the names of the parameters
/// where none are given.
Function parse_function(Reader& reader, std::vector<std::string> usual = {"x", "y", "z"});

/// Returns the function's value, a vector for a transform. `name` is the token that calls it, for
/// messages. Throws ParseError for a function that cannot be called or a scene that takes too long.
Number call(Reader& reader, const Token& name, const Function& function,
            std::span<const double> arguments);

} // namespace ovc::pov
