// SPDX-License-Identifier: Apache-2.0
// The interpreter's directives of transforms and coordinate systems.
#include "importers/pbrt/interpret/interpreter.h"

#include "importers/file/text.h"

#include <fmt/format.h>

namespace ovc::pbrt {

bool Interpreter::identity() {
    state_.now.transforms.set(dmat4(1));
    return true;
}

bool Interpreter::translate() {
    double v[3];
    if (!read_numbers(3, v))
        return false;
    state_.now.transforms.multiply(translation({v[0], v[1], v[2]}));
    return true;
}

bool Interpreter::scale() {
    double v[3];
    if (!read_numbers(3, v))
        return false;
    state_.now.transforms.multiply(scaling({v[0], v[1], v[2]}));
    return true;
}

bool Interpreter::rotate() {
    double v[4];
    if (!read_numbers(4, v))
        return false;
    state_.now.transforms.multiply(rotation(v[0], {v[1], v[2], v[3]}));
    return true;
}

bool Interpreter::look_at() {
    double v[9];
    if (!read_numbers(9, v))
        return false;
    dmat4 view(1);
    if (!pbrt::look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, view))
        diagnostics_.missing("LookAt", place_,
                             "a LookAt left out: its eye, target and up make no view");
    else
        state_.now.transforms.multiply(view);
    return true;
}

bool Interpreter::set_transform() {
    double v[16];
    if (!read_numbers(16, v))
        return false;
    state_.now.transforms.set(from_file(v));
    return true;
}

bool Interpreter::concatenate() {
    double v[16];
    if (!read_numbers(16, v))
        return false;
    state_.now.transforms.multiply(from_file(v));
    return true;
}

bool Interpreter::active_transform() {
    if (!tokens_.next())
        return false;
    const std::string& which = tokens_.token().text;
    const bool is_word =
        tokens_.token().kind == TokenKind::Word || tokens_.token().kind == TokenKind::Text;
    if (!is_word || (which != "All" && which != "StartTime" && which != "EndTime"))
        return diagnostics_.fail(place_, fmt::format("found {}, expected All, StartTime or EndTime",
                                                     described(tokens_.token())));
    state_.now.transforms.active = {which != "EndTime", which != "StartTime"};
    return true;
}

bool Interpreter::coordinate_system() {
    std::string name;
    if (!read_text(name))
        return false;
    systems_[name] = state_.now.transforms;
    return true;
}

bool Interpreter::coord_sys_transform() {
    std::string name;
    if (!read_text(name))
        return false;
    const auto at = systems_.find(name);
    if (at != systems_.end())
        state_.now.transforms.at = at->second.at;
    else
        diagnostics_.missing("coordinate system " + name, place_,
                             fmt::format("there is no coordinate system {}", ovc::quoted(name)));
    return true;
}

} // namespace ovc::pbrt
