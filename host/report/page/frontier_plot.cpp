// SPDX-License-Identifier: Apache-2.0
// Judges choices in JSON and draws them as points.
#include "host/report/page/frontier_plot.h"

#include "host/report/page/frontier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {

namespace {

using Point = PlotSeries::Point;

std::vector<Point> all_points(const std::vector<PlotSeries>& series) {
    std::vector<Point> points;
    for (const PlotSeries& one : series)
        points.insert(points.end(), one.points.begin(), one.points.end());
    return points;
}

/// Returns the height at which an error of 0 is drawn: below the smallest error, and between two
/// powers of ten, because its label would overlap theirs.
double foot_of(const std::vector<Point>& points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Point& point : points)
        if (point.error > 0)
            least = std::min(least, point.error);
    return std::pow(10, std::floor(std::log10(std::isfinite(least) ? least : 1)) - 0.5);
}

/// Returns a range that is a little wider than [least, most].
std::pair<double, double> range_of(double least, double most) {
    constexpr double margin = 1.4;
    return {least / margin, most * margin};
}

/// Returns 1, 2 and 5 times the powers of ten within the range, or the powers alone where it is
/// long.
std::string ticks_in(std::pair<double, double> range) {
    const bool is_long = range.second > 1e3 * range.first;
    std::string ticks;
    for (double decade = std::pow(10, std::floor(std::log10(range.first))); decade < range.second;
         decade *= 10)
        for (const double step : {1.0, 2.0, 5.0})
            if (const double at = step * decade;
                at >= range.first && at <= range.second && (step == 1 || !is_long))
                ticks += fmt::format("{}{:.6g}", ticks.empty() ? "" : ", ", at);
    return ticks;
}

/// Returns the points that no other point undercuts in both costs, from left to right.
std::vector<Point> staircase(std::vector<Point> points) {
    std::ranges::sort(points, [](const Point& a, const Point& b) {
        return std::pair(a.x, a.error) < std::pair(b.x, b.error);
    });
    std::vector<Point> stairs;
    for (const Point& point : points)
        if (stairs.empty() || point.error < stairs.back().error)
            stairs.push_back(point);
    return stairs;
}

} // namespace

void judge_choices(Json& choices, const std::string& time,
                   const std::function<std::vector<double>(const Json&)>& errors,
                   const std::function<bool(const Json&)>& is_peer) {
    const auto judge = [&](const std::vector<size_t>& who, const char* by, const char* how_long) {
        std::vector<Choice> costs;
        for (const size_t i : who)
            costs.push_back({choices[i][time].get<double>(), errors(choices[i])});
        for (size_t i = 0; i < costs.size(); ++i) {
            const std::optional<size_t> better = dominating(costs, i);
            choices[who[i]][by] = better ? choices[who[*better]]["choice"] : Json(nullptr);
            choices[who[i]][how_long] =
                better ? Json(costs[i].seconds / costs[*better].seconds) : Json(nullptr);
        }
    };
    std::vector<size_t> all, ours;
    for (size_t i = 0; i < choices.size(); ++i) {
        all.push_back(i);
        if (!is_peer(choices[i]))
            ours.push_back(i);
    }
    judge(all, "dominated_by", "its_time_to_that");
    judge(ours, "dominated_by_ours", "its_time_to_ours");
}

std::vector<Piece> frontier_cell(const Json& figures, const std::string& at) {
    const Json& choice = figures.at(Json::json_pointer(at));
    if (choice["dominated_by"].is_null())
        return {"on the frontier"};
    return {choice["dominated_by"].get<std::string>(), ", ",
            number(figures, at + "/its_time_to_that"), " x"};
}

Text default_text(const Json& figures, const std::string& at, const std::string& what,
                  const std::string& name, const std::string& time, const std::string& unit) {
    const Json& choices = figures.at(Json::json_pointer(at));
    for (size_t i = 0; i < choices.size(); ++i) {
        if (choices[i]["choice"] != name)
            continue;
        const std::string row = fmt::format("{}/{}", at, i);
        const std::string start = what + "the default, " + name + ", ";
        const bool is_ours_best = choices[i]["dominated_by_ours"].is_null();
        Text text = {start + (is_ours_best ? "lies" : "does not lie") + " on the frontier"};
        if (choices[i]["dominated_by"].is_null()) {
            text.insert(text.end(), {", at ", number(figures, row + "/" + time), " " + unit + "."});
            return text;
        }
        const std::string by = is_ours_best ? "dominated_by" : "dominated_by_ours";
        const std::string how_long = is_ours_best ? "/its_time_to_that" : "/its_time_to_ours";
        const std::string better = choices[i][by].get<std::string>();
        text.insert(
            text.end(),
            {is_ours_best ? " of Overcast's own choices; a peer, " + better + "," : ": " + better,
             " is no more wrong, and the default takes ", number(figures, row + how_long),
             " times its time."});
        return text;
    }
    return {};
}

Plot frontier_plot(const std::string& name, const std::string& caption,
                   const std::vector<PlotSeries>& series, const std::string& x_label,
                   const std::string& y_label) {
    std::vector<Point> points = all_points(series);
    assert(series.size() <= 6 && !points.empty());
    const double foot = foot_of(points);
    const bool any_right = std::ranges::any_of(points, [](const Point& p) { return p.error == 0; });
    for (Point& point : points)
        point.error = std::max(point.error, foot);
    const auto [fastest, slowest] = std::ranges::minmax(points, {}, &Point::x);
    const auto [rightest, wrongest] = std::ranges::minmax(points, {}, &Point::error);
    const auto xs = range_of(fastest.x, slowest.x);
    // The axis reaches the power of ten above the foot, also where no choice has an error.
    const auto ys = range_of(rightest.error, std::max(wrongest.error, std::sqrt(10) * foot));
    std::string data = "# x, error (0 at the foot), choice\n", with;
    int block = 0;
    for (size_t s = 0; s < series.size(); ++s) {
        if (series[s].points.empty())
            continue;
        for (const Point& point : series[s].points)
            data += fmt::format("{:.6g} {:.6g} \"{}\"\n", point.x, std::max(point.error, foot),
                                point.name);
        data += "\n\n";
        with += fmt::format("datafile index {} using 1:2 with points ls {} title '{}', ", block++,
                            s + 1, series[s].title);
    }
    for (const Point& point : staircase(points))
        data += fmt::format("{:.6g} {:.6g}\n", point.x, point.error);
    constexpr double short_range = 30; // powers of ten alone would leave a tick or two
    std::string y_tics = ys.second < short_range * ys.first
                             ? fmt::format("set ytics ({})\n", ticks_in(ys))
                             : "set format y '10^{%L}'\n";
    if (any_right)
        y_tics += fmt::format("set ytics add ('none' {:.6g})\n", foot);
    return {name, caption, data,
            fmt::format("set logscale xy\nset xlabel '{}' offset 0,0.3\nset ylabel '{}'\n"
                        "set xtics ({})\n{}set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n"
                        "plot {}datafile index {} using 1:2 with steps ls 9 title 'frontier'\n",
                        x_label, y_label, ticks_in(xs), y_tics, xs.first, xs.second, ys.first,
                        ys.second, with, block)};
}

} // namespace ovc
