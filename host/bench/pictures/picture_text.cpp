// SPDX-License-Identifier: Apache-2.0
// Makes the rows of tables and the objects of JSON.
#include "host/bench/pictures/picture_text.h"

#include "host/arguments/memory_size.h"
#include "host/bench/ratios/ratios.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

static std::string megabytes(std::optional<uint64_t> bytes) {
    return bytes ? fmt::format("{:.1f}", 1e-6 * double(*bytes)) : "-";
}

std::string picture_table(const PictureRace& race) {
    std::vector<TextRow> rows = {
        {"picture", "s", "CPU s", "RMSE", "peak MB", "GPU peak MB", "moved MB"}};
    for (const PictureCost& cost : race.choices)
        if (!cost.seconds.empty())
            rows.push_back({cost.name, fmt::format("{:.3f}", spread_of(cost.seconds).median),
                            fmt::format("{:.3f}", spread_of(cost.cpu_seconds).median),
                            fmt::format("{:.3g}", cost.rmse), megabytes(cost.host_peak_bytes),
                            megabytes(cost.gpu_peak_bytes), megabytes(cost.bytes_in)});
    return markdown_table(rows) +
           (race.complete ? "" : "\nInterrupted: these are the pictures that were drawn.\n");
}

std::string not_installed_text(std::span<const std::string> programs) {
    if (programs.empty())
        return "";
    return fmt::format("\nNot installed, and left out: {}.\n", fmt::join(programs, ", "));
}

Json picture_json(const PictureCost& cost) {
    const bool ran = !cost.seconds.empty();
    const auto json = [&](const auto& value) { return ran ? Json(value) : Json(nullptr); };
    const auto bytes = [](std::optional<uint64_t> b) { return b ? Json(*b) : Json(nullptr); };
    return {{"wall_seconds", cost.seconds},
            {"seconds", ran ? Json(spread_of(cost.seconds).median) : Json(nullptr)},
            {"cpu_seconds", ran ? Json(spread_of(cost.cpu_seconds).median) : Json(nullptr)},
            {"rmse", json(cost.rmse)},
            {"host_peak_bytes", bytes(cost.host_peak_bytes)},
            {"gpu_peak_bytes", bytes(cost.gpu_peak_bytes)},
            {"bytes_in", bytes(cost.bytes_in)}};
}

std::string json_text(const Json& document) {
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace ovc
