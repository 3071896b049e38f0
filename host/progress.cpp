// SPDX-License-Identifier: Apache-2.0
// The progress line.
#include "host/progress.h"

#include "host/memory_size.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace ovc {

/// A terminal that is written to more often than this only flickers.
static constexpr double kSecondsBetweenLines = 0.1;

Progress::Progress(const Backend& backend, std::string label, uint64_t pixel_count, bool shown)
    : backend_(backend),
      label_(std::move(label)),
      pixel_count_(pixel_count),
      shown_(shown && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (shown_)
        fmt::print(stderr, "\r\033[K");
}

void Progress::update(const RenderReport& report) {
    const double seconds = watch_.seconds();
    if (!shown_ || seconds < last_seconds_ + kSecondsBetweenLines)
        return;
    last_seconds_ = seconds;
    const ovc_statistics statistics = backend_.statistics();
    fmt::print(stderr, "\r\033[K{}{:3.0f} % of pixels, {} rays, {:.2f} million a second", label_,
               100.0 * double(report.pixels_done) / double(pixel_count_),
               human_count(report.rays.total()), double(report.rays.total()) / seconds * 1e-6);
    if (statistics.level2_bytes > 0)
        fmt::print(stderr, ", {} of {} resident at most, {} moved, budget {}",
                   human_bytes(std::min(statistics.gpu_peak_bytes, statistics.level2_bytes)),
                   human_bytes(statistics.level2_bytes), human_bytes(statistics.bytes_in),
                   human_bytes(statistics.gpu_budget_bytes));
    std::fflush(stderr);
}

} // namespace ovc
