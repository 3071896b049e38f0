// SPDX-License-Identifier: Apache-2.0
// SceneOnDisk: the parts of a scene file that are not read into memory.
#pragma once

#include "core/file/disk_file.h"
#include "core/file/stored_corners.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

/// Corners of floats that lie one behind the other in a file, which outlives this.
class FileCorners final : public StoredCorners {
public:
    /// were_lost: set to true where corners become zeros; outlives this, too.
    FileCorners(const DiskFile& file, std::atomic<bool>& were_lost, uint64_t offset)
        : file_(file), were_lost_(were_lost), offset_(offset) {}

    bool has_doubles() const override { return false; }
    bool read(uint32_t first, std::span<std::byte> to) const override {
        if (file_.read(offset_ + first * uint64_t(triangle_bytes()), to))
            return true;
        were_lost_ = true;
        std::ranges::fill(to, std::byte(0));
        return false;
    }

private:
    const DiskFile& file_;
    std::atomic<bool>& were_lost_;
    const uint64_t offset_;
};

struct SceneOnDisk {
    DiskFile file;
    std::atomic<bool> corners_were_lost{false};       // the disk failed where somebody needed them
    std::vector<std::unique_ptr<FileCorners>> meshes; // of the chunks that are stored
    uint64_t corners_checksum = 0;                    // of all of them
    uint64_t levels_offset = 0; // of what the plugin saved (ovc_scene_config.read_saved)
    uint64_t levels_bytes = 0;

    explicit SceneOnDisk(DiskFile opened) : file(std::move(opened)) {}

    /// Returns the error of the library, which knows neither the file nor why its disk failed.
    Error explained(Error error) const {
        if (error.kind != ErrorKind::Unreadable)
            return error;
        const std::optional<std::string> why = file.failure();
        error.message = file.path().string() + ": " + error.message + (why ? ": " + *why : "");
        return error;
    }
    /// Returns the result of work that read corners. Error: some of them were not there, so that
    /// the result is not of this scene.
    template <class T>
    Result<T> checked(Result<T> result) const {
        return result && corners_were_lost ? Result<T>(*file.error()) : std::move(result);
    }
};

} // namespace ovc
