// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/values/program.h"

#include <algorithm>

namespace ovc::pov {

using StepKind = FormulaStep::Kind;

void move_textures(Formula& formula, std::span<const uint32_t> places) {
    for (FormulaStep& step : formula.steps)
        if (step.kind >= StepKind::Value)
            step.index = places[step.index];
}

void ProgramBuilder::add(StepKind kind, uint32_t index, uint32_t count, double value) {
    own_.push_back({kind, index, count, value});
}

/// A program that calls another one twice has one copy of its routines.
const ProgramBuilder::Copied& ProgramBuilder::copied(const ProgramPtr& other) {
    const auto known = std::find_if(copies_.begin(), copies_.end(),
                                    [&](const Copied& copy) { return copy.other == other; });
    if (known != copies_.end())
        return *known;
    std::vector<uint32_t> places = copy_textures(other->textures, [&](ovc::Texture texture) {
        program_.textures.push_back(std::move(texture));
        return uint32_t(program_.textures.size() - 1);
    });
    if (!other->owners.empty())
        program_.owners.push_back(other);
    Formula added = other->formula;
    move_textures(added, places);
    Formula& all = program_.formula;
    const auto routines = uint32_t(all.ends.size()), steps = uint32_t(all.steps.size());
    for (FormulaStep& step : added.steps)
        if (step.kind == StepKind::Call)
            step.index += routines;
    all.steps.insert(all.steps.end(), added.steps.begin(), added.steps.end());
    for (const uint32_t end : added.ends)
        all.ends.push_back(end + steps);
    return copies_.emplace_back(
        Copied{other, all.ends.empty() ? 0 : uint32_t(all.ends.size() - 1), std::move(places)});
}

void ProgramBuilder::call(const ProgramPtr& other, uint32_t count) {
    const uint32_t routine = copied(other).routine;
    add(StepKind::Call, routine, count);
}

void ProgramBuilder::texture(StepKind kind, const ProgramPtr& other, uint32_t component) {
    const uint32_t last = copied(other).textures.back();
    add(kind, last, component);
}

ProgramPtr ProgramBuilder::take() {
    Formula& all = program_.formula;
    all.steps.insert(all.steps.end(), own_.begin(), own_.end());
    all.ends.push_back(uint32_t(all.steps.size()));
    constexpr size_t kMaxSteps = 200'000; // programs that contain each other might double for ever
    if (all.steps.size() > kMaxSteps || program_.textures.size() > kMaxSteps ||
        formula_work(all, program_.textures.size()) > kMaxFormulaWork)
        return nullptr;
    return std::make_shared<const FormulaProgram>(std::move(program_));
}

} // namespace ovc::pov
