// SPDX-License-Identifier: Apache-2.0
// The functions and constants of the scene language.
#pragma once

#include "core/texture/formula.h"
#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Returns the function that reads the rest of `sin(1)`, `strlen("a")`, `pi` or `x` after the word,
/// which it gets as a token. Returns null for a word that stands for no number.
using Builtin = Number (*)(Reader&, const Token&);
Builtin find_builtin(std::string_view word);

/// Finds a function of floats, which a function { } may call too. Returns null where the word is no
/// such function.
const FloatFunction* find_float_function(std::string_view word);

/// Returns the function that reads the rest of `concat("a", "b")` after the word, or null where the
/// word is no function that gives a text.
using TextFunction = std::string (*)(Reader&);
TextFunction find_text_function(std::string_view word);

} // namespace ovc::pov
