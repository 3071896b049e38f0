// SPDX-License-Identifier: Apache-2.0
// overcast scenes: the catalog of generated test scenes.
#include "host/arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace ovc {

static constexpr const char* kExamples = R"(A name stands wherever a command takes a SCENE:
  overcast render plants -o plants.png)";

Result<int> run_scenes(const Arguments& arguments) {
    CLI::App app{"Lists the test scenes that are generated on demand.", "overcast scenes"};
    app.footer(kExamples);
    const Result<Parsed> parsed = parse_arguments(app, arguments);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;

    size_t widest = 0;
    for (const CatalogEntry& entry : catalog())
        widest = std::max(widest, entry.name.size());
    for (const CatalogEntry& entry : catalog())
        fmt::print("{:<{}}  {}\n", entry.name, widest, entry.description);
    return kExitOk;
}

} // namespace ovc
