// SPDX-License-Identifier: Apache-2.0
// The table of subcommands, and the program's own help and version.
#include "host/command/command.h"

#include "core/text/suggestion.h"
#include "host/arguments/arguments.h"
#include "host/diff/verdict.h"
#include "host/ranks/ranks.h"
#include "host/scene/scene_pictures.h"
#include "host/terminal/message.h"
#include "host/terminal/version.h"

#include <fmt/format.h>

#include <cstdio>
#include <system_error>

namespace ovc {

static constexpr Command kCommands[] = {
    {"render", "Render a picture of a scene", make_render},
    {"info", "Say what a scene consists of and needs", make_info},
    {"trace", "Answer rays from standard input", make_trace},
    {"convert", "Write a scene as .ovc, which starts at once, or as .ply or .obj", make_convert},
    {"devices", "List the GPUs and software renderers there are", make_devices},
    {"doctor", "Say what a device lacks on this machine, and what to do", make_doctor},
    {"scenes", "List the generated test scenes", make_scenes},
    {"report", "Measure what the documents claim", make_report},
    {"bench", "Time rays, certified and fast, beside peers", make_bench},
    {"diff", "Compare two pictures", make_diff, int(Verdict::Unreadable)},
    {"completion", "Print a script that completes these words in a shell", make_completion},
    {"man", "Print the manual page", make_man},
};

std::span<const Command> commands() {
    return kCommands;
}

std::string exit_codes() {
    return "Exit codes: 0 done, 1 an error (one sentence on standard error), 2 interrupted. Those "
           "of diff are others: see overcast diff --help.";
}

static int print_help() {
    fmt::print(
        "Overcast finds where rays hit triangles, in scenes larger than the GPU's memory.\n\n"
        "Usage: overcast COMMAND [arguments]\n\nCommands:\n");
    for (const Command& command : kCommands)
        fmt::print("  {:<11} {}\n", command.name, command.summary);
    fmt::print(
        "\n  overcast COMMAND --help   what a command takes, with examples; also: overcast help "
        "COMMAND\n"
        "  overcast --version        also: overcast version\n\n"
        "Examples:\n"
        "  overcast scenes                                  what there is to render without any "
        "file\n"
        "  overcast render dragon.ply -o dragon.png         a picture, framed and lit by itself\n"
        "  overcast render plants --gpu-memory 64M          with 64 MiB of GPU memory\n"
        "  overcast info dragon.ply                         triangles, bounds, what it needs\n"
        "  echo 0 0 9  0 0 -1 | overcast trace dragon.ply   where one ray hits\n\n"
        "{}\n",
        exit_codes());
    return kExitOk;
}

static Error unknown_command(std::string_view name) {
    std::vector<std::string_view> names;
    for (const Command& command : kCommands)
        names.push_back(command.name);
    const std::string hint = did_you_mean(name, names);
    return {fmt::format("there is no command '{}'{}", name,
                        hint.empty() ? "; see overcast --help" : hint)};
}

/// Does the work, and returns its exit code; an error where standard output did not take all of it.
template <class Work>
static Result<int> printing(const Work& work) {
    const Error lost{"cannot write to standard output"};
    try {
        const Result<int> code = work();
        const bool written = std::fflush(stdout) == 0 && !std::ferror(stdout);
        return !code || written ? code : lost;
    } catch (const std::system_error&) { // fmt throws where standard output takes nothing more
        if (!std::ferror(stdout))
            throw;
        return lost;
    }
}

static Result<int> run(const Command& command, const Arguments& arguments) {
    const std::unique_ptr<Subcommand> subcommand = command.make();
    CLI::App app{"", fmt::format("overcast {}", command.name)};
    subcommand->add_to(app);
    const Result<Arguments> ours = subcommand->in_our_words(arguments);
    if (!ours)
        return ours.error();
    const Result<Parsed> parsed = parse_arguments(app, *ours);
    if (!parsed)
        return parsed.error();
    return *parsed == Parsed::HelpShown ? kExitOk : subcommand->run();
}

static Result<int> run_named(const std::string& name, const Arguments& arguments) {
    for (const Command& command : kCommands)
        if (command.name == name) {
            const Result<int> code = printing([&] { return run(command, arguments); });
            if (code || command.exit_on_error == kExitError)
                return code;
            print_message(code.error().message);
            return command.exit_on_error;
        }
    return unknown_command(name);
}

/// Prints what the command does with a library that is loaded where it is there, or without it.
static void print_part(bool is_there, std::string_view library, std::string_view with,
                       std::string_view without) {
    fmt::print("{} {}: {}\n", is_there ? "with" : "without", library, is_there ? with : without);
}

static int print_version() {
    fmt::print("overcast {}\n", version_text());
    print_part(ScenePictures::library_is_there(), kTextureLibrary, "surfaces show image textures",
               "surfaces show no image textures; it is built where OpenImageIO is installed "
               "(Debian: libopenimageio-dev)");
    print_part(Ranks::library_is_there(), kRankedProduct, "processes under mpirun share the work",
               "processes under mpirun cannot share the work; it is built where MPI is installed "
               "(Debian: libopenmpi-dev)");
    return kExitOk;
}

Result<int> run_command(const Arguments& arguments) {
    if (arguments.empty())
        return Error{"no command given; see overcast --help"};
    const std::string& name = arguments.front();
    if (name == "help" && arguments.size() > 1)
        return run_named(arguments[1], {"--help"});
    if (name == "--help" || name == "-h" || name == "help")
        return printing(print_help);
    if (name == "--version" || name == "-V" || name == "version")
        return printing(print_version);
    return run_named(name, {arguments.begin() + 1, arguments.end()});
}

} // namespace ovc
