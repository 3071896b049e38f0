// SPDX-License-Identifier: Apache-2.0
// function { }: float functions of floats, and transforms and splines called as functions.
#pragma once

#include "importers/pov/values/expression.h"

#include <span>

namespace ovc::pov {

/// A formula made ready; may throw ParseError where it calls what Overcast cannot.
using Formula = std::function<double(std::span<const double>)>;

struct Function {
    size_t parameters = 3;
    Formula formula;                      // or
    std::optional<dmat4> transform;       // or
    std::shared_ptr<const Spline> spline; // or
    uint32_t depth = 1;                   // of closures in each other
    dvec2 grid{0};                        // WIDTH, HEIGHT of function WIDTH, HEIGHT { }
    std::string refused;                  // why it cannot be called
};

/// Behind the word `function`: `(a, b) { formula }`.
std::shared_ptr<const Function> parse_function(Reader& reader);

/// name: the token that calls it, for messages.
Number call(Reader& reader, const Token& name, const Function& function,
            std::span<const double> arguments);

} // namespace ovc::pov
