// SPDX-License-Identifier: Apache-2.0
// Reads and calls function { }: a formula of floats, a transform or a spline.
#pragma once

#include "importers/pov/values/expression.h"

#include <span>

namespace ovc::pov {

/// A formula ready to be computed. It may throw ParseError where it calls a function that Overcast
/// does not compute. Arguments that are missing count as 0.
using Formula = std::function<double(std::span<const double>)>;

/// Exactly one of formula, transform, spline and refused is set.
struct Function {
    size_t parameters = 3;
    Formula formula;
    std::optional<dmat4> transform;
    std::shared_ptr<const Spline> spline;
    uint32_t depth = 1;  // of nested closures
    dvec2 grid{0};       // WIDTH, HEIGHT of function WIDTH, HEIGHT { }
    std::string refused; // the reason why it cannot be called
};

/// Reads `(a, b) { formula }` from behind the word `function`.
std::shared_ptr<const Function> parse_function(Reader& reader);

/// Returns the function's value, a vector for a transform. `name` is the token that calls it, for
/// messages. Throws ParseError for a function that cannot be called or a scene that takes too long.
Number call(Reader& reader, const Token& name, const Function& function,
            std::span<const double> arguments);

} // namespace ovc::pov
