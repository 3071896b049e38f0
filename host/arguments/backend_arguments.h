// SPDX-License-Identifier: Apache-2.0
// The options that choose and size a backend, the same for every subcommand that traces.
#pragma once

#include "core/result.h"
#include "host/backend/backend.h"

#include <string>
#include <string_view>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace ovc {

/// Returns the backend of that name. Error: lists the backends, with the one probably meant.
Result<BackendKind> parse_backend(std::string_view name);

/// Returns an error where an option for several ranks is given, with this text, to a process that
/// is alone.
Result<Done> check_ranks(const char* option, std::string_view text);

/// Parses --ranks-own; an empty text is auto. Error: an unknown word, or one for a process that is
/// alone.
Result<ovc_ranks_own> parse_ranks_own(std::string_view text);

/// Adds --ranks-own.
CLI::Option* add_ranks_own(CLI::App& app, std::string& text);

/// The options as the user wrote them; empty where not given.
struct BackendArguments {
    std::string backend = "auto";
    std::string gpu_memory;
    std::string host_memory;
    std::string leaf_triangles;
    std::string leaves;
    std::string device;
    std::string precision;
    std::string kernel;
    std::string kernel_variant;
    std::string ranks_own;
    std::string rank_timeout;
    std::string level1;
    std::string level1_build;

    /// host_memory_help: what --host-memory says in the help.
    void add_to(CLI::App& app,
                const char* host_memory_help =
                    "For .ovc files: the most host memory to use for triangles and what is built "
                    "of them, 2G; the others stay on the disk");
    Result<BackendOptions> resolve() const;

private:
    Result<Done> check_meaning(BackendKind kind) const;
    Result<Done> resolve_ranks(BackendOptions& options) const;
};

} // namespace ovc
