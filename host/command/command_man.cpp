// SPDX-License-Identifier: Apache-2.0
// overcast man: prints the manual page.
#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "host/command/manual.h"

#include <fmt/format.h>

namespace ovc {

static constexpr const char* kManExamples = R"(Examples:
  overcast man | man -l -
  overcast man > ~/.local/share/man/man1/overcast.1
      from then on: man overcast)";

namespace {

class Man final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Prints the manual page, overcast.1: all that --help says of every "
                        "command.");
        app.footer(kManExamples);
    }

    Result<int> run() override {
        fmt::print("{}", man_page(manual()));
        return kExitOk;
    }
};

} // namespace

std::unique_ptr<Subcommand> make_man() {
    return std::make_unique<Man>();
}

} // namespace ovc
