// SPDX-License-Identifier: Apache-2.0
// Writes overcast.1 in roff: the program, then each subcommand with its options and examples.
// Source: man(7), "Conventions for writing Linux man pages" of Linux man-pages.
#include "host/command/command.h"
#include "host/command/manual.h"
#include "host/terminal/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

/// Escapes the text so that roff sees no request and no escape in it. Runs of blanks stay.
static std::string roff(const std::string& text) {
    std::string out;
    bool at_line_start = true;
    for (const char c : text) {
        if (at_line_start && (c == '.' || c == '\''))
            out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        at_line_start = c == '\n';
    }
    return out;
}

static std::string paragraph_of(const OptionManual& option) {
    std::string text =
        fmt::format(".TP\n.BR \"{}\"", roff(fmt::format("{}", fmt::join(option.names, ", "))));
    if (!option.value.empty() && option.value != option.names[0])
        text += fmt::format(" \" \" \\fI{}\\fR", roff(option.value));
    return text + "\n" + roff(option.description) + "\n";
}

static std::string section_of(const CommandManual& command) {
    std::string text = fmt::format(".SS \"overcast {}", command.name);
    for (const OptionManual& place : command.places)
        text += fmt::format(" {}{}", roff(place.names[0]), place.repeats ? "..." : "");
    text += " [options]\"\n" + roff(command.description) + "\n";
    for (const OptionManual& place : command.places)
        text += paragraph_of(place);
    for (const OptionManual& option : command.options)
        text += paragraph_of(option);
    return text + ".PP\n.nf\n" + roff(command.footer) + "\n.fi\n";
}

std::string man_page(const std::vector<CommandManual>& manual) {
    std::string text = fmt::format(
        ".\\\" Made by: overcast man\n.TH OVERCAST 1 \"\" \"overcast {}\" \"User Commands\"\n"
        ".SH NAME\novercast \\- ray tracing of scenes larger than the memory of the GPU\n"
        ".SH SYNOPSIS\n.B overcast\n.I command\n[arguments]\n"
        ".br\n.B overcast\n.I command\n.B \\-\\-help\n"
        ".SH DESCRIPTION\nFinds where rays hit triangles, and renders pictures by it. Rays are "
        "traced by the GPU, or by a software renderer where there is none, in memory of a size "
        "that the user sets.\n.TP 10\n",
        version_text());
    for (const CommandManual& command : manual)
        text += fmt::format(".B {}\n{}\n.TP 10\n", command.name, roff(command.summary));
    text += ".B help\nThe same as \\-\\-help, of the program or of the command that follows\n"
            ".SH COMMANDS\n";
    for (const CommandManual& command : manual)
        text += section_of(command);
    text +=
        ".SH EXIT STATUS\n" + roff(exit_codes()) +
        "\n.SH ENVIRONMENT\n.TP\n.B OVC_PLUGIN\n"
        "The libovercast.so to trace with, instead of the one beside the program\n"
        ".TP\n.B OVC_KERNEL_CACHE\n"
        "The folder for compiled kernels, instead of overcast/kernels in the user's cache; off: "
        "none\n";
    return text;
}

} // namespace ovc
