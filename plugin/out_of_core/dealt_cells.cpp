// SPDX-License-Identifier: Apache-2.0
// DealtCells: appends to buffers, and sorts a cell by names when it is read, because threads add
// triangles in any order.
#include "plugin/out_of_core/dealt_cells.h"

#include "core/file/checksum.h"
#include "plugin/out_of_core/build_steps.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace ovc {
namespace {

/// Records stay aligned to 8 bytes, so that doubles may be used in place.
size_t record_bytes_of(std::span<const SourceMesh> meshes) {
    size_t corners = 0;
    for (const SourceMesh& mesh : meshes)
        corners = std::max(corners, mesh.triangle_bytes());
    return (sizeof(TriangleId) + corners + 7) / 8 * 8;
}

TriangleId name_at(const std::byte* record) {
    TriangleId name;
    std::memcpy(&name, record, sizeof(name));
    return name;
}

} // namespace

DealtCells::DealtCells(size_t cells, std::span<const SourceMesh> meshes, uint64_t buffer_bytes,
                       ScratchSpace& scratch)
    : meshes_(meshes),
      scratch_(scratch),
      record_bytes_(record_bytes_of(meshes)),
      full_bytes_(std::max<size_t>(buffer_bytes / record_bytes_, 1) * record_bytes_),
      cells_(cells) {}

void DealtCells::add(size_t cell, TriangleId name, Bytes corners, const Box& bounds) {
    assert(sizeof(name) + corners.size() <= record_bytes_);
    Cell& to = cells_[cell];
    const std::lock_guard lock(to.mutex);
    const size_t at = to.buffer.size();
    if (at == 0)
        to.buffer.reserve(full_bytes_);
    to.buffer.resize(at + record_bytes_);
    std::memcpy(to.buffer.data() + at, &name, sizeof(name));
    std::memcpy(to.buffer.data() + at + sizeof(name), corners.data(), corners.size());
    to.dealt.count += 1;
    to.dealt.bounds.add(bounds);
    if (to.buffer.size() == full_bytes_)
        write_out(to);
}

void DealtCells::write_out(Cell& cell) {
    const uint64_t offset = scratch_.allocate(cell.buffer.size());
    scratch_.write(offset, cell.buffer);
    cell.dealt.extents.push_back({offset, checksum_of(cell.buffer)});
    cell.buffer.clear();
}

void DealtCells::flush(size_t cell) {
    Cell& from = cells_[cell];
    if (!from.buffer.empty())
        write_out(from);
    std::vector<std::byte>().swap(from.buffer);
}

void DealtCells::clear(size_t cell) {
    cells_[cell].dealt = {};
}

std::vector<DealtCell> DealtCells::dealt() const {
    std::vector<DealtCell> all;
    for (const Cell& cell : cells_)
        all.push_back(cell.dealt);
    return all;
}

void DealtCells::restore(std::vector<DealtCell> dealt) {
    if (dealt.size() != cells_.size())
        BuildSteps::fail();
    for (size_t c = 0; c < cells_.size(); ++c) {
        const uint64_t bytes = dealt[c].count * record_bytes_;
        if (dealt[c].extents.size() != (bytes + full_bytes_ - 1) / full_bytes_)
            BuildSteps::fail();
        cells_[c].dealt = std::move(dealt[c]);
    }
}

size_t DealtCells::extent_bytes(const Cell& cell, size_t extent) const {
    return std::min(full_bytes_, cell.dealt.count * record_bytes_ - extent * full_bytes_);
}

void DealtCells::read_extent(const Cell& cell, size_t extent, std::span<std::byte> to) const {
    assert(cell.buffer.empty() && to.size() == extent_bytes(cell, extent));
    const DealtExtent& from = cell.dealt.extents[extent];
    scratch_.read(from.offset, to);
    if (checksum_of(to) != from.checksum)
        throw damaged_scratch();
}

Bytes DealtCells::corners_of(const std::byte* record, TriangleId name) const {
    return {record + sizeof(TriangleId), meshes_[name.mesh].triangle_bytes()};
}

void DealtCells::for_each(size_t cell, FunctionRef<void(TriangleId, Bytes)> visit) const {
    const Cell& from = cells_[cell];
    std::vector<std::byte> records;
    for (size_t extent = 0; extent < from.dealt.extents.size(); ++extent) {
        records.resize(extent_bytes(from, extent));
        read_extent(from, extent, records);
        for (size_t at = 0; at < records.size(); at += record_bytes_) {
            const TriangleId name = name_at(records.data() + at);
            visit(name, corners_of(records.data() + at, name));
        }
    }
}

LocalSoup DealtCells::read(size_t cell) const {
    const Cell& from = cells_[cell];
    std::vector<std::byte> records(from.dealt.count * record_bytes_);
    for (size_t extent = 0; extent < from.dealt.extents.size(); ++extent)
        read_extent(from, extent,
                    std::span(records).subspan(extent * full_bytes_, extent_bytes(from, extent)));
    struct Record {
        TriangleId name;
        uint32_t record;
    };
    std::vector<Record> order(from.dealt.count);
    for (uint32_t i = 0; i < order.size(); ++i)
        order[i] = {name_at(records.data() + i * record_bytes_), i};
    std::ranges::sort(order, {}, &Record::name);
    LocalSoup soup(meshes_);
    for (const Record& place : order)
        soup.add(place.name, corners_of(records.data() + place.record * record_bytes_, place.name));
    soup.finish();
    return soup;
}

} // namespace ovc
