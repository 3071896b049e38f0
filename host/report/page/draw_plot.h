// SPDX-License-Identifier: Apache-2.0
// Draws a plot with gnuplot, as SVG for the page and as PNG beside it.
#pragma once

#include "core/result.h"
#include "host/report/page/page_model.h"

#include <filesystem>

namespace ovc {

/// Returns the plot's SVG, for use within HTML: lines and letters have the colour of the text
/// around, and ids are unique to the plot. Writes NAME.dat, NAME.gp, NAME.svg and NAME.png into the
/// folder, which exists. Error: the plot would be empty, gnuplot is not installed or refuses, or a
/// file cannot be written.
Result<std::string> draw_plot(const Plot& plot, const std::filesystem::path& folder);

/// Returns an error that names the package to install where gnuplot is missing.
Result<Done> check_gnuplot();

} // namespace ovc
