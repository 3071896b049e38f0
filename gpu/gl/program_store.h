// SPDX-License-Identifier: Apache-2.0
// ProgramStore: keeps programs as the driver compiled them, in files from run to run
// (docs/decisions/0010). A lost file only costs a compilation, so no failure here is an error.
#pragma once

#include "gpu/gl/gl.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

class ProgramStore {
public:
    /// folder: created when a program is kept. If it is empty, the store keeps and finds nothing.
    explicit ProgramStore(std::filesystem::path folder, uint64_t max_bytes = kMaxBytes)
        : folder_(std::move(folder)), max_bytes_(max_bytes) {}

    /// The folder that OVC_KERNEL_CACHE names, "off" for none; else overcast/kernels in
    /// XDG_CACHE_HOME or in ~/.cache; else none.
    static std::filesystem::path default_folder();

    /// Loads the program that is kept for these sources and this driver into `program`, which has
    /// no stages yet. Returns false if there is none, if it is damaged, or if the driver rejects
    /// it; the caller must then link. The context must be current, as for keep().
    bool load(const std::vector<std::string>& sources, GLuint program) const;

    /// Keeps a linked program, unless the driver hands out no binary. A process that reads at the
    /// same time finds the old file or the whole new one. Above max_bytes, the least recently used
    /// programs are removed.
    void keep(const std::vector<std::string>& sources, GLuint program) const;

    static constexpr uint64_t kMaxBytes = 64 << 20;

private:
    std::filesystem::path file_of(uint64_t key) const;
    void make_room() const;

    std::filesystem::path folder_;
    uint64_t max_bytes_;
};

} // namespace ovc
