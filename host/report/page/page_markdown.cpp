// SPDX-License-Identifier: Apache-2.0
// Writes the page as Markdown.
#include "host/report/page/page_html.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

namespace {

std::string words_of(const Text& text) {
    std::string words;
    for (const Piece& piece : text)
        words += std::holds_alternative<Number>(piece) ? std::get<Number>(piece).shown
                                                       : std::get<std::string>(piece);
    return words;
}

std::string markdown_of(const Text& text) {
    return text.empty() ? "" : words_of(text) + "\n\n";
}

std::string markdown_of(const Table& table) {
    std::vector<TextRow> rows = {table.header};
    for (const std::vector<Text>& row : table.rows) {
        rows.emplace_back();
        for (const Text& cell : row)
            rows.back().push_back(words_of(cell));
    }
    return table.caption + ":\n\n" + markdown_table(rows) + "\n";
}

std::string markdown_of(const Plot& plot) {
    return fmt::format("![{}](plots/{}.png)\n\n", plot.caption, plot.name);
}

std::string markdown_of(const PagePicture& picture) {
    return fmt::format("![{}]({})\n\n", picture.caption, picture.file);
}

} // namespace

std::string ReportPage::missing_text() const {
    return fmt::format("Not run, or not whole, in this form and by this build: {}.",
                       fmt::join(missing, ", "));
}

std::string page_markdown(const ReportPage& page) {
    std::string text = "# Overcast: the report\n\n" + page.subtitle + "\n\n";
    for (const std::string& trouble : page.troubles)
        text += "**" + trouble + "**\n\n";
    if (!page.missing.empty())
        text += page.missing_text() + "\n\n";
    for (const Section& section : page.sections) {
        text += "## " + section.title + "\n\n";
        for (const Block& block : section.blocks)
            text += std::visit([](const auto& one) { return markdown_of(one); }, block);
    }
    return text;
}

} // namespace ovc
