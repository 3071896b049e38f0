// SPDX-License-Identifier: Apache-2.0
// SceneOnDisk: the parts of a scene file that are not read into memory.
#pragma once

#include "core/file/disk_file.h"
#include "core/file/stored_corners.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

/// Corners of floats that lie one behind the other in a file, which outlives this.
class FileCorners final : public StoredCorners {
public:
    FileCorners(const DiskFile& file, uint64_t offset) : file_(file), offset_(offset) {}

    bool has_doubles() const override { return false; }
    bool read(uint32_t first, std::span<std::byte> to) const override {
        if (file_.read(offset_ + first * uint64_t(triangle_bytes()), to))
            return true;
        std::ranges::fill(to, std::byte(0));
        return false;
    }

private:
    const DiskFile& file_;
    const uint64_t offset_;
};

struct SceneOnDisk {
    DiskFile file;
    std::vector<std::unique_ptr<FileCorners>> meshes; // of the chunks that are stored
    uint64_t corners_checksum = 0;                    // of all of them
    uint64_t levels_offset = 0; // of what the plugin saved (ovc_scene_config.read_saved)
    uint64_t levels_bytes = 0;

    explicit SceneOnDisk(DiskFile opened) : file(std::move(opened)) {}
};

} // namespace ovc
