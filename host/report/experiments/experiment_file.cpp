// SPDX-License-Identifier: Apache-2.0
// Reads and writes the files of experiments. A file appears whole, so one that is interrupted has
// all runs before.
#include "host/report/experiments/experiment_file.h"

#include "core/file/checksum.h"
#include "core/file/mapped_file.h"
#include "host/backend/plugin_loader.h"
#include "host/doctor/machine_load.h"
#include "host/output/output.h"
#include "host/terminal/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <fstream>

namespace ovc {

namespace {

constexpr const char* kSchema = "overcast-report-1";

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    localtime_r(&now, &parts);
    std::string text(16, '\0');
    text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts));
    return text;
}

Json machine_json() {
    const MachineText machine = describe_machine();
    return {{"processor", machine.processor},
            {"threads", machine.threads},
            {"memory_bytes", machine.memory_bytes},
            {"system", machine.system}};
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

std::string command_of(const ReportRun& run) {
    Words words = run.variables;
    if (run.ranks > 0)
        words.insert(words.end(), {"mpirun", "-n", std::to_string(run.ranks)});
    words.push_back("overcast");
    const std::string first =
        run.before.empty() ? "" : fmt::format("overcast {} && ", fmt::join(run.before, " "));
    return fmt::format("{}{} {}", first, fmt::join(words, " "), fmt::join(run.words, " "));
}

ExperimentFile::ExperimentFile(const std::filesystem::path& folder, const Experiment& experiment,
                               const ReportPlan& plan, const std::string& build)
    : folder_(folder), name_(experiment.name) {
    std::ifstream in(folder_ / (name_ + ".json"));
    const Json there = Json::parse(in, nullptr, /* allow_exceptions= */ false);
    const bool is_ours = there.is_object() && there.value("schema", "") == kSchema &&
                         there.value("program", "") == build;
    file_ = {
        {"schema", kSchema},
        {"experiment", name_},
        {"about", experiment.about},
        {"form", plan.quick ? "quick" : "full"},
        {"date", today()},
        {"program", build},
        {"machine", machine_json()},
        {"again", fmt::format("overcast report{} --only {}{} -o DIR", plan.quick ? " --quick" : "",
                              name_, plan.data.empty() ? "" : " --data DATA")},
        {"complete", false},
        {"runs", is_ours ? there["runs"] : Json::array()}};
}

const Json* ExperimentFile::find(const ReportRun& run) const {
    for (const Json& one : file_["runs"])
        if (one["key"] == run.key && one["command"] == command_of(run))
            return &one;
    return nullptr;
}

bool ExperimentFile::has(const ReportRun& run) const {
    const Json* const one = find(run);
    return one && (*one)["result"].is_object() && (*one)["trouble"].is_null() &&
           (run.picture.empty() || std::filesystem::exists(picture_path(run)));
}

Result<Done> ExperimentFile::keep(Json one) {
    auto& runs = file_["runs"].get_ref<Json::array_t&>();
    std::erase_if(runs, [&](const Json& other) { return other["key"] == one["key"]; });
    runs.push_back(std::move(one));
    return save();
}

Result<bool> ExperimentFile::finish(std::span<const ReportRun> runs) {
    Json kept = Json::array();
    for (const ReportRun& run : runs)
        if (const Json* const one = find(run))
            kept.push_back(*one);
    file_["complete"] = kept.size() == runs.size();
    file_["runs"] = std::move(kept);
    if (const Result<Done> saved = save(); !saved)
        return saved.error();
    return file_["complete"].get<bool>();
}

std::vector<std::string> ExperimentFile::troubles() const {
    std::vector<std::string> troubles;
    for (const Json& one : file_["runs"])
        if (!one["trouble"].is_null())
            troubles.push_back(fmt::format("{}, {}: {}", name_, one["key"].get<std::string>(),
                                           one["trouble"].get<std::string>()));
    return troubles;
}

std::filesystem::path ExperimentFile::picture_path(const ReportRun& run) const {
    return folder_ / "pictures" / fmt::format("{}-{}.png", name_, run.key);
}

Result<Done> ExperimentFile::save() const {
    return save_text(file_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                     folder_ / (name_ + ".json"));
}

} // namespace ovc
