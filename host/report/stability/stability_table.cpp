// SPDX-License-Identifier: Apache-2.0
// Writes the stability suite as text.
#include "host/report/stability/stability_table.h"

#include "host/arguments/memory_size.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ovc {

static constexpr const char* kLegend =
    R"(Each ray is answered by the plugin and by the reference, core/exact/triangle.h through a KD-tree on the
CPU.

- *wrong*: for certified mode, answers of which any bit of t, u, v or the name differs from the
  reference's, occlusion included.
- *leaks*: rays that must hit, as the mesh is closed where they are aimed at, and do not; "-" where a
  ray may miss.
- *t error*: the largest relative difference to the reference's t, of rays that both say hit; where
  another triangle is named it is the distance between the two.
- *flagged*: answers that float32 could not prove, counted in each leaf that a ray visits;
  *retraced*: of them, traced again as a whole.
- *us/ray*: nearest hits in certified mode, from call to return.
)";

static constexpr const char* kPeerLegend =
    R"(- *fast*: the plugin without the proofs; *Embree*: Embree 3 as it is by default and in its robust
  mode, where this program was built with it. Theirs is *wrong* when another triangle is named than
  the reference's, unless the reference hits that one too at the same t (to 2^-40). Embree has floats
  only: positions and rays are rounded to them. It refuses numbers beyond 1.8e18, which count as
  misses.
)";

namespace {

using Row = std::vector<std::string>;

struct PeerColumn {
    const char* name;
    std::optional<StabilityScore> StabilityResult::*score;
};

constexpr PeerColumn kPeers[] = {{"fast", &StabilityResult::fast},
                                 {"Embree robust", &StabilityResult::embree_robust},
                                 {"Embree default", &StabilityResult::embree_default}};

/// Returns the peers that ran in any case.
std::vector<PeerColumn> peers_of(std::span<const StabilityResult> results) {
    std::vector<PeerColumn> peers;
    for (const PeerColumn& peer : kPeers)
        if (std::ranges::any_of(results,
                                [&](const auto& r) { return (r.*peer.score).has_value(); }))
            peers.push_back(peer);
    return peers;
}

Row header_of(std::span<const PeerColumn> peers) {
    Row row = {"case",    "triangles", "rays",       "wrong", "leaks",
               "t error", "flagged %", "retraced %", "us/ray"};
    for (const PeerColumn& peer : peers)
        for (const char* column : {"wrong", "leaks", "t err"})
            row.push_back(fmt::format("{} {}", peer.name, column));
    return row;
}

std::string percent(uint64_t part, uint64_t whole) {
    return fmt::format("{:.2f}", whole ? 100.0 * double(part) / double(whole) : 0.0);
}

std::string leaks(const StabilityScore& score, bool closed) {
    return closed ? fmt::format("{}", score.leaks) : "-";
}

void add(Row& row, const std::optional<StabilityScore>& peer, bool closed) {
    if (!peer)
        row.insert(row.end(), {"-", "-", "-"});
    else
        row.insert(row.end(), {fmt::format("{}", peer->wrong), leaks(*peer, closed),
                               fmt::format("{:.1e}", peer->t_error)});
}

Row row_of(const StabilityResult& r, std::span<const PeerColumn> peers) {
    Row row = {r.name,
               fmt::format("{}", r.triangles),
               fmt::format("{}", r.rays),
               fmt::format("{}", r.certified.wrong + r.wrong_occlusions),
               leaks(r.certified, r.closed),
               r.certified.t_error == 0 ? "0" : fmt::format("{:.1e}", r.certified.t_error),
               percent(r.flagged, r.rays),
               percent(r.retraced, r.rays),
               fmt::format("{:.2f}", r.microseconds)};
    for (const PeerColumn& peer : peers)
        add(row, r.*peer.score, r.closed);
    return row;
}

/// Aligns the first cell left and the others right.
std::string line_of(const Row& row, const std::vector<size_t>& widths) {
    std::string line = fmt::format("| {:<{}} |", row[0], widths[0]);
    for (size_t i = 1; i < row.size(); ++i)
        line += fmt::format(" {:>{}} |", row[i], widths[i]);
    return line + "\n";
}

std::string rule_of(const std::vector<size_t>& widths) {
    std::string line = fmt::format("|{:-<{}}|", "", widths[0] + 2);
    for (size_t i = 1; i < widths.size(); ++i)
        line += fmt::format("{:->{}}|", ":", widths[i] + 2);
    return line + "\n";
}

std::string table_of(const std::vector<Row>& rows) {
    std::vector<size_t> widths(rows[0].size());
    for (const Row& row : rows)
        for (size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string text = line_of(rows[0], widths) + rule_of(widths);
    for (size_t i = 1; i < rows.size(); ++i)
        text += line_of(rows[i], widths);
    return text;
}

std::string sums_of(std::span<const StabilityResult> results) {
    uint64_t rays = 0, wrong = 0, leaked = 0, reference_leaks = 0, miscounted = 0;
    std::string ratios;
    for (const StabilityResult& r : results) {
        rays += r.rays;
        wrong += r.certified.wrong + r.wrong_occlusions;
        leaked += r.certified.leaks;
        reference_leaks += r.reference_leaks;
        miscounted += r.miscounted;
        if (r.time_ratio > 0)
            ratios += fmt::format(
                "{}: {:.2f} times the time of '{}'{}, {} invalid rays and {} dropped "
                "triangles counted.\n",
                r.name, r.time_ratio, r.time_as,
                r.bar > 0 ? fmt::format(" (bar: {:.0f})", r.bar) : "", r.invalid, r.dropped);
    }
    return fmt::format("\n{} cases, {} rays. Certified: {} wrong, {} leaks; the reference: {} "
                       "leaks; {} miscounted.\n{}",
                       results.size(), human_count(rays), wrong, leaked, reference_leaks,
                       miscounted, ratios);
}

nlohmann::ordered_json json_of(const StabilityScore& score) {
    return {{"wrong", score.wrong}, {"leaks", score.leaks}, {"t_error", score.t_error}};
}

nlohmann::ordered_json json_of(const StabilityResult& r) {
    nlohmann::ordered_json object = {{"name", r.name},
                                     {"closed", r.closed},
                                     {"triangles", r.triangles},
                                     {"dropped", r.dropped},
                                     {"rays", r.rays},
                                     {"invalid", r.invalid},
                                     {"hits", r.hits},
                                     {"reference_leaks", r.reference_leaks},
                                     {"wrong_occlusions", r.wrong_occlusions},
                                     {"miscounted", r.miscounted},
                                     {"flagged", r.flagged},
                                     {"retraced", r.retraced},
                                     {"microseconds", r.microseconds},
                                     {"certified", json_of(r.certified)}};
    if (r.time_ratio > 0)
        object["time_ratio"] = r.time_ratio;
    if (r.bar > 0)
        object["bar"] = r.bar;
    if (r.fast)
        object["fast"] = json_of(*r.fast);
    if (r.embree_robust)
        object["embree_robust"] = json_of(*r.embree_robust);
    if (r.embree_default)
        object["embree_default"] = json_of(*r.embree_default);
    return object;
}

nlohmann::ordered_json json_of(const OpticsResult& r) {
    return {{"name", r.name},         {"rays", r.score.rays},   {"wrong", r.score.wrong},
            {"leaks", r.score.leaks}, {"error", r.score.error}, {"wrong_means", r.counted}};
}

template <class Result>
nlohmann::ordered_json list_of(std::span<const Result> results) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Result& result : results)
        list.push_back(json_of(result));
    return list;
}

} // namespace

std::string stability_markdown(const std::string& title, std::span<const StabilityResult> results) {
    const std::vector<PeerColumn> peers = peers_of(results);
    std::vector<Row> rows = {header_of(peers)};
    for (const StabilityResult& result : results)
        rows.push_back(row_of(result, peers));
    const std::string renderer =
        results.empty() ? "" : fmt::format("Renderer: {}\n\n", results[0].renderer);
    return fmt::format("# {}\n\n{}{}\n{}{}{}", title, kLegend, peers.empty() ? "" : kPeerLegend,
                       renderer, table_of(rows), sums_of(results));
}

std::string stability_json(std::span<const StabilityResult> results,
                           std::span<const OpticsResult> optics) {
    nlohmann::ordered_json document = {{"renderer", results.empty() ? "" : results[0].renderer},
                                       {"cases", list_of(results)}};
    if (!optics.empty())
        document["optics"] = list_of(optics);
    return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace ovc
