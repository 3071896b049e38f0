// SPDX-License-Identifier: Apache-2.0
// overcast scenes: lists the generated test scenes.
#include "host/arguments/arguments.h"
#include "host/command/command.h"
#include "host/terminal/interrupt.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace ovc {

static constexpr const char* kScenesExamples = R"(A name stands wherever a command takes a SCENE:
  overcast render plants -o plants.png
A scene with frames has a camera path; these are its first two frames:
  overcast render dragons-3 --frames 0:1 -o dragons-###.png
dragons-N and dragonball show a generated dragon, or a model of yours:
  overcast render dragons-3 --model dragon.ply)";

namespace {

class Scenes final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Lists the test scenes that are generated on demand.");
        app.footer(kScenesExamples);
    }

    Result<int> run() override {
        size_t widest = 0;
        for (const CatalogEntry& entry : catalog())
            widest = std::max(widest, entry.name.size());
        for (const CatalogEntry& entry : catalog())
            fmt::print("{:<{}}  {}{}\n", entry.name, widest, entry.description,
                       entry.frames > 0 ? fmt::format("; {} frames", entry.frames) : "");
        return kExitOk;
    }
};

} // namespace

std::unique_ptr<Subcommand> make_scenes() {
    return std::make_unique<Scenes>();
}

} // namespace ovc
