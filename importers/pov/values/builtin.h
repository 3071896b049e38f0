// SPDX-License-Identifier: Apache-2.0
// The functions and constants of the scene language.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// `sin(1)` after the word `sin`, `pi`, `x`; nothing where the word is none of them. Texts as
/// arguments included.
using Builtin = Number (*)(Reader&, const Token&);
Builtin find_builtin(std::string_view word);

/// A function of floats that a function { } may call too; count: of its arguments.
struct FloatFunction {
    int count;
    double (*call)(const double* arguments);
};
const FloatFunction* find_float_function(std::string_view word);

/// `concat("a", "b")` after the word; nothing where the word is no such function.
using TextFunction = std::string (*)(Reader&);
TextFunction find_text_function(std::string_view word);

} // namespace ovc::pov
