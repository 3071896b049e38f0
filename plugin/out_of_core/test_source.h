// SPDX-License-Identifier: Apache-2.0
// A source over a soup and scratch space in memory, for tests.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"
#include "plugin/structure/triangle_source.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <vector>

namespace ovc::test {

/// Reads from a soup without transforms, which outlives it.
class SoupSource final : public TriangleSource {
public:
    explicit SoupSource(const Soup& soup) : soup_(soup) {
        for (const Chunk& chunk : soup.chunks)
            meshes_.push_back({chunk.origin(), chunk.size(), !chunk.double_corners().empty()});
    }

    std::span<const SourceMesh> meshes() const override { return meshes_; }
    void read(uint32_t mesh, uint64_t first, std::span<std::byte> corners) override {
        if (reads_left_.fetch_sub(1) <= 0)
            throw Cancelled();
        const Chunk& chunk = soup_.chunks[mesh];
        std::memcpy(corners.data(), chunk.address_of(uint32_t(first)), corners.size());
    }

    /// Makes reads fail after so many.
    void fail_after(int reads) { reads_left_ = reads; }

private:
    const Soup& soup_;
    std::vector<SourceMesh> meshes_;
    std::atomic<int> reads_left_{1 << 30};
};

class ScratchMemory final : public ScratchSpace {
public:
    ScratchMemory() = default;
    /// Takes the bytes of another, but forgets what was allocated, as a file is found.
    explicit ScratchMemory(const ScratchMemory& other) : memory_(other.memory_) {}
    /// Changes a byte in every hundred from an offset on.
    void spoil(size_t offset) {
        for (; offset < memory_.size(); offset += 100)
            memory_[offset] ^= std::byte(1);
    }

    void write(uint64_t offset, Bytes bytes) override {
        const std::lock_guard lock(mutex_);
        memory_.resize(std::max(memory_.size(), size_t(offset + bytes.size())));
        std::ranges::copy(bytes, memory_.begin() + ptrdiff_t(offset));
    }
    void read(uint64_t offset, std::span<std::byte> bytes) override {
        const std::lock_guard lock(mutex_);
        std::copy_n(memory_.begin() + ptrdiff_t(offset), bytes.size(), bytes.begin());
    }

private:
    std::mutex mutex_;
    std::vector<std::byte> memory_;
};

/// Keeps steps in memory.
class StepMemory final : public StepKeeper {
public:
    /// As after a build that ended behind its first `steps` steps. written: what it wrote.
    StepMemory(std::span<const std::vector<std::byte>> steps = {}, Bytes written = {})
        : found_(steps.begin(), steps.end()),
          kept_(found_.begin(), found_.end()),
          written_(written) {}

    std::span<const Bytes> kept() const override { return kept_; }
    void keep(Bytes step) override { all_.emplace_back(step.begin(), step.end()); }
    void read_written(uint64_t offset, std::span<std::byte> to) override {
        std::copy_n(written_.begin() + ptrdiff_t(offset), to.size(), to.begin());
    }

    /// Returns the steps that were kept anew.
    const std::vector<std::vector<std::byte>>& steps() const { return all_; }

private:
    const std::vector<std::vector<std::byte>> found_;
    const std::vector<Bytes> kept_;
    const Bytes written_;
    std::vector<std::vector<std::byte>> all_;
};

} // namespace ovc::test
