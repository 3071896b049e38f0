// SPDX-License-Identifier: Apache-2.0
// TuningRecord: the variants that were found fastest on a device, kept in a file from run to run. A
// lost file only costs another measurement, so no failure here is an error.
#pragma once

#include "gpu/tuning/kernel_variant.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace ovc {

struct TuningRecord {
    double seconds = 0; // that measuring has taken in all runs
    std::array<std::optional<KernelVariant>, RayKind::kCount> chosen{};

    /// Returns the lines of a file. from_text() takes no other text than what this writes.
    std::string text() const;
    static std::optional<TuningRecord> from_text(const std::string& text);
};

/// The file of the record for a driver's names and these kernels.
class TuningFile {
public:
    /// folder: created when a record is kept. If it is empty, nothing is kept. driver: what tells
    /// one driver from another.
    TuningFile(const std::filesystem::path& folder, const std::string& driver);

    std::optional<TuningRecord> load() const;
    /// Replaces the file at once, so that a process that reads meanwhile finds the old or the new.
    void keep(const TuningRecord& record) const;

private:
    std::filesystem::path path_; // empty: nothing is kept
};

} // namespace ovc
