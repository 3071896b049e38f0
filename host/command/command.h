// SPDX-License-Identifier: Apache-2.0
// The subcommands, and the program that hands over to them.
#pragma once

#include "core/result.h"
#include "host/terminal/interrupt.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace ovc {

using Arguments = std::vector<std::string>;

/// The words that a subcommand takes, and what it does with them.
class Subcommand {
public:
    virtual ~Subcommand() = default;
    /// Describes itself, its options and examples, to an app that does not outlive it: to be
    /// parsed, or only to be told of in a manual.
    virtual void add_to(CLI::App& app) = 0;
    /// The arguments in words that the app knows: other programs' spellings in ours.
    virtual Result<Arguments> in_our_words(const Arguments& arguments) { return arguments; }
    /// Once the app has parsed them. The result is an exit code, or the sentence to fail with.
    virtual Result<int> run() = 0;
};

std::unique_ptr<Subcommand> make_render();
std::unique_ptr<Subcommand> make_info();
std::unique_ptr<Subcommand> make_trace();
std::unique_ptr<Subcommand> make_convert();
std::unique_ptr<Subcommand> make_devices();
std::unique_ptr<Subcommand> make_scenes();
std::unique_ptr<Subcommand> make_report();
std::unique_ptr<Subcommand> make_bench();
std::unique_ptr<Subcommand> make_diff();
std::unique_ptr<Subcommand> make_completion();
std::unique_ptr<Subcommand> make_man();

struct Command {
    std::string_view name;
    std::string_view summary; // a line of the program's help
    std::unique_ptr<Subcommand> (*make)();
    int exit_on_error = kExitError;
};

/// In the order of the help.
std::span<const Command> commands();

/// What the program's exit codes mean, for its help and its manual; one paragraph.
std::string exit_codes();

/// The whole program but for exceptions: arguments are those after the program's name.
Result<int> run_command(const Arguments& arguments);

} // namespace ovc
