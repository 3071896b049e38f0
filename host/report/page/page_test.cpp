// SPDX-License-Identifier: Apache-2.0
// Tests a page made of sections, in HTML and Markdown, and that numbers say where they come from.
#include "host/report/page/page_html.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

TEST(ShownNumber, HasThreeDigitsOrAllOfAWholeNumber) {
    EXPECT_EQ(shown_number(0), "0");
    EXPECT_EQ(shown_number(12345), "12,345");
    EXPECT_EQ(shown_number(-12345), "-12,345");
    EXPECT_EQ(shown_number(0.125), "0.125");
    EXPECT_EQ(shown_number(3.14159), "3.14");
    EXPECT_EQ(shown_number(3.1e-7), "3.1e-07");
    EXPECT_EQ(shown_number(529.151), "529");
    EXPECT_EQ(shown_number(123456.7), "123457");
}

ReportPage example_page() {
    Section section{"sample", "A <title>", {{"rays", 12345}, {"list", {{{"t", 0.25}}}}}, {}};
    section.figures["list"][0]["none"] = nullptr;
    const auto at = [&](const char* pointer) { return number(section.figures, pointer); };
    section.blocks = {Text{"Of ", at("/rays"), " rays & more."},
                      Table{"A table",
                            {"name", "t", "none"},
                            {{{"first"}, {at("/list/0/t")}, {at("/list/0/none")}}},
                            0},
                      Plot{"a-plot", "A plot.", "1 2\n", "plot datafile"}};
    return {"the subtitle", {section}, {"it broke"}, {"scale", "claims"}};
}

TEST(PageHtml, NumbersSayWhereTheyStand) {
    const std::string html = page_html(example_page(), {{"a-plot", "<svg>drawn</svg>"}});
    EXPECT_THAT(html, testing::HasSubstr(
                          "Of <data value=\"12345\" data-at=\"sample.json#/rays\">12,345</data> "
                          "rays &amp; more."));
    EXPECT_THAT(html, testing::HasSubstr("data-at=\"sample.json#/list/0/t\">0.25</data>"));
    EXPECT_THAT(html, testing::HasSubstr("<td>-</td>"));
    EXPECT_THAT(html, testing::HasSubstr("<h2>A &lt;title&gt;</h2>"));
    EXPECT_THAT(html, testing::HasSubstr("<svg>drawn</svg>"));
    EXPECT_THAT(html, testing::HasSubstr("<tr class=\"marked\">"));
    EXPECT_THAT(html, testing::HasSubstr("class=\"trouble\">it broke"));
    EXPECT_THAT(html, testing::HasSubstr("by this build: scale, claims."));
}

/// The page works offline, because it loads nothing.
TEST(PageHtml, StandsAlone) {
    const std::string html = page_html(example_page(), {{"a-plot", "<svg/>"}});
    EXPECT_THAT(html, testing::Not(testing::ContainsRegex("(src|href)=\"[^#d\"]")));
    EXPECT_THAT(html, testing::Not(testing::HasSubstr("@import")));
    EXPECT_THAT(html, testing::Not(testing::HasSubstr("url(")));
    EXPECT_THAT(html, testing::HasSubstr("prefers-color-scheme: dark"));
}

TEST(PageMarkdown, HasTextTablesAndLinksToPlots) {
    const std::string markdown = page_markdown(example_page());
    EXPECT_THAT(markdown, testing::HasSubstr("Of 12,345 rays & more."));
    EXPECT_THAT(markdown, testing::ContainsRegex("first +\\| +0.25 \\| +-"));
    EXPECT_THAT(markdown, testing::HasSubstr("![A plot.](plots/a-plot.png)"));
    EXPECT_THAT(markdown, testing::HasSubstr("**it broke**"));
    EXPECT_THAT(markdown, testing::HasSubstr("by this build: scale, claims."));
}

} // namespace
} // namespace ovc
