// SPDX-License-Identifier: Apache-2.0
// Parsing of a subcommand's arguments and of their values, with errors that suggest what was meant.
// CLI11 does the parsing.
#pragma once

#include "core/result.h"
#include "core/scene.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ovc {

enum class Parsed { Run, HelpShown };

/// Parses a subcommand's arguments into the variables of `app`; --help prints its help instead.
/// Error: one sentence, with the nearest option that there is.
Result<Parsed> parse_arguments(CLI::App& app, std::vector<std::string> arguments);

/// Returns `text` as a whole number from min to max. option: its name in the error.
Result<uint64_t> parse_count(std::string_view option, std::string_view text, uint64_t min,
                             uint64_t max);

/// Returns `text` as a number from min to max. NaN is an error. option: its name in the error.
Result<double> parse_real(std::string_view option, std::string_view text, double min, double max);

/// Returns the index of `text` in `names`, which are not empty; 0, the default, for an empty text.
Result<size_t> parse_choice(std::string_view option, std::string_view text,
                            std::span<const std::string_view> names);

/// Returns a type name such as "auto|fragment|compute", which the help shows and completion offers.
std::string choice_names(std::span<const std::string_view> names);

/// Parses a size such as "640x480"; each side is from 1 to 65535.
Result<ImageSize> parse_size(std::string_view option, std::string_view text);

/// Parses "ex,ey,ez,tx,ty,tz", or with ",fov" in degrees, 0 < fov < 180; eye and target differ.
/// what: the name of the option, or of the place in a file, that the error blames.
Result<Camera> parse_camera(std::string_view what, std::string_view text);

/// Parses "x,y,z", each finite and of at most kFarthest in size.
Result<dvec3> parse_position(std::string_view option, std::string_view text);

/// Reads options one after the other. A variable keeps its value where its option's text is empty:
/// the user did not give the option. The first error counts, and nothing is read after it.
class OptionReader {
public:
    /// parse(option, text) returns a Result of what `to` is made from.
    template <class To, class Parse>
    void read(std::string_view option, std::string_view text, To& to, Parse&& parse) {
        if (!done_ || text.empty())
            return;
        if (auto value = parse(option, text))
            to = To(std::move(*value));
        else
            done_ = value.error();
    }
    template <class To>
    void count(std::string_view option, std::string_view text, uint64_t min, uint64_t max, To& to) {
        read(option, text, to,
             [&](auto name, auto word) { return parse_count(name, word, min, max); });
    }
    template <class To>
    void real(std::string_view option, std::string_view text, double min, double max, To& to) {
        read(option, text, to,
             [&](auto name, auto word) { return parse_real(name, word, min, max); });
    }
    /// names: in the order of `to`, an enumeration whose first value is 0.
    template <class To>
    void choice(std::string_view option, std::string_view text,
                std::span<const std::string_view> names, To& to) {
        read(option, text, to,
             [&](auto name, auto word) { return parse_choice(name, word, names); });
    }

    const Result<Done>& done() const { return done_; }

private:
    Result<Done> done_ = Done{};
};

} // namespace ovc
