// SPDX-License-Identifier: Apache-2.0
// Writes a report as one HTML file that needs no other, and as Markdown.
#pragma once

#include "host/report/page/page_model.h"

#include <map>
#include <span>
#include <string>

namespace ovc {

struct ReportPage {
    std::string subtitle; // the program's version, the form, the date and the machine
    std::vector<Section> sections;
    std::vector<std::string> troubles; // a sentence for each error
    std::vector<std::string> missing;  // experiments that were not run whole

    /// Returns a sentence that names the missing experiments, of which there is at least one.
    std::string missing_text() const;
};

/// Returns the page as HTML, in which a number is <data value="..." data-at="error.json#/...">.
/// pictures: SVG by the names of all plots, and "data:" addresses by the files of all pictures.
/// Error: throws std::out_of_range where one of them is missing.
std::string page_html(const ReportPage& page, const std::map<std::string, std::string>& pictures);

/// Returns the page as Markdown, in which plots are links to plots/NAME.png.
std::string page_markdown(const ReportPage& page);

} // namespace ovc
