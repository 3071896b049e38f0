// SPDX-License-Identifier: Apache-2.0
#include "core/texture/formula.h"

#include "core/texture/texture.h"

#include <gtest/gtest.h>

#include <array>

namespace ovc {

namespace {

using StepKind = FormulaStep::Kind;

double value_of(std::vector<FormulaStep> steps, std::span<const double> arguments = {}) {
    const auto end = uint32_t(steps.size());
    const Formula formula{std::move(steps), {end}};
    EXPECT_LE(formula_work(formula, 0), kMaxFormulaWork);
    return evaluate({}, formula, arguments);
}

FormulaStep constant(double value) {
    return {StepKind::Constant, 0, 0, value};
}

uint32_t number_of(std::string_view name) {
    uint32_t number = 0;
    while (float_functions()[number].name != name)
        ++number;
    return number;
}

} // namespace

TEST(Formula, TakesOperandsFromItsStack) {
    EXPECT_EQ(value_of({constant(7), constant(2), {StepKind::Subtract}}), 5);
    EXPECT_EQ(value_of({constant(7), constant(2), {StepKind::Less}}), 0);
    EXPECT_EQ(value_of({constant(3),
                        {StepKind::Negate},
                        constant(8),
                        constant(9),
                        constant(10),
                        {StepKind::Select, 0, 4}}),
              8);
    EXPECT_EQ(value_of({{StepKind::Argument, 1}, {StepKind::Argument, 2}, {StepKind::Add}},
                       std::array{1.0, 2.0}),
              2); // an argument that is missing is 0
    EXPECT_EQ(value_of({constant(2), constant(5), {StepKind::Builtin, number_of("pow")}}), 32);
}

TEST(Formula, CallsEarlierRoutines) {
    // square(x) = x * x; square(3) + square(4)
    const Formula formula{{{StepKind::Argument},
                           {StepKind::Argument},
                           {StepKind::Multiply},
                           constant(3),
                           {StepKind::Call, 0, 1},
                           constant(4),
                           {StepKind::Call, 0, 1},
                           {StepKind::Add}},
                          {3, 8}};
    EXPECT_EQ(formula_work(formula, 0), 11);
    EXPECT_EQ(evaluate({}, formula, {}), 25);
}

TEST(Formula, AsksTextures) {
    Texture along_x{{.kind = Pattern::Kind::Gradient, .parameters = {1}},
                    {{0, {vec3(0)}}, {1, {vec3(1, 2, 3)}}}};
    const std::vector<Texture> textures{along_x};
    for (const auto& [step, expected] :
         {std::pair{FormulaStep{StepKind::Value}, 0.5},
          {{StepKind::Color, 0, 1}, 1.0},
          {{StepKind::Color, 0, 5}, 0.5 * (0.297 + 2 * 0.589 + 3 * 0.114)}}) {
        const Formula formula{{constant(0.5), constant(0), constant(0), step}, {4}};
        EXPECT_NEAR(evaluate(textures, formula, {}), expected, 1e-6);
        EXPECT_GT(formula_work(formula, 0), kMaxFormulaWork); // there is no such texture
    }
}

TEST(Formula, IsRefusedWhereItCannotBeEvaluated) {
    const Formula kBad[] = {
        {},                                            // no routine
        {{constant(1)}, {2}},                          // ends behind its steps
        {{{StepKind::Add}}, {1}},                      // no operands
        {{constant(1), constant(2)}, {2}},             // two results
        {{{StepKind::Call, 0, 0}}, {1}},               // calls itself
        {{constant(1), {StepKind::Builtin, 999}}, {2}} // no such function
    };
    for (const Formula& formula : kBad)
        EXPECT_GT(formula_work(formula, 0), kMaxFormulaWork);
    // Forty routines that each call the one before twice.
    Formula doubling{{constant(1)}, {1}};
    for (uint32_t i = 0; i < 40; ++i) {
        for (const FormulaStep& step :
             {FormulaStep{StepKind::Call, i, 0}, FormulaStep{StepKind::Call, i, 0},
              FormulaStep{StepKind::Add}})
            doubling.steps.push_back(step);
        doubling.ends.push_back(uint32_t(doubling.steps.size()));
    }
    EXPECT_GT(formula_work(doubling, 0), kMaxFormulaWork);
}

} // namespace ovc
