// SPDX-License-Identifier: Apache-2.0
#include "core/texture/formula.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

namespace ovc {

namespace {

using Step = FormulaStep;
using StepKind = FormulaStep::Kind;

/// Returns how many numbers the step takes from the stack. It leaves one there.
size_t operands(const Step& step) {
    switch (step.kind) {
    case StepKind::Constant:
    case StepKind::Argument:
        return 0;
    case StepKind::Negate:
    case StepKind::Not:
        return 1;
    case StepKind::Select:
    case StepKind::Call:
    case StepKind::Internal:
        return step.count;
    case StepKind::Builtin:
        return size_t(std::abs(
            float_functions()[step.index].count == -1 ? 2 : float_functions()[step.index].count));
    case StepKind::Value:
    case StepKind::Color:
        return 3;
    default:
        return 2;
    }
}

bool is_sound(const Step& step, size_t routine, size_t textures) {
    switch (step.kind) {
    case StepKind::Select:
        return step.count == 3 || step.count == 4;
    case StepKind::Call:
        return step.index < routine && step.count <= kMaxFormulaStack;
    case StepKind::Builtin:
        return step.index < float_functions().size();
    case StepKind::Internal: {
        const InternalFunction function = internal_function(step.index);
        return function.call && step.count == uint32_t(function.count);
    }
    case StepKind::Value:
        return step.index < textures;
    case StepKind::Color:
        return step.index < textures && step.count < 6;
    default:
        return step.kind <= StepKind::Color;
    }
}

/// The most that a call of a routine needs.
struct Needs {
    double work = 0;
    size_t stack = 0;
};

/// The stack of one evaluation. Formulas are short, so that it seldom needs the heap.
struct Evaluation {
    std::span<const Texture> textures;
    const Formula& formula;

    double run(size_t routine, const double* arguments, size_t count, double* stack) const {
        const size_t first = routine == 0 ? 0 : formula.ends[routine - 1];
        for (size_t i = first; i < formula.ends[routine]; ++i) {
            const Step& step = formula.steps[i];
            stack -= operands(step);
            *stack = result(step, arguments, count, stack);
            ++stack;
        }
        return stack[-1];
    }

    double result(const Step& step, const double* arguments, size_t count, double* a) const {
        switch (step.kind) {
        case StepKind::Constant:
            return step.value;
        case StepKind::Argument:
            return step.index < count ? arguments[step.index] : 0;
        case StepKind::Negate:
            return -a[0];
        case StepKind::Not:
            return double(a[0] == 0);
        case StepKind::Add:
            return a[0] + a[1];
        case StepKind::Subtract:
            return a[0] - a[1];
        case StepKind::Multiply:
            return a[0] * a[1];
        case StepKind::Divide:
            return a[0] / a[1];
        case StepKind::Select:
            return a[0] < 0 ? a[1] : a[0] == 0 ? a[2] : a[step.count - 1];
        case StepKind::Call:
            return run(step.index, a, step.count, a + step.count);
        case StepKind::Builtin:
            return float_functions()[step.index].call(a);
        case StepKind::Internal:
            return internal_function(step.index).call({a, step.count});
        case StepKind::Value:
            return evaluate(textures, textures[step.index].pattern, {{a[0], a[1], a[2]}}).value;
        case StepKind::Color:
            return component(color_at(textures, step.index, {{a[0], a[1], a[2]}}), step.count);
        default:
            return double(compared(step.kind, a[0], a[1]));
        }
    }

    static bool compared(StepKind kind, double a, double b) {
        switch (kind) {
        case StepKind::Less:
            return a < b;
        case StepKind::Greater:
            return a > b;
        case StepKind::LessOrEqual:
            return a <= b;
        case StepKind::GreaterOrEqual:
            return a >= b;
        case StepKind::Equal:
            return a == b;
        case StepKind::NotEqual:
            return a != b;
        case StepKind::And:
            return a != 0 && b != 0;
        default:
            return a != 0 || b != 0;
        }
    }

    static double component(const TransparentColor& c, uint32_t number) {
        if (number == 5)
            return double(gray(c.rgb));
        return double(number < 3 ? c.rgb[int(number)] : number == 3 ? c.filter : c.transmit);
    }
};

/// Returns what each routine needs, or nothing where the formula is not sound.
std::vector<Needs> needs(const Formula& formula, size_t textures) {
    if (formula.ends.empty() || formula.ends.back() != formula.steps.size() ||
        !std::is_sorted(formula.ends.begin(), formula.ends.end()))
        return {};
    std::vector<Needs> all(formula.ends.size());
    size_t i = 0;
    for (size_t routine = 0; routine < all.size(); ++routine) {
        Needs& own = all[routine];
        size_t height = 0;
        for (; i < formula.ends[routine]; ++i) {
            const Step& step = formula.steps[i];
            if (!is_sound(step, routine, textures) || operands(step) > height)
                return {};
            const Needs called = step.kind == StepKind::Call ? all[step.index] : Needs{};
            own.work += 1 + called.work;
            own.stack = std::max(own.stack, height + called.stack);
            height = height - operands(step) + 1;
            own.stack = std::max(own.stack, height);
            if (own.stack > kMaxFormulaStack || own.work > kMaxFormulaWork)
                return {};
        }
        if (height != 1)
            return {};
    }
    return all;
}

} // namespace

double formula_work(const Formula& formula, size_t textures) {
    const std::vector<Needs> all = needs(formula, textures);
    return all.empty() ? 2 * kMaxFormulaWork : all.back().work;
}

double evaluate(std::span<const Texture> textures, const Formula& formula,
                std::span<const double> arguments) {
    assert(!formula.ends.empty());
    const Evaluation evaluation{textures, formula};
    constexpr size_t kSmall = 256; // steps of a formula that never needs more than this
    if (formula.steps.size() < kSmall) {
        double stack[kSmall];
        return evaluation.run(formula.ends.size() - 1, arguments.data(), arguments.size(), stack);
    }
    const auto stack = std::make_unique_for_overwrite<double[]>(kMaxFormulaStack);
    return evaluation.run(formula.ends.size() - 1, arguments.data(), arguments.size(), stack.get());
}

} // namespace ovc
