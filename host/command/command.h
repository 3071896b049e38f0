// SPDX-License-Identifier: Apache-2.0
// The interface of the subcommands, their table, and the program that hands over to them.
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

/// A subcommand knows its options, and keeps their values until it runs.
class Subcommand {
public:
    virtual ~Subcommand() = default;
    /// Adds a description, options and examples to `app`. The app must not outlive this object,
    /// whose members its options write. manual() only reads the app, and never parses it.
    virtual void add_to(CLI::App& app) = 0;
    /// Returns the arguments with other programs' spellings translated into ours, for the app.
    virtual Result<Arguments> in_our_words(const Arguments& arguments) { return arguments; }
    /// Runs once the app has parsed the arguments. Returns an exit code, or the sentence to fail
    /// with.
    virtual Result<int> run() = 0;
};

std::unique_ptr<Subcommand> make_render();
std::unique_ptr<Subcommand> make_info();
std::unique_ptr<Subcommand> make_trace();
std::unique_ptr<Subcommand> make_convert();
std::unique_ptr<Subcommand> make_devices();
std::unique_ptr<Subcommand> make_doctor();
std::unique_ptr<Subcommand> make_scenes();
std::unique_ptr<Subcommand> make_report();
std::unique_ptr<Subcommand> make_bench();
std::unique_ptr<Subcommand> make_diff();
std::unique_ptr<Subcommand> make_completion();
std::unique_ptr<Subcommand> make_man();

struct Command {
    std::string_view name;
    std::string_view summary; // a line in the program's help
    std::unique_ptr<Subcommand> (*make)();
    int exit_on_error = kExitError;
};

/// Returns the table of subcommands, in the order of the help.
std::span<const Command> commands();

/// Returns a paragraph on the program's exit codes, for its help and its manual.
std::string exit_codes();

/// Runs the whole program and returns its exit code. arguments: those after the program's name.
/// Error: the sentence to print. Exceptions, such as std::bad_alloc, pass through to main().
Result<int> run_command(const Arguments& arguments);

} // namespace ovc
