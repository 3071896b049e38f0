// SPDX-License-Identifier: Apache-2.0
// Parsing of subcommand arguments and of the values they take.
#include "host/arguments/arguments.h"

#include "core/text/suggestion.h"
#include "host/camera/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

namespace ovc {

static Error unknown_option(const CLI::App& app, const std::string& word) {
    const std::string option = word.substr(0, word.find('='));
    if (word[0] != '-')
        return {fmt::format("'{}' is one argument too many for {}; see {} --help", word,
                            app.get_name(), app.get_name())};
    std::vector<std::string> names;
    for (const CLI::Option* known : app.get_options())
        for (const std::string& name : known->get_lnames())
            names.push_back("--" + name);
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    return {fmt::format("there is no option '{}'{}", option, did_you_mean(option, candidates))};
}

/// Wraps the help at 100 columns, descriptions from the 30th on; a terminal would break words.
class HelpFormatter final : public CLI::Formatter {
    static constexpr size_t kColumns = 70;

    static std::string wrapped(std::string_view text, size_t columns) {
        std::string lines;
        while (text.size() > columns) {
            const size_t blank = text.rfind(' ', columns);
            const size_t end = blank == text.npos ? std::min(text.find(' '), text.size()) : blank;
            lines.append(text.substr(0, end)).append("\n");
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return lines.append(text);
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        return wrapped(option->get_description(), kColumns);
    }
    std::string make_description(const CLI::App* app) const override {
        return wrapped(app->get_description(), kColumns + 30) + "\n";
    }
};

/// Says CLI11's "--size: 1 required WxH missing" and the like in our words.
static Error wrong_number_of_values(std::string_view message) {
    const std::string_view option = message.substr(0, message.find(':'));
    const bool missing = message.find("missing") != std::string_view::npos;
    return {fmt::format("{} {}", option, missing ? "needs a value" : "is given more than once")};
}

/// Returns the word to blame. An unknown option leaves its value over as well, so we prefer the
/// option.
static std::string culprit(const std::vector<std::string>& left_over) {
    const auto option = std::find_if(left_over.begin(), left_over.end(),
                                     [](const std::string& word) { return word[0] == '-'; });
    return option == left_over.end() ? left_over.front() : *option;
}

/// Refuses --quiet=maybe, which CLI11 would convert, and --stats=, for which it would take the next
/// word.
static Result<Done> check_joined_values(const CLI::App& app,
                                        const std::vector<std::string>& arguments) {
    for (const std::string& word : arguments) {
        const size_t equals = word.find('=');
        if (!word.starts_with("--") || equals == std::string::npos)
            continue;
        const std::string name = word.substr(0, equals);
        const CLI::Option* option = app.get_option_no_throw(name);
        if (!option)
            continue; // unknown_option() has a sentence for it
        if (option->get_items_expected_max() == 0)
            return Error{fmt::format("{} takes no value, and was given '{}'", name,
                                     word.substr(equals + 1))};
        if (equals + 1 == word.size())
            return Error{fmt::format("{} needs a value that is not empty", name)};
    }
    return Done{};
}

/// A shell makes an empty word of a variable that is not set; the user did not mean "default".
static Result<Done> check_empty_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty())
                return Error{fmt::format("{} needs a value that is not empty", option->get_name())};
    return Done{};
}

Result<Parsed> parse_arguments(CLI::App& app, std::vector<std::string> arguments) {
    if (const Result<Done> fine = check_joined_values(app, arguments); !fine)
        return fine.error();
    std::reverse(arguments.begin(), arguments.end()); // CLI11 takes the last word first
    try {
        app.parse(arguments);
        const Result<Done> fine = check_empty_values(app);
        return fine ? Result<Parsed>(Parsed::Run) : fine.error();
    } catch (const CLI::CallForHelp&) {
        app.formatter(std::make_shared<HelpFormatter>());
        fmt::print("{}\n", app.help());
        return Parsed::HelpShown;
    } catch (const CLI::ArgumentMismatch& error) {
        return wrong_number_of_values(error.what());
    } catch (const CLI::ExcludesError& error) {
        // "--leaves excludes --leaf-triangles"
        const std::string_view text = error.what();
        return Error{fmt::format("{} and {} cannot be given together",
                                 text.substr(0, text.find(' ')), text.substr(text.rfind(' ') + 1))};
    } catch (const CLI::ConversionError&) {
        return Error{fmt::format("a value cannot be understood; see {} --help", app.get_name())};
    } catch (const CLI::ParseError& error) {
        std::vector<std::string> left_over = app.remaining();
        std::erase(left_over, std::string());
        if (!left_over.empty())
            return unknown_option(app, culprit(left_over));
        return Error{fmt::format("{}; see {} --help", error.what(), app.get_name())};
    }
}

Result<uint64_t> parse_count(std::string_view option, std::string_view text, uint64_t min,
                             uint64_t max) {
    uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || stop != end || value < min || value > max)
        return Error{
            fmt::format("{} needs a whole number from {} to {}, not '{}'", option, min, max, text)};
    return value;
}

Result<double> parse_real(std::string_view option, std::string_view text, double min, double max) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || stop != end || !(value >= min && value <= max))
        return Error{
            fmt::format("{} needs a number from {} to {}, not '{}'", option, min, max, text)};
    return value;
}

Result<size_t> parse_choice(std::string_view option, std::string_view text,
                            std::span<const std::string_view> names) {
    assert(!names.empty());
    const auto known = text.empty() ? names.begin() : std::find(names.begin(), names.end(), text);
    if (known != names.end())
        return size_t(known - names.begin());
    return Error{fmt::format("{}: '{}' is none of {}{}", option, text, fmt::join(names, ", "),
                             did_you_mean(text, names))};
}

std::string choice_names(std::span<const std::string_view> names) {
    return fmt::format("{}", fmt::join(names, "|"));
}

Result<ImageSize> parse_size(std::string_view option, std::string_view text) {
    const size_t cross = text.find_first_of("xX");
    if (cross == std::string_view::npos)
        return Error{fmt::format("{} needs WIDTHxHEIGHT, such as 640x480, not '{}'", option, text)};
    const Result<uint64_t> width =
        parse_count(fmt::format("the width in {}", option), text.substr(0, cross), 1, 65535);
    if (!width)
        return width.error();
    const Result<uint64_t> height =
        parse_count(fmt::format("the height in {}", option), text.substr(cross + 1), 1, 65535);
    if (!height)
        return height.error();
    return ImageSize{uint32_t(*width), uint32_t(*height)};
}

/// Returns the finite numbers between commas, each with or without blanks and POV-Ray's < and >
/// around it; empty where one of them is no finite number.
static std::vector<double> parse_reals(std::string_view text) {
    std::vector<double> values;
    for (size_t at = 0; at <= text.size();) {
        const size_t comma = std::min(text.find(',', at), text.size());
        std::string_view word = text.substr(at, comma - at);
        word.remove_prefix(std::min(word.find_first_not_of(" <"), word.size()));
        word = word.substr(0, word.find_last_not_of(" >") + 1);
        double value = 0;
        const auto [stop, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (failure != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value))
            return {};
        values.push_back(value);
        at = comma + 1;
    }
    return values;
}

Result<Camera> parse_camera(std::string_view what, std::string_view text) {
    const std::vector<double> v = parse_reals(text);
    if (v.size() != 6 && v.size() != 7)
        return Error{fmt::format("{} needs ex,ey,ez,tx,ty,tz or ex,ey,ez,tx,ty,tz,fov, not '{}'",
                                 what, text)};
    Camera camera;
    camera.eye = {v[0], v[1], v[2]};
    camera.target = {v[3], v[4], v[5]};
    if (v.size() == 7)
        camera.fov_degrees = v[6];
    if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180))
        return Error{
            fmt::format("{} needs a field of view between 0 and 180 degrees, not {}", what, v[6])};
    if (const Result<Done> fine = check_camera(camera); !fine)
        return Error{fmt::format("{}: {}: '{}'", what, fine.error().message, text)};
    return camera;
}

Result<dvec3> parse_position(std::string_view option, std::string_view text) {
    const std::vector<double> v = parse_reals(text);
    if (v.size() != 3)
        return Error{fmt::format("{} needs x,y,z, not '{}'", option, text)};
    const dvec3 position(v[0], v[1], v[2]);
    if (max_component(glm::abs(position)) > kFarthest)
        return Error{fmt::format("{} needs numbers up to {}, not '{}'", option, kFarthest, text)};
    return position;
}

} // namespace ovc
