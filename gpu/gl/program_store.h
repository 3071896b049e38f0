// SPDX-License-Identifier: Apache-2.0
// ProgramStore: programs as the driver compiled them, kept in files from run to run
// (docs/decisions/0010). Losing any of it costs a compilation, nothing else, so nothing that goes
// wrong here is an error.
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
    /// folder: made when something is kept; empty: nothing is kept, nothing found.
    explicit ProgramStore(std::filesystem::path folder, uint64_t max_bytes = kMaxBytes)
        : folder_(std::move(folder)), max_bytes_(max_bytes) {}

    /// What OVC_KERNEL_CACHE names, "off" for none; else overcast/kernels in XDG_CACHE_HOME or in
    /// ~/.cache; else none.
    static std::filesystem::path default_folder();

    /// Makes `program`, which has no stages yet, the one kept for these sources and this driver.
    /// False: there is none, it is damaged, or the driver wants it no more; the program is then to
    /// be linked. The context must be current, as for the next.
    bool load(const std::vector<std::string>& sources, GLuint program) const;

    /// Keeps a linked program, unless the driver hands out none. Whoever reads meanwhile, in this
    /// process or another, finds the file as it was, or whole. What was used longest ago goes where
    /// all is more than max_bytes.
    void keep(const std::vector<std::string>& sources, GLuint program) const;

    static constexpr uint64_t kMaxBytes = 64 << 20;

private:
    std::filesystem::path file_of(uint64_t key) const;
    void make_room() const;

    std::filesystem::path folder_;
    uint64_t max_bytes_;
};

} // namespace ovc
