// SPDX-License-Identifier: Apache-2.0
// The raw results of a report's runs: files that appear whole, so that a run that is done is not
// repeated.
#pragma once

#include "core/result.h"
#include "host/report/experiment.h"

#include <filesystem>
#include <optional>

namespace ovc {

/// DIR/raw/NAME/KEY-HASH.json. The hash is of the program's version and the run's words, so another
/// version, or other options, is another file.
std::filesystem::path raw_path(const std::filesystem::path& folder, const Experiment& experiment,
                               const ReportRun& run);

/// Of its picture, beside it.
std::filesystem::path picture_path(const std::filesystem::path& raw);
/// "raw/NAME/KEY-HASH.png", as the page links to it.
std::string picture_in_report(const std::filesystem::path& picture);

/// Nothing where the run is not done, or its file is not what save_raw() writes.
std::optional<RawResult> load_raw(const std::filesystem::path& path, const ReportRun& run);

/// The file has "version", "command", "seconds" and "result". Error: it cannot be written.
Result<Done> save_raw(const std::filesystem::path& path, const RawResult& result, double seconds);

} // namespace ovc
