// SPDX-License-Identifier: Apache-2.0
// Test scenes by name, files by path.
#include "host/scene_source.h"

#include "importers/importer.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

namespace ovc {

Result<Scene> open_scene(const std::string& source, const LogSink& log) {
    if (is_test_scene(source))
        return make_test_scene(source);
    std::error_code ignored;
    if (std::filesystem::is_directory(source, ignored))
        return Error{fmt::format("'{}' is a directory, expected a file or a test scene", source)};
    const bool looks_like_a_name = source.find_first_of("./") == std::string::npos;
    if (looks_like_a_name && !source.empty() && !std::filesystem::exists(source, ignored)) {
        // The catalog knows the nearest name; a file of this name is not there either.
        const Result<Scene> none = make_test_scene(source);
        return none ? Error{fmt::format("there is no file '{}'", source)}
                    : Error{fmt::format("there is no file '{}', and {}", source,
                                        none.error().message)};
    }
    return load(source, {log});
}

LogSink standard_error_log(bool chatty) {
    return [chatty](LogLevel level, const std::string& message) {
        if (level == LogLevel::Info && !chatty)
            return;
        fmt::print(stderr, "overcast: {}{}\n", level == LogLevel::Warning ? "warning: " : "",
                   message);
    };
}

} // namespace ovc
