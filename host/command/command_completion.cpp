// SPDX-License-Identifier: Apache-2.0
// overcast completion: prints a script by which a shell completes our arguments.
#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "host/command/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

static constexpr const char* kCompletionExamples = R"(Examples:
  source <(overcast completion bash)
      in this shell, or from ~/.bashrc in every one; zsh likewise
  overcast completion fish | source
      fish, in this shell
  overcast completion bash > ~/.local/share/bash-completion/completions/overcast
  overcast completion zsh > ~/.zfunc/_overcast
      with ~/.zfunc in $fpath before compinit
  overcast completion fish > ~/.config/fish/completions/overcast.fish)";

static constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};

namespace {

class Completion final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Prints a script by which a shell completes commands, options, their "
                        "choices, and scenes.");
        app.add_option("SHELL", shell_, "Whose script")
            ->type_name(choice_names(kShells))
            ->required();
        app.footer(kCompletionExamples);
    }

    Result<int> run() override {
        const Result<size_t> shell = parse_choice("completion", shell_, kShells);
        if (!shell)
            return shell.error();
        const auto write = *shell == 0   ? bash_completion
                           : *shell == 1 ? zsh_completion
                                         : fish_completion;
        fmt::print("{}", write(manual()));
        return kExitOk;
    }

private:
    std::string shell_;
};

} // namespace

std::unique_ptr<Subcommand> make_completion() {
    return std::make_unique<Completion>();
}

} // namespace ovc
