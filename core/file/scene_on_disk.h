// SPDX-License-Identifier: Apache-2.0
// SceneOnDisk: the parts of a scene file that are not read into memory.
#pragma once

#include "core/file/disk_file.h"
#include "core/file/file_blocks.h"
#include "core/file/stored_corners.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

class SceneOnDisk;

/// Three values for each triangle of a mesh that lie in a scene file: normals, or texture
/// coordinates.
class StoredValues {
public:
    StoredValues(SceneOnDisk& disk, FileBlocks blocks, std::string what)
        : disk_(disk), blocks_(blocks), what_(std::move(what)) {}

    uint64_t triangles() const { return blocks_.records(); }
    /// Reads the values of some triangles. Where they cannot be read, `to` becomes zeros, and
    /// SceneOnDisk::checked() tells why.
    bool read(uint64_t first, std::span<std::byte> to) const;
    bool read_unchecked(uint64_t first, std::span<std::byte> to) const {
        return blocks_.read_unchecked(first, to);
    }

private:
    SceneOnDisk& disk_;
    const FileBlocks blocks_;
    const std::string what_; // "corners of mesh 3"
};

/// Corners of floats.
class FileCorners final : public StoredCorners {
public:
    explicit FileCorners(StoredValues values) : values_(std::move(values)) {}

    bool has_doubles() const override { return false; }
    bool read(uint32_t first, std::span<std::byte> to) const override {
        return values_.read(first, to);
    }
    bool read_unchecked(uint32_t first, std::span<std::byte> to) const override {
        return values_.read_unchecked(first, to);
    }

private:
    const StoredValues values_;
};

/// What shading needs of a scene comes through a cache of its own, which takes a part of the budget
/// of host memory.
class SceneOnDisk {
    const std::shared_ptr<const DiskFile> opened_;

public:
    /// budget_bytes: of all that reads the scene, the plugin too. sums: of the blocks of all
    /// values.
    SceneOnDisk(std::shared_ptr<const DiskFile> opened, uint64_t budget_bytes,
                std::vector<uint64_t> sums);
    SceneOnDisk(const SceneOnDisk&) = delete;

    const DiskFile& file;
    std::vector<std::unique_ptr<FileCorners>> meshes; // of the chunks that are stored
    std::vector<std::unique_ptr<StoredValues>> values;
    uint64_t values_checksum = 0; // of all corners, normals and texture coordinates
    uint64_t levels_offset = 0;   // of what the plugin saved (ovc_scene_config.read_saved)
    uint64_t levels_bytes = 0;

    BlockReader& reader() { return reader_; }
    uint64_t budget_bytes() const { return budget_; }
    /// Returns the most of it that the cache and the checksums here may take.
    uint64_t own_bytes() const { return own_bytes_of(budget_, reader_.sums.size()); }
    /// Returns the same of another budget and a file with so many blocks of values.
    static uint64_t own_bytes_of(uint64_t budget_bytes, uint64_t blocks);
    /// Returns what that leaves for the plugin.
    uint64_t for_plugin() const { return for_plugin_of(budget_); }
    /// Returns the smallest budget that leaves so much.
    uint64_t smallest_budget(uint64_t for_plugin) const;
    /// Returns how much memory the cache and the checksums have taken.
    uint64_t bytes() const;
    uint64_t read_bytes() const { return reader_.cached_bytes; }
    uint64_t hits() const { return reader_.cache.hits(); }
    uint64_t misses() const { return reader_.cache.misses(); }

    /// Returns the error of the library, which knows neither the file nor why its disk failed.
    Error explained(Error error) const;
    /// Returns the result of work that read values. Error: some of them were not there, so that the
    /// result is not of this scene.
    template <class T>
    Result<T> checked(Result<T> result) const {
        if (!result)
            return result;
        const std::lock_guard lock(mutex_);
        return lost_ ? Result<T>(explained(*lost_)) : std::move(result);
    }
    /// Notes values that somebody needed and that are not there.
    void lose(const std::string& what, uint64_t first, uint64_t count);

private:
    uint64_t for_plugin_of(uint64_t budget_bytes) const;

    const uint64_t budget_;
    BlockReader reader_;
    mutable std::mutex mutex_; // guards the next
    std::optional<Error> lost_;
};

/// Three values a triangle, in memory or on a disk.
template <class T>
class PerCorner {
public:
    explicit PerCorner(std::span<const T> values) : values_(values) {}
    explicit PerCorner(const StoredValues& stored) : stored_(&stored) {}

    bool empty() const { return size() == 0; }
    uint64_t size() const { return stored_ ? 3 * stored_->triangles() : values_.size(); }
    std::array<T, 3> of(uint32_t prim) const {
        std::array<T, 3> all{};
        if (stored_)
            stored_->read(prim, std::as_writable_bytes(std::span(all)));
        else
            for (size_t i = 0; i < 3; ++i)
                all[i] = values_[3 * size_t(prim) + i];
        return all;
    }

private:
    std::span<const T> values_;
    const StoredValues* stored_ = nullptr;
};

} // namespace ovc
