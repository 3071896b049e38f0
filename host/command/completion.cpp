// SPDX-License-Identifier: Apache-2.0
// Shell completion scripts. They offer what may come next by the subcommand and the word before.
// Sources: the manuals of bash 5.2 ("Programmable Completion"), zsh 5.9 (zshcompsys) and fish 3.6
// (complete).
#include "host/command/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace ovc {

using Manuals = std::vector<CommandManual>;

static std::string joined(const std::vector<std::string>& words, const char* between = " ") {
    return fmt::format("{}", fmt::join(words, between));
}

static std::vector<std::string> command_names(const Manuals& manual) {
    std::vector<std::string> names;
    for (const CommandManual& command : manual)
        names.push_back(command.name);
    return names;
}

static std::vector<std::string> option_names(const CommandManual& command) {
    std::vector<std::string> names;
    for (const OptionManual& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

/// Returns the text before the first semicolon or colon, which is enough in a list of choices.
static std::string gist(const std::string& description) {
    return description.substr(0, description.find_first_of(";:"));
}

/// Puts the text in single quotes, which all three shells understand.
static std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// ---- bash

/// Returns the shell command that adds the values of an option to COMPREPLY.
static std::string bash_values(const OptionManual& option) {
    switch (option.kind) {
    case ValueKind::Choice:
        return fmt::format("_overcast_words \"{}\"", joined(option.choices));
    case ValueKind::Scene:
        return fmt::format("_overcast_words \"{}\"; _overcast_files -f", joined(scene_names()));
    case ValueKind::File:
        return "_overcast_files -f";
    case ValueKind::Folder:
        return "_overcast_files -d";
    case ValueKind::None:
    case ValueKind::Other:
        break;
    }
    return ":"; // a number, say: nothing to offer
}

static std::string bash_of(const CommandManual& command) {
    std::string text = fmt::format("    {})\n        case $last in\n", command.name);
    for (const OptionManual& option : command.options)
        if (option.kind != ValueKind::None)
            text += fmt::format("        {}) {}; return ;;\n", joined(option.names, "|"),
                                bash_values(option));
    text += "        esac\n        if [[ $word == -* ]]; then\n";
    text += fmt::format("            _overcast_words \"{}\"\n", joined(option_names(command)));
    if (!command.places.empty()) // the script does not count places, and offers the last one's
        text += fmt::format("        else\n            {}\n", bash_values(command.places.back()));
    return text + "        fi ;;\n";
}

std::string bash_completion(const Manuals& manual) {
    std::string text = R"(# Completion of overcast for bash, made by: overcast completion bash
_overcast_words() {
    local found
    mapfile -t found < <(compgen -W "$1" -- "$word")
    COMPREPLY+=("${found[@]}")
}
_overcast_files() {
    local found
    mapfile -t found < <(compgen "$1" -- "$word")
    COMPREPLY+=("${found[@]}")
}
_overcast() {
    local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]}
    COMPREPLY=()
    # --option=value is three words here.
    if [[ $word == "=" ]]; then
        word=""
    elif [[ $last == "=" ]]; then
        last=${COMP_WORDS[COMP_CWORD-2]}
    fi
    if [[ $COMP_CWORD -eq 1 ]]; then
)";
    text += fmt::format("        _overcast_words \"{} help --help --version\"\n        return\n"
                        "    fi\n    case ${{COMP_WORDS[1]}} in\n",
                        joined(command_names(manual)));
    for (const CommandManual& command : manual)
        text += bash_of(command);
    text += fmt::format("    help) _overcast_words \"{}\" ;;\n", joined(command_names(manual)));
    return text + "    esac\n}\ncomplete -o filenames -F _overcast overcast\n";
}

// ---- zsh

static std::string zsh_values(const OptionManual& option) {
    switch (option.kind) {
    case ValueKind::Choice:
        return fmt::format("({})", joined(option.choices));
    case ValueKind::Scene:
        return "_overcast_scenes";
    case ValueKind::File:
        return "_files";
    case ValueKind::Folder:
        return "_files -/";
    case ValueKind::None:
    case ValueKind::Other:
        break;
    }
    return " "; // a value follows, but there is nothing to offer
}

/// Returns a specification for zsh's _arguments for each name of the option.
static std::string zsh_option(const OptionManual& option) {
    std::string what; // brackets are escaped, since they would end it
    for (const char c : gist(option.description))
        what += c == '[' || c == ']' ? fmt::format("\\{}", c) : std::string(1, c);
    std::string text;
    for (const std::string& name : option.names) {
        const bool takes_value = option.kind != ValueKind::None;
        // With either joint, zsh also takes the value after a blank.
        const char* joint = !takes_value ? "" : name.starts_with("--") ? "=" : "+";
        std::string spec = fmt::format("*{}{}[{}]", name, joint, what);
        if (takes_value)
            spec += fmt::format(":{}:{}", gist(option.value), zsh_values(option));
        text += fmt::format(" \\\n        {}", shell_quoted(spec));
    }
    return text;
}

static std::string zsh_of(const CommandManual& command) {
    std::string text = fmt::format("    {})\n        _arguments -s", command.name);
    for (const OptionManual& option : command.options)
        text += zsh_option(option);
    for (const OptionManual& place : command.places)
        text += fmt::format(" \\\n        {}",
                            shell_quoted(fmt::format("{}:{}:{}", place.repeats ? "*" : "",
                                                     gist(place.names[0]), zsh_values(place))));
    return text + " ;;\n";
}

std::string zsh_completion(const Manuals& manual) {
    std::string text = R"(#compdef overcast
# Completion of overcast for zsh, made by: overcast completion zsh
_overcast_scenes() {
    local -a scenes
)";
    text += fmt::format("    scenes=({})\n", joined(scene_names()));
    text += "    _alternative 'scenes:test scene:($scenes)' 'files:file:_files'\n}\n"
            "_overcast() {\n    local -a commands\n    commands=(\n";
    for (const CommandManual& command : manual)
        text += fmt::format("        {}\n", shell_quoted(command.name + ":" + command.summary));
    text += R"(    )
    if (( CURRENT == 2 )); then
        _describe command commands
        return
    fi
    shift words
    (( CURRENT-- ))
    case $words[1] in
)";
    for (const CommandManual& command : manual)
        text += zsh_of(command);
    // zsh runs a file that it autoloads from $fpath as the function's body, and one that the user
    // sources as commands.
    return text + R"(    esac
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    _overcast "$@"
else
    (( $+functions[compdef] )) || { autoload -Uz compinit && compinit -D -i }
    compdef _overcast overcast
fi
)";
}

// ---- fish

static std::string fish_values(const OptionManual& option) {
    switch (option.kind) {
    case ValueKind::Choice:
        return fmt::format(" -x -a {}", shell_quoted(joined(option.choices)));
    case ValueKind::Scene:
    case ValueKind::File:
        return " -r -F";
    case ValueKind::Folder:
        return " -x -a '(__fish_complete_directories)'";
    case ValueKind::Other:
        return " -x";
    case ValueKind::None:
        break;
    }
    return " -f";
}

static std::string fish_of(const CommandManual& command) {
    const std::string when =
        fmt::format("complete -c overcast -n '__fish_seen_subcommand_from {}'", command.name);
    std::string text;
    for (const OptionManual& option : command.options) {
        text += when;
        for (const std::string& name : option.names)
            text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        text += fish_values(option) + " -d " + shell_quoted(gist(option.description)) + "\n";
    }
    for (const OptionManual& place : command.places) {
        if (place.kind == ValueKind::Scene)
            text += fmt::format("{} -F -a {} -d 'test scene'\n", when,
                                shell_quoted(joined(scene_names())));
        else if (place.kind == ValueKind::File)
            text += when + " -F\n";
        else if (place.kind == ValueKind::Choice)
            text += fmt::format("{} -f -a {}\n", when, shell_quoted(joined(place.choices)));
    }
    return text;
}

std::string fish_completion(const Manuals& manual) {
    std::string text = "# Completion of overcast for fish, made by: overcast completion fish\n"
                       "complete -c overcast -f\n";
    for (const CommandManual& command : manual)
        text += fmt::format("complete -c overcast -n __fish_use_subcommand -a {} -d {}\n",
                            command.name, shell_quoted(command.summary));
    for (const CommandManual& command : manual)
        text += fish_of(command);
    return text;
}

} // namespace ovc
