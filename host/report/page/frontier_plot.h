// SPDX-License-Identifier: Apache-2.0
// Shows time against error on the page: which choices dominate others, and the plot of the
// frontier.
#pragma once

#include "host/report/page/page_model.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

/// Adds to each choice of an array "dominated_by", the name of another choice, and
/// "its_time_to_that", the ratio of their times; both are null where the choice lies on the
/// frontier (host/report/page/frontier.h). Choices that are not peers also get "dominated_by_ours"
/// and "its_time_to_ours", for which peers do not count. Each choice has its name in "choice" and
/// its time in the key `time`. errors: returns the errors of a choice, the same number for all.
void judge_choices(Json& choices, const std::string& time,
                   const std::function<std::vector<double>(const Json&)>& errors,
                   const std::function<bool(const Json&)>& is_peer);

/// Returns a table cell: "on the frontier", or the better choice and how many times slower this one
/// is. at: a pointer to the choice in the figures.
std::vector<Piece> frontier_cell(const Json& figures, const std::string& at);

/// Returns a sentence that says whether the choice of this name, which is no peer, lies on the
/// frontier of all choices or of ours, with its time; empty where there is no such choice. at: a
/// pointer to the array of choices in the figures.
Text default_text(const Json& figures, const std::string& at, const std::string& what,
                  const std::string& name, const std::string& time, const std::string& unit);

/// The points with the same marks.
struct PlotSeries {
    std::string title;
    struct Point {
        double x, error; // an error of 0 is drawn at the foot, labelled "none"
        std::string name;
    };
    std::vector<Point> points;
};

/// Returns a plot with two logarithmic axes and the frontier as stairs. There are at most six
/// series with at least one point in all (asserted); each x is above 0.
Plot frontier_plot(const std::string& name, const std::string& caption,
                   const std::vector<PlotSeries>& series, const std::string& x_label,
                   const std::string& y_label);

} // namespace ovc
