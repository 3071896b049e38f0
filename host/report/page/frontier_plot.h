// SPDX-License-Identifier: Apache-2.0
// Time against error on the page: choices, who dominates them, and the plot with the frontier.
#pragma once

#include "host/report/page/page_model.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

/// Adds to each choice of an array, which have "choice" by name, "dominated_by", the name of
/// another, and "its_time_to_that"; null where it lies on the frontier
/// (host/report/page/frontier.h). Those that are not peers get "dominated_by_ours" and
/// "its_time_to_ours" as well, for which peers do not count. time: a key of theirs; errors: of one
/// choice, as many as of the others.
void judge_choices(Json& choices, const std::string& time,
                   const std::function<std::vector<double>(const Json&)>& errors,
                   const std::function<bool(const Json&)>& is_peer);

/// A cell: "on the frontier", or who is better and how many times slower this one is. at: the
/// choice, in the figures.
std::vector<Piece> frontier_cell(const Json& figures, const std::string& at);

/// Whether the choice of this name, no peer, lies on the frontier, of all choices or of ours, as a
/// sentence with its time; empty where there is no such choice. at: the array, in the figures.
Text default_text(const Json& figures, const std::string& at, const std::string& what,
                  const std::string& name, const std::string& time, const std::string& unit);

/// Points of one kind.
struct PlotSeries {
    std::string title;
    struct Point {
        double x, error; // error 0: drawn at the foot, "none"
        std::string name;
    };
    std::vector<Point> points;
};

/// Logarithmic both ways, the frontier as stairs. At most six series, a point at least, none
/// with x 0 (asserted).
Plot frontier_plot(const std::string& name, const std::string& caption,
                   const std::vector<PlotSeries>& series, const std::string& x_label,
                   const std::string& y_label);

} // namespace ovc
