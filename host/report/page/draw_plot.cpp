// SPDX-License-Identifier: Apache-2.0
// Calls gnuplot with a script file.
#include "host/report/page/draw_plot.h"

#include "host/bench/programs/run_program.h"
#include "host/output/output.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

namespace ovc {

namespace {

// The same script draws SVG and PNG. At these sizes letters stay readable on a phone.
constexpr const char* kScript = R"(datafile = '{0}.dat'
set encoding utf8
set key above left samplen 1 width -4 maxcols 2 font ',12'
set grid lc rgb '#a0a0a0' lw 0.4
set border 3
set tics nomirror
set style line 1 lc rgb '#2f81d6' pt 7 ps 0.9 lw 2
set style line 2 lc rgb '#e0762a' pt 5 ps 0.9 lw 2
set style line 3 lc rgb '#3c9f54' pt 9 ps 1.1 lw 2
set style line 4 lc rgb '#b455c8' pt 13 ps 1.2 lw 2
set style line 5 lc rgb '#c2452d' pt 11 ps 1.1 lw 2
set style line 6 lc rgb '#1d9a96' pt 15 ps 1.0 lw 2
set style line 7 lc rgb '#808080' pt 3 ps 1.0 lw 2
set style line 9 lc rgb '#808080' lw 1.5 dt 2
set terminal svg size 640,{3} dynamic font 'sans-serif,15' name '{2}'
set output '{0}.svg'
{1}
set terminal pngcairo size 1280,{4} font 'sans,15' fontscale 1.45 background rgb 'white'
set output '{0}.png'
replot
unset output
)";

Result<std::string> read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.find("<svg") == std::string::npos)
        return Error{fmt::format("gnuplot left no picture in {}", path.string())};
    return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

/// Returns whether any line begins with two finite numbers.
bool has_points(const std::string& data) {
    std::istringstream lines(data);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        if (double x = 0, y = 0; words >> x >> y && std::isfinite(x) && std::isfinite(y))
            return true;
    }
    return false;
}

/// gnuplot allows only letters, digits and underscores in the name of an SVG, so dashes become
/// underscores.
std::string script_of(const Plot& plot) {
    return fmt::format(kScript, plot.name, plot.script, replaced(plot.name, "-", "_"), plot.height,
                       2 * plot.height);
}

/// Returns the file from <svg on, with black replaced by the page's colour of text.
std::string for_page(const std::string& svg, const std::string& name) {
    std::string text = svg.substr(svg.find("<svg"));
    for (const char* id : {"gpDot", "gpPt", "textbox_"})
        text = replaced(text, id, name + id);
    text = replaced(text, "<title>Gnuplot</title>", "");
    text = replaced(text, "<desc>Produced by GNUPLOT 5.4 patchlevel 4 </desc>", "");
    text = replaced(text, "rgb(0,0,0)", "currentColor");
    text = replaced(text, "rgb(  0,   0,   0)", "currentColor");
    for (const char quote : {'"', '\''})
        text = replaced(text, fmt::format("{0}black{0}", quote),
                        fmt::format("{0}currentColor{0}", quote));
    return text;
}

} // namespace

Result<Done> check_gnuplot() {
    if (is_installed("gnuplot"))
        return Done{};
    return Error{"the report draws its plots with gnuplot, which is not installed (Debian: "
                 "gnuplot-nox)"};
}

Result<std::string> draw_plot(const Plot& plot, const std::filesystem::path& folder) {
    if (!has_points(plot.data))
        return Error{fmt::format("plot {} has no points", plot.name)};
    if (const Result<Done> saved = save_text(plot.data, folder / (plot.name + ".dat")); !saved)
        return saved.error();
    const std::filesystem::path script = folder / (plot.name + ".gp");
    if (const Result<Done> saved = save_text(script_of(plot), script); !saved)
        return saved.error();
    const std::vector<std::string> words = {
        "gnuplot", "-e", fmt::format("cd '{}'", replaced(folder.string(), "'", "''")),
        plot.name + ".gp"};
    if (const Result<double> drawn = run_program(words); !drawn)
        return Error{fmt::format("plot {}: {}", plot.name, drawn.error().message)};
    const Result<std::string> svg = read_text(folder / (plot.name + ".svg"));
    return svg ? Result<std::string>(for_page(*svg, plot.name)) : svg.error();
}

} // namespace ovc
