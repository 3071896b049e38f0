// SPDX-License-Identifier: Apache-2.0
// Writes HTML, with its style and a few lines of script within.
#include "host/report/page/page_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc {

namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>Overcast: the report</title>
<style>
:root { --text: #1c2430; --soft: #5b6675; --ground: #ffffff; --panel: #f4f6f9; --line: #d5dbe3; --mark: #fff3cf; --link: #1f66b3; }
@media (prefers-color-scheme: dark) {
  :root { --text: #dfe5ec; --soft: #97a3b2; --ground: #12161c; --panel: #1a2028; --line: #303945; --mark: #3b3316; --link: #78b4f2; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 1rem; color: var(--text); background: var(--ground); font: 16px/1.5 system-ui, sans-serif; }
h1 { margin: .5rem 0 0; font-size: 1.7rem; }
h2 { margin: 2.5rem 0 .5rem; padding-top: .8rem; border-top: 1px solid var(--line); font-size: 1.3rem; }
p { max-width: 75ch; }
.soft, figcaption { color: var(--soft); font-size: .9rem; }
nav a { margin-right: 1rem; }
a { color: var(--link); }
figure { margin: 1rem 0; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 440px), 1fr)); gap: 1rem; }
.plots figure { margin: 0; padding: .6rem; background: var(--panel); border-radius: 8px; min-width: 0; }
.plots svg, .plots img { display: block; width: 100%; height: auto; }
/* A long table scrolls within itself, below its header. */
.scroll { overflow: auto; max-height: 34rem; border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; width: 100%; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { position: sticky; left: 0; text-align: left; background: var(--ground); max-width: 22rem; }
th.words, td.words { text-align: left; white-space: normal; }
td.words { min-width: 6rem; }
td.words:first-child { min-width: 14rem; }
tr:last-child td { border-bottom: 0; }
thead th { position: sticky; top: 0; z-index: 1; background: var(--panel); cursor: pointer; user-select: none; white-space: normal; vertical-align: bottom; }
thead th:first-child { background: var(--panel); z-index: 2; }
thead th[aria-sort=ascending]::after { content: " \2191"; }
thead th[aria-sort=descending]::after { content: " \2193"; }
tr.marked td, tr.marked td:first-child { background: var(--mark); }
.trouble { padding: .5rem 1rem; border-left: 4px solid #c2452d; background: var(--panel); }
@media (max-width: 600px) {
  body { padding: .7rem; }
  th:first-child, td:first-child, td.words:first-child { white-space: normal; min-width: 8.5rem; max-width: 9.5rem; }
}
</style>
</head>
<body>
)";

// A click on a header sorts by that column; a second click reverses the order. Cells without a
// number sort as text, behind numbers.
constexpr const char* kFoot = R"(<script>
for (const head of document.querySelectorAll("thead th"))
  head.addEventListener("click", () => {
    const body = head.closest("table").tBodies[0], column = head.cellIndex;
    const up = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.children) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", up ? "ascending" : "descending");
    const key = row => {
      const cell = row.cells[column], data = cell.classList.contains("words") ? null : cell.querySelector("data");
      return data ? Number(data.value) : cell.textContent;
    };
    const order = (a, b) => {
      const x = key(a), y = key(b);
      if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
      return (typeof x === "number" ? x - y : x.localeCompare(y)) * (up ? 1 : -1);
    };
    body.append(...[...body.rows].sort(order));
  });
</script>
</body>
</html>
)";

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text)
        switch (c) {
        case '<':
            html += "&lt;";
            break;
        case '>':
            html += "&gt;";
            break;
        case '&':
            html += "&amp;";
            break;
        case '"':
            html += "&quot;";
            break;
        default:
            html += c;
        }
    return html;
}

class Writer {
public:
    Writer(const Section& section, const std::map<std::string, std::string>& pictures)
        : section_(section), pictures_(pictures) {}

    std::string html() {
        std::string text = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", section_.name,
                                       escaped(section_.title));
        bool in_plots = false; // consecutive plots stand side by side
        for (const Block& block : section_.blocks) {
            const bool is_plot =
                std::holds_alternative<Plot>(block) || std::holds_alternative<PagePicture>(block);
            if (is_plot != in_plots)
                text += is_plot ? "<div class=\"plots\">\n" : "</div>\n";
            in_plots = is_plot;
            text += std::visit([&](const auto& one) { return html_of(one); }, block);
        }
        return text + (in_plots ? "</div>\n" : "") + "</section>\n";
    }

private:
    std::string piece_of(const Piece& piece) const {
        if (const auto* words = std::get_if<std::string>(&piece))
            return escaped(*words);
        const Number& n = std::get<Number>(piece);
        if (n.value.is_null())
            return n.shown;
        return fmt::format("<data value=\"{}\" data-at=\"{}.json#{}\">{}</data>", n.value.dump(),
                           section_.name, escaped(n.pointer), n.shown);
    }

    std::string inline_of(const Text& text) const {
        std::string html;
        for (const Piece& piece : text)
            html += piece_of(piece);
        return html;
    }

    std::string html_of(const Text& text) const {
        return text.empty() ? "" : "<p>" + inline_of(text) + "</p>\n";
    }

    std::string html_of(const Table& table) const {
        std::string html = fmt::format("<figure><figcaption>{}</figcaption>\n<div "
                                       "class=\"scroll\"><table>\n<thead><tr>",
                                       escaped(table.caption));
        for (size_t c = 0; c < table.header.size(); ++c)
            html += (of_words(table, c) ? "<th class=\"words\">" : "<th>") +
                    escaped(table.header[c]) + "</th>";
        html += "</tr></thead>\n<tbody>\n";
        for (size_t r = 0; r < table.rows.size(); ++r) {
            assert(table.rows[r].size() == table.header.size());
            html += row_of(table.rows[r], r == table.marked);
        }
        return html + "</tbody></table></div></figure>\n";
    }

    static bool is_words(const Text& cell) {
        return !cell.empty() && std::holds_alternative<std::string>(cell[0]);
    }

    /// Returns whether the column has no number.
    static bool of_words(const Table& table, size_t column) {
        return std::ranges::all_of(table.rows,
                                   [&](const auto& row) { return is_words(row[column]); });
    }

    std::string row_of(const std::vector<Text>& row, bool marked) const {
        std::string html = marked ? "<tr class=\"marked\">" : "<tr>";
        for (const Text& cell : row) {
            html += (is_words(cell) ? "<td class=\"words\">" : "<td>") + inline_of(cell) + "</td>";
        }
        return html + "</tr>\n";
    }

    std::string html_of(const Plot& plot) const {
        return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n",
                           pictures_.at(plot.name), escaped(plot.caption));
    }

    std::string html_of(const PagePicture& picture) const {
        return fmt::format(
            "<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
            pictures_.at(picture.file), escaped(picture.caption), escaped(picture.caption));
    }

    const Section& section_;
    const std::map<std::string, std::string>& pictures_;
};

} // namespace

std::string page_html(const ReportPage& page, const std::map<std::string, std::string>& pictures) {
    std::string html = kHead;
    html += "<header>\n<h1>Overcast: the report</h1>\n<p class=\"soft\">" + escaped(page.subtitle) +
            "</p>\n<nav>";
    for (const Section& section : page.sections)
        html += fmt::format("<a href=\"#{}\">{}</a>", section.name, escaped(section.title));
    html += "</nav>\n</header>\n";
    for (const std::string& trouble : page.troubles)
        html += "<p class=\"trouble\">" + escaped(trouble) + "</p>\n";
    if (!page.missing.empty())
        html += "<p class=\"soft\">" + escaped(page.missing_text()) + "</p>\n";
    for (const Section& section : page.sections)
        html += Writer(section, pictures).html();
    return html + kFoot;
}

} // namespace ovc
