// SPDX-License-Identifier: Apache-2.0
// Reads the manual from each subcommand's CLI11 app, which is built for this and never parsed.
#include "host/command/manual.h"

#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

/// Splits a type name such as "auto|fragment|compute"; empty where it lists no choices.
static std::vector<std::string> choices_of(const std::string& value) {
    std::vector<std::string> choices;
    for (size_t at = 0; value.find('|') != std::string::npos && at <= value.size();) {
        const size_t end = std::min(value.find('|', at), value.size());
        choices.push_back(value.substr(at, end - at));
        at = end + 1;
    }
    const bool words = std::none_of(choices.begin(), choices.end(), [](const std::string& choice) {
        return choice.empty() || (choice[0] >= 'A' && choice[0] <= 'Z'); // as in FILE|-
    });
    return words ? choices : std::vector<std::string>();
}

static ValueKind kind_of(const OptionManual& option) {
    if (option.value.empty())
        return ValueKind::None;
    if (!option.choices.empty())
        return ValueKind::Choice;
    if (option.value.starts_with("FILE") || option.value == "A" || option.value == "B" ||
        option.value == "OUT")
        return ValueKind::File;
    if (option.value == "SCENE" || option.value == "IN")
        return ValueKind::Scene;
    return option.value == "DIR" ? ValueKind::Folder : ValueKind::Other;
}

static OptionManual manual_of(const CLI::Option& option) {
    OptionManual manual;
    for (const std::string& name : option.get_snames())
        manual.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        manual.names.push_back("--" + name);
    const bool has_place = manual.names.empty();
    if (has_place)
        manual.names = {option.get_name()};
    if (option.get_items_expected_max() > 0) {
        // CLI11 calls a place without a type TEXT.
        const std::string type = option.get_type_name();
        manual.choices = choices_of(type);
        manual.value = has_place && manual.choices.empty() ? manual.names[0] : type;
        manual.repeats = has_place && option.get_items_expected_max() > 1;
    }
    manual.description = option.get_description();
    manual.kind = kind_of(manual);
    return manual;
}

static CommandManual manual_of(const Command& command) {
    const std::unique_ptr<Subcommand> subcommand = command.make();
    CLI::App app;
    subcommand->add_to(app);
    CommandManual manual{
        std::string(command.name), std::string(command.summary), app.get_description(), {}, {},
        app.get_footer()};
    for (const CLI::Option* option : app.get_options())
        (option->get_positional() ? manual.places : manual.options).push_back(manual_of(*option));
    return manual;
}

std::vector<CommandManual> manual() {
    std::vector<CommandManual> all;
    for (const Command& command : commands())
        all.push_back(manual_of(command));
    return all;
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const CatalogEntry& entry : catalog()) {
        const bool is_numbered = entry.name.ends_with("-N");
        names.emplace_back(entry.name.substr(0, entry.name.size() - (is_numbered ? 1 : 0)));
    }
    return names;
}

} // namespace ovc
