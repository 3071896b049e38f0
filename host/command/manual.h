// SPDX-License-Identifier: Apache-2.0
// The manual: what every subcommand takes, as the command line itself knows it. Shell completion
// and the man page are written from it, and so are never older than the program.
#pragma once

#include <string>
#include <vector>

namespace ovc {

/// What may follow an option, or stand in a place.
enum class ValueKind { None, Choice, File, Folder, Scene, Other };

struct OptionManual {
    std::vector<std::string> names; // "-o", "--output"; of a place its one name, "SCENE"
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
    std::vector<OptionManual> places; // arguments without a name, in their order
    std::vector<OptionManual> options;
    std::string footer;
};

/// Of every subcommand, in the order of the help.
std::vector<CommandManual> manual();

/// Names of test scenes; of a numbered one what stands before its number.
std::vector<std::string> scene_names();

/// A script that completes the words of `overcast` in that shell.
std::string bash_completion(const std::vector<CommandManual>& manual);
std::string zsh_completion(const std::vector<CommandManual>& manual);
std::string fish_completion(const std::vector<CommandManual>& manual);

/// overcast.1, in roff with the man macros.
std::string man_page(const std::vector<CommandManual>& manual);

} // namespace ovc
