// SPDX-License-Identifier: Apache-2.0
// Draws a plot with gnuplot, as SVG for the page and as PNG beside it.
#pragma once

#include "core/result.h"
#include "host/report/page/page_model.h"

#include <filesystem>

namespace ovc {

/// Writes NAME.dat, NAME.gp, NAME.svg and NAME.png into the folder, which exists. Returns the SVG,
/// to stand within HTML: its lines and letters have the colour of the text around, its names are
/// its own. Error: the plot would be empty, or gnuplot is not installed or refuses.
Result<std::string> draw_plot(const Plot& plot, const std::filesystem::path& folder);

/// Error: gnuplot is not installed, and what to do.
Result<Done> check_gnuplot();

} // namespace ovc
