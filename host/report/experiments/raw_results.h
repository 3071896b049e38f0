// SPDX-License-Identifier: Apache-2.0
// The raw results of a report's runs: files that appear whole, so that a run that is done is not
// repeated.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

#include <filesystem>
#include <optional>

namespace ovc {

/// What ran: the program's version, and a checksum of its file and those of the libraries it loads.
/// "0.1.0, 5c0ffee000112233"
std::string build_text(const std::filesystem::path& program);

/// DIR/raw/NAME/KEY-HASH.json. The hash is of the build and the run's words, so another build, or
/// other options, is another file.
std::filesystem::path raw_path(const std::filesystem::path& folder, const Experiment& experiment,
                               const ReportRun& run, const std::string& build);

/// Of its picture, beside it.
std::filesystem::path picture_path(const std::filesystem::path& raw);
/// "raw/NAME/KEY-HASH.png", as the page links to it.
std::string picture_in_report(const std::filesystem::path& picture);

/// Nothing where the run is not done, or its file is not what save_raw() writes.
std::optional<RawResult> load_raw(const std::filesystem::path& path, const ReportRun& run);

/// The file has "build", "command", "seconds" and "result". Error: it cannot be written.
Result<Done> save_raw(const std::filesystem::path& path, const RawResult& result,
                      const std::string& build, double seconds);

} // namespace ovc
