// SPDX-License-Identifier: Apache-2.0
// Names, reads and writes the files of raw results.
#include "host/report/experiments/raw_results.h"

#include "core/file/checksum.h"
#include "core/file/mapped_file.h"
#include "host/backend/plugin_loader.h"
#include "host/output/output.h"
#include "host/terminal/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>

namespace ovc {

namespace {

std::string command_of(const ReportRun& run) {
    return fmt::format("{}{}overcast {}", fmt::join(run.variables, " "),
                       run.variables.empty() ? "" : " ", fmt::join(run.words, " "));
}

} // namespace

std::string build_text(const std::filesystem::path& program) {
    Checksum sum;
    for (const std::filesystem::path& path : {program, std::filesystem::path(find_plugin(kProduct)),
                                              std::filesystem::path(find_plugin(kThesis))})
        if (const Result<MappedFile> file = MappedFile::open(path); file)
            sum.add_value(checksum_of(file->bytes()));
    return fmt::format("{}, {:016x}", version_text(), sum.value());
}

std::filesystem::path raw_path(const std::filesystem::path& folder, const Experiment& experiment,
                               const ReportRun& run, const std::string& build) {
    const std::string what = build + " " + command_of(run);
    return folder / "raw" / experiment.name /
           fmt::format("{}-{:016x}.json", run.key, checksum_of(std::as_bytes(std::span(what))));
}

std::filesystem::path picture_path(const std::filesystem::path& raw) {
    return std::filesystem::path(raw).replace_extension(".png");
}

std::string picture_in_report(const std::filesystem::path& picture) {
    const std::filesystem::path folder = picture.parent_path();
    return (folder.parent_path().filename() / folder.filename() / picture.filename()).string();
}

std::optional<RawResult> load_raw(const std::filesystem::path& path, const ReportRun& run) {
    std::ifstream file(path);
    const Json raw = Json::parse(file, nullptr, /* allow_exceptions= */ false);
    if (!raw.is_object() || !raw.contains("result"))
        return {};
    RawResult result{run, raw["result"]};
    if (run.picture.empty())
        return result;
    const std::filesystem::path picture = picture_path(path);
    if (!std::filesystem::exists(picture))
        return {};
    result.picture = picture_in_report(picture);
    return result;
}

Result<Done> save_raw(const std::filesystem::path& path, const RawResult& result,
                      const std::string& build, double seconds) {
    const Json raw = {{"build", build},
                      {"command", command_of(result.run)},
                      {"seconds", seconds},
                      {"result", result.result}};
    return save_text(raw.dump(1, ' ', false, Json::error_handler_t::replace) + "\n", path);
}

} // namespace ovc
