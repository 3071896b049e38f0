// SPDX-License-Identifier: Apache-2.0
// Checks a comparison against the limits, and writes the text and the JSON.
#include "host/diff/verdict.h"

#include "host/arguments/memory_size.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ovc {

using Json = nlohmann::ordered_json;

static constexpr const char* kVerdicts[] = {"ok", "warning", "failure"};

bool Limit::is_passed_by(const Comparison& comparison) const {
    const auto& worst = comparison.worst;
    const double largest =
        worst.empty() ? 0 : double(*std::max_element(worst.begin(), worst.end()));
    return double(comparison.over(each)) > percent / 100 * double(worst.size()) || largest > any;
}

Verdict judge(const Comparison& comparison, const Limits& limits) {
    if (limits.fail.is_passed_by(comparison))
        return Verdict::Failure;
    return limits.warn.is_passed_by(comparison) ? Verdict::Warning : Verdict::Ok;
}

static std::string decibels(double psnr) {
    return std::isinf(psnr) ? "-" : fmt::format("{:.2f}", psnr);
}

static std::string share(uint64_t count, size_t size) {
    return fmt::format("{} ({:.3g} %)", human_count(count), 100 * double(count) / double(size));
}

static TextRow row_of(const LayerDifference& layer, size_t size) {
    TextRow row = {layer.name, share(layer.differing, size)};
    if (!layer.errors) {
        row.insert(row.end(), {"-", "-", "-", "-", "-"});
        return row;
    }
    const Errors& e = *layer.errors;
    const std::string where = e.max > 0 ? fmt::format("{} of {}, {}: {:.6g}, {:.6g}", e.at.channel,
                                                      e.at.x, e.at.y, e.at.a, e.at.b)
                                        : "-";
    row.insert(row.end(), {fmt::format("{:.6g}", e.max), where, fmt::format("{:.6g}", e.mean),
                           fmt::format("{:.6g}", e.rmse), decibels(e.psnr)});
    return row;
}

static std::string only_text(const std::vector<std::string>& channels, const std::string& file) {
    return channels.empty()
               ? ""
               : fmt::format("only in {}, and not compared: {}\n", file, fmt::join(channels, ", "));
}

/// "12 pixels (0.1 %) are more than 1e-06 apart, allowed are 0 %".
static std::string limit_text(const Comparison& comparison, const Limit& limit) {
    std::string text = fmt::format("{} pixels are more than {:g} apart, allowed are {:g} %",
                                   share(comparison.over(limit.each), comparison.worst.size()),
                                   limit.each, limit.percent);
    if (!std::isinf(limit.any))
        text += fmt::format("; {} are more than {:g} apart, allowed is none",
                            human_count(comparison.over(limit.any)), limit.any);
    return text;
}

std::string diff_text(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits) {
    std::string text =
        fmt::format("{} and {}: {} x {}, {}\n\n", a, b, comparison.width, comparison.height,
                    comparison.coding == Coding::Srgb ? "sRGB codes from 0 to 1" : "linear light");
    std::vector<TextRow> rows = {
        {"layer", "pixels that differ", "max", "where: in A, in B", "mean", "RMSE", "PSNR dB"}};
    for (const LayerDifference& layer : comparison.layers)
        rows.push_back(row_of(layer, comparison.worst.size()));
    text += markdown_table(rows) + "\n";
    if (comparison.flip)
        text += fmt::format("FLIP: mean {:.6f}, max {:.6f}\n", comparison.flip->mean,
                            comparison.flip->max);
    text += only_text(comparison.only_in_a, a) + only_text(comparison.only_in_b, b);
    const Verdict verdict = judge(comparison, limits);
    const Limit& limit = verdict == Verdict::Failure ? limits.fail : limits.warn;
    return text +
           fmt::format("{}: {}\n", kVerdicts[size_t(verdict)], limit_text(comparison, limit));
}

static Json errors_json(const std::optional<Errors>& errors) {
    if (!errors)
        return nullptr;
    Json json = {{"max", errors->max},
                 {"mean", errors->mean},
                 {"rmse", errors->rmse},
                 {"psnr", errors->psnr},
                 {"at", nullptr}};
    if (errors->max > 0)
        json["at"] = {{"channel", errors->at.channel},
                      {"x", errors->at.x},
                      {"y", errors->at.y},
                      {"a", errors->at.a},
                      {"b", errors->at.b}};
    return json;
}

static Json limit_json(const Comparison& comparison, const Limit& limit) {
    return {{"each", limit.each},
            {"percent", limit.percent},
            {"any", limit.any},
            {"pixels", comparison.over(limit.each)},
            {"passed", limit.is_passed_by(comparison)}};
}

std::string diff_json(const std::string& a, const std::string& b, const Comparison& comparison,
                      const Limits& limits) {
    Json layers = Json::array();
    for (const LayerDifference& layer : comparison.layers)
        layers.push_back({{"name", layer.name},
                          {"channels", layer.channels},
                          {"differing", layer.differing},
                          {"errors", errors_json(layer.errors)}});
    Json flip = nullptr;
    if (comparison.flip)
        flip = {{"mean", comparison.flip->mean}, {"max", comparison.flip->max}};
    const Json document = {{"a", a},
                           {"b", b},
                           {"width", comparison.width},
                           {"height", comparison.height},
                           {"coding", comparison.coding == Coding::Srgb ? "sRGB" : "linear"},
                           {"layers", layers},
                           {"only_in_a", comparison.only_in_a},
                           {"only_in_b", comparison.only_in_b},
                           {"flip", flip},
                           {"fail", limit_json(comparison, limits.fail)},
                           {"warn", limit_json(comparison, limits.warn)},
                           {"verdict", kVerdicts[size_t(judge(comparison, limits))]}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace ovc
