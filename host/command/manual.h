// SPDX-License-Identifier: Apache-2.0
// The manual lists what every subcommand takes, as its CLI11 app knows it. Shell completion and the
// man page are generated from it, so they always fit the program.
#pragma once

#include <string>
#include <vector>

namespace ovc {

/// The kind of value that an option or a place takes; a place is an argument without a name.
enum class ValueKind { None, Choice, File, Folder, Scene, Other };

struct OptionManual {
    std::vector<std::string> names; // "-o", "--output"; a place has one, "SCENE"
    std::string value;              // "FILE"; empty: none
    ValueKind kind = ValueKind::None;
    std::vector<std::string> choices;
    std::string description;
    bool repeats = false; // a place that takes any number
};

struct CommandManual {
    std::string name;
    std::string summary;
    std::string description;
    std::vector<OptionManual> places; // in their order
    std::vector<OptionManual> options;
    std::string footer;
};

/// Returns the manual of every subcommand, in the order of the help.
std::vector<CommandManual> manual();

/// Returns the names of the test scenes; a numbered one, "dragons-N", is cut to "dragons-".
std::vector<std::string> scene_names();

/// Each returns a script by which its shell completes the arguments of `overcast`.
std::string bash_completion(const std::vector<CommandManual>& manual);
std::string zsh_completion(const std::vector<CommandManual>& manual);
std::string fish_completion(const std::vector<CommandManual>& manual);

/// Returns overcast.1, in roff with the man macros.
std::string man_page(const std::vector<CommandManual>& manual);

} // namespace ovc
