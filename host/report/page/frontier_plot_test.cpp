// SPDX-License-Identifier: Apache-2.0
// Tests how choices are judged and drawn.
#include "host/report/page/frontier_plot.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

Json example_choices() {
    Json choices = Json::array({{{"choice", "fast"}, {"s", 1.0}, {"error", 0.2}},
                                {{"choice", "slow"}, {"s", 2.0}, {"error", 0.3}},
                                {{"choice", "right"}, {"s", 4.0}, {"error", 0.0}},
                                {{"choice", "ours"}, {"s", 1.5}, {"error", 0.1}},
                                {{"choice", "peer"}, {"s", 1.2}, {"error", 0.1}}});
    judge_choices(
        choices, "s", [](const Json& c) { return std::vector<double>{c["error"].get<double>()}; },
        [](const Json& c) { return c["choice"] == "peer"; });
    return choices;
}

TEST(FrontierPlot, NamesWhoDominatesWhom) {
    const Json choices = example_choices();
    EXPECT_TRUE(choices[0]["dominated_by"].is_null());
    EXPECT_EQ(choices[1]["dominated_by"], "fast");
    EXPECT_EQ(choices[1]["its_time_to_that"], 2.0);
    EXPECT_TRUE(choices[2]["dominated_by"].is_null());
    EXPECT_EQ(choices[3]["dominated_by"], "peer");
    EXPECT_TRUE(choices[3]["dominated_by_ours"].is_null());
    EXPECT_FALSE(choices[4].contains("dominated_by_ours"));
}

std::string said(const Text& text) {
    std::string all;
    for (const Piece& piece : text)
        all += std::holds_alternative<Number>(piece) ? std::get<Number>(piece).shown
                                                     : std::get<std::string>(piece);
    return all;
}

TEST(FrontierPlot, SaysWhereTheDefaultLies) {
    const Json figures = {{"choices", example_choices()}};
    EXPECT_EQ(said(default_text(figures, "/choices", "Rays: ", "right", "s", "s")),
              "Rays: the default, right, lies on the frontier, at 4 s.");
    EXPECT_EQ(said(default_text(figures, "/choices", "", "slow", "s", "s")),
              "the default, slow, does not lie on the frontier: fast is no more wrong, and the "
              "default takes 2 times its time.");
    EXPECT_EQ(said(default_text(figures, "/choices", "", "ours", "s", "s")),
              "the default, ours, lies on the frontier of Overcast's own choices; a peer, peer, is "
              "no more wrong, and the default takes 1.25 times its time.");
    EXPECT_TRUE(default_text(figures, "/choices", "", "absent", "s", "s").empty());
    EXPECT_EQ(said(frontier_cell(figures, "/choices/0")), "on the frontier");
    EXPECT_EQ(said(frontier_cell(figures, "/choices/1")), "fast, 2 x");
}

TEST(FrontierPlot, DrawsStairsAndNoErrorAtTheFoot) {
    const std::vector<PlotSeries> series = {
        {"one", {{1, 0.2, "fast"}, {2, 0.3, "slow"}}}, {"empty", {}}, {"two", {{4, 0, "right"}}}};
    const Plot plot = frontier_plot("p", "A plot.", series, "s", "error");
    EXPECT_THAT(plot.data, testing::HasSubstr("4 0.0316228 \"right\""));
    EXPECT_THAT(plot.data, testing::EndsWith("\n\n\n1 0.2\n4 0.0316228\n")) << "the stairs";
    EXPECT_THAT(plot.script, testing::HasSubstr("'none' 0.0316228"));
    EXPECT_THAT(plot.script, testing::HasSubstr("index 1 using 1:2 with points ls 3 title 'two'"));
    EXPECT_THAT(plot.script, testing::Not(testing::HasSubstr("empty")));
    const Plot wrong = frontier_plot("p", "", {series[0]}, "s", "error");
    EXPECT_THAT(wrong.script, testing::Not(testing::HasSubstr("none")));
}

} // namespace
} // namespace ovc
