// SPDX-License-Identifier: Apache-2.0
// A report as one HTML file that needs no other, and as Markdown.
#pragma once

#include "host/report/page/page_model.h"

#include <map>
#include <span>
#include <string>

namespace ovc {

struct ReportPage {
    std::string subtitle; // which program, and how it was asked
    std::vector<Section> sections;
    std::vector<std::string> troubles; // what went wrong, a sentence each
    std::vector<std::string> missing;  // experiments that were not run whole

    /// A sentence on what is missing; or nothing.
    std::string missing_text() const;
};

/// pictures: SVG by the names of the plots, "data:" addresses by the files of the pictures. A
/// number is <data value="..." data-at="error.json#/...">.
std::string page_html(const ReportPage& page, const std::map<std::string, std::string>& pictures);

/// Plots are links to plots/NAME.png.
std::string page_markdown(const ReportPage& page);

} // namespace ovc
