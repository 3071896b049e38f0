// SPDX-License-Identifier: Apache-2.0
#include "gpu/tuning/tuning_record.h"

#include "core/file/checksum.h"
#include "core/file/replace_file.h"
#include "core/text/format_text.h"
#include "shaders/sources.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace ovc {

namespace fs = std::filesystem;

// To be counted up whenever C++ changes what a variant means; kernels are in the file's name.
static constexpr std::string_view kFirstLine = "overcast kernel variants 3";

/// Returns the last line, which tells a whole text from one that was cut or changed.
static std::string checksum_line(const std::string& text) {
    const uint64_t checksum = checksum_of(bytes_of(std::span<const char>(text)));
    return format_text("checksum {}\n", hexadecimal(checksum, 16));
}

std::string TuningRecord::text() const {
    std::string text(kFirstLine);
    text += format_text("\nmicroseconds {}\n", uint64_t(seconds * 1e6));
    for (size_t kind = 0; kind < chosen.size(); ++kind)
        if (chosen[kind])
            text += format_text("kind {} {}\n", kind, chosen[kind]->text());
    return text + checksum_line(text);
}

std::optional<TuningRecord> TuningRecord::from_text(const std::string& text) {
    const size_t end = std::min(text.rfind("checksum "), text.size());
    const std::string checked = text.substr(0, end);
    if (text.substr(end) != checksum_line(checked))
        return {};
    std::istringstream lines(checked);
    std::string line, word, variant;
    if (!std::getline(lines, line) || line != kFirstLine)
        return {};
    TuningRecord record;
    uint64_t microseconds = 0;
    if (!(lines >> word >> microseconds) || word != "microseconds")
        return {};
    record.seconds = 1e-6 * double(microseconds);
    for (size_t kind = 0; lines >> word;) {
        if (word != "kind" || !(lines >> kind >> variant) || kind >= record.chosen.size())
            return {};
        const Result<KernelVariant> parsed = parse_variant(variant);
        if (!parsed)
            return {};
        record.chosen[kind] = *parsed;
    }
    return record;
}

TuningFile::TuningFile(const fs::path& folder, const std::string& driver) {
    if (folder.empty())
        return;
    Checksum key;
    key.add(std::as_bytes(std::span(driver)));
    for (const ShaderSource& source : shader_sources()) {
        key.add_value(source.text.size());
        key.add(std::as_bytes(std::span(source.text)));
    }
    path_ = folder / (hexadecimal(key.value(), 16) + ".variants");
}

std::optional<TuningRecord> TuningFile::load() const {
    std::ifstream file(path_, std::ios::binary);
    if (path_.empty() || !file)
        return {};
    std::ostringstream text;
    text << file.rdbuf();
    return TuningRecord::from_text(text.str());
}

void TuningFile::keep(const TuningRecord& record) const {
    if (path_.empty())
        return;
    std::error_code failed;
    fs::create_directories(path_.parent_path(), failed);
    const std::string text = record.text();
    replace_file(path_, bytes_of(std::span<const char>(text)));
}

} // namespace ovc
