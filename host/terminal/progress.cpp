// SPDX-License-Identifier: Apache-2.0
// The progress line begins with the important numbers: a narrow terminal cuts off the rest.
#include "host/terminal/progress.h"

#include "host/arguments/memory_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ovc {

/// Nobody can read lines that change more often than this.
static constexpr double kSecondsBetweenLines = 0.25;
/// An estimate before this would be a guess.
static constexpr double kSecondsBeforeEstimate = 2;

Progress::Progress(const Backend& backend, std::string label, uint64_t pixel_count,
                   uint64_t pixels_there, bool shown)
    : backend_(backend),
      label_(std::move(label)),
      pixel_count_(pixel_count),
      pixels_there_(pixels_there),
      line_(shown) {}

std::string Progress::left(uint64_t pixels_done, double seconds) const {
    const uint64_t done = pixels_done - std::min(pixels_there_, pixels_done);
    if (seconds < kSecondsBeforeEstimate || done == 0 || pixels_done >= pixel_count_)
        return "";
    return time_left(seconds / double(done) * double(pixel_count_ - pixels_done)) + ", ";
}

void Progress::update(const RenderReport& report) {
    const double seconds = watch_.seconds();
    if (!line_.shown() || seconds < last_seconds_ + kSecondsBetweenLines)
        return;
    last_seconds_ = seconds;
    const ovc_statistics statistics = backend_.statistics();
    std::string text =
        fmt::format("{}{:3.0f} % of pixels, {}{} rays, {:.2f} million a second", label_,
                    100.0 * double(report.pixels_done) / double(pixel_count_),
                    left(report.pixels_done, seconds), human_count(report.rays.total()),
                    double(report.rays.total()) / seconds * 1e-6);
    if (statistics.level2_bytes > 0)
        text +=
            fmt::format(", {} of {} resident at most, {} moved, budget {}",
                        human_bytes(std::min(statistics.gpu_peak_bytes, statistics.level2_bytes)),
                        human_bytes(statistics.level2_bytes), human_bytes(statistics.bytes_in),
                        human_bytes(statistics.gpu_budget_bytes));
    line_.show(text);
}

} // namespace ovc
