// SPDX-License-Identifier: Apache-2.0
// Keeps the raw results of a report's runs as files that appear whole, so that a run that is done
// is not repeated.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

#include <filesystem>
#include <optional>

namespace ovc {

/// Returns the program's version and a checksum of its file and of the libraries that it loads:
/// "0.1.0, 5c0ffee000112233".
std::string build_text(const std::filesystem::path& program);

/// Returns DIR/raw/NAME/KEY-HASH.json. The hash covers the build and the run's command, so that
/// another build, or other options, have another file.
std::filesystem::path raw_path(const std::filesystem::path& folder, const Experiment& experiment,
                               const ReportRun& run, const std::string& build);

/// Returns the path of the run's picture, which lies beside its raw result.
std::filesystem::path picture_path(const std::filesystem::path& raw);
/// Returns "raw/NAME/KEY-HASH.png", as the page links to it.
std::string picture_in_report(const std::filesystem::path& picture);

/// Returns the result of the run, or nothing where the run is not done, its picture is missing, or
/// save_raw() did not write the file.
std::optional<RawResult> load_raw(const std::filesystem::path& path, const ReportRun& run);

/// Writes a file with "build", "command", "seconds" and "result". Error: it cannot be written.
Result<Done> save_raw(const std::filesystem::path& path, const RawResult& result,
                      const std::string& build, double seconds);

} // namespace ovc
