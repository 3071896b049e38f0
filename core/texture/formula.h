// SPDX-License-Identifier: Apache-2.0
// Formula: a function of numbers as a list of steps, which a scene holds and its file keeps.
// POV-Ray's `function { }` becomes one.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace ovc {

struct Texture;

/// A step takes its operands from a stack of numbers and leaves its result there.
struct FormulaStep {
    enum class Kind : uint32_t {
        Constant, // value
        Argument, // the routine's argument `index`, 0 where it is missing
        Negate,
        Not,
        Add,
        Subtract,
        Multiply,
        Divide,
        Less,
        Greater,
        LessOrEqual,
        GreaterOrEqual,
        Equal,
        NotEqual,
        And,
        Or,
        Select,   // by the sign of the first of `count` numbers, 3 or 4, one of the others
        Call,     // routine `index` of `count` numbers
        Builtin,  // float_functions()[index]
        Internal, // internal_function(index) of `count` numbers
        Value,    // the pattern's value of Scene::textures[index] at the point of three numbers
        Color,    // red, green, blue, filter, transmit or gray, by `count`, of a texture there
    };
    Kind kind = Kind::Constant;
    uint32_t index = 0;
    uint32_t count = 0;
    double value = 0;

    bool operator==(const FormulaStep&) const = default;
};

/// Routines one after another. Each calls only earlier ones; the last is the formula itself.
struct Formula {
    std::vector<FormulaStep> steps;
    std::vector<uint32_t> ends; // of each routine, into `steps`

    bool operator==(const Formula&) const = default;
};

/// The max numbers that a formula may have on its stack, and the max steps that one call may take.
inline constexpr size_t kMaxFormulaStack = 4096;
inline constexpr double kMaxFormulaWork = 1e6;

/// Returns how many steps a call takes, above kMaxFormulaWork where the formula must not be
/// evaluated: where a step is no step, its operands are missing or its textures are not below
/// `textures`.
double formula_work(const Formula& formula, size_t textures);

/// Returns the formula's value. textures: of the scene. The formula is sound (formula_work).
double evaluate(std::span<const Texture> textures, const Formula& formula,
                std::span<const double> arguments);

/// A function of floats that has a name in POV-Ray's language. Those of any number of arguments
/// (count -1) take two at a time.
struct FloatFunction {
    std::string_view name;
    int count;
    double (*call)(const double* arguments);
};

/// Returns all of them, ordered by name.
std::span<const FloatFunction> float_functions();

/// A function that POV-Ray's functions.inc takes from POV-Ray itself by its number.
struct InternalFunction {
    int count = 0;                                     // of arguments, at most 16
    double (*call)(std::span<const double>) = nullptr; // null where Overcast does not know it
};
InternalFunction internal_function(uint32_t number);

} // namespace ovc
