// SPDX-License-Identifier: Apache-2.0
// Writes scene files, and tells their size and their checksum without writing them.
#include "core/file/file_blocks.h"
#include "core/file/value_bytes.h"
#include "importers/readers.h"
#include "importers/scene_file/scene_fields.h"
#include "importers/scene_file/scene_file.h"
#include "importers/scene_file/scene_file_format.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <utility>

namespace ovc {

namespace {

std::vector<MeshExtent> extents_of(const Scene& scene) {
    assert(scene.meshes.size() == scene.soup.chunks.size());
    std::vector<MeshExtent> extents;
    std::map<Chunk::MeshKey, size_t> first_of;
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const Chunk& chunk = scene.soup.chunks[m];
        const MeshInfo& mesh = scene.meshes[m];
        MeshExtent extent{chunk.origin(), chunk.corners().size(), mesh.normals.size(),
                          mesh.uv.size()};
        if (chunk.stored_corners())
            extent.corners = 3 * uint64_t(chunk.size());
        if (mesh.stored_normals)
            extent.normals = 3 * mesh.stored_normals->triangles();
        if (mesh.stored_uv)
            extent.uv = 3 * mesh.stored_uv->triangles();
        const auto [first, is_new] = first_of.try_emplace(chunk.mesh_key(), m);
        if (!is_new) {
            extent.corners = 0;
            extent.corners_from = first->second;
        }
        extent.mask = chunk.mask();
        if (chunk.transform()) {
            extent.is_placed = 1;
            extent.transform = *chunk.transform();
        }
        extents.push_back(extent);
    }
    return extents;
}

/// The parts of a scene file that are large.
struct LargeParts {
    std::vector<MeshExtent> extents;
    std::function<Result<Done>(const ByteSink&)> write_corners, write_normals;
};

/// Returns a sink that goes to a part of the file, and wants no more once a write has failed:
/// building the levels for a full disk would be in vain.
ByteSink sink_to(ArchiveWriter& writer, const OutputFile& out) {
    return [&](Bytes bytes) {
        writer.write(bytes);
        return !out.has_failed();
    };
}

/// Returns the bytes that the values of each mesh take.
std::vector<uint64_t> runs_of(std::span<const MeshExtent> extents, uint64_t MeshExtent::*values,
                              size_t value_bytes) {
    std::vector<uint64_t> runs;
    for (const MeshExtent& extent : extents)
        runs.push_back(extent.*values * value_bytes);
    return runs;
}

/// Writes everything but the levels.
Result<Done> write_front(const Scene& scene, const LargeParts& parts, const Provenance& from,
                         const ByteSink& sink, ArchiveWriter& writer) {
    ByteWriter fields;
    fields(scene, scene.meshes, from.request, from.files, from.warnings);
    writer.part<std::byte>("fields", fields.bytes());
    writer.part<MeshExtent>("extents", parts.extents);
    std::array<std::vector<uint64_t>, 3> sums;
    writer.begin("corners");
    auto runs = runs_of(parts.extents, &MeshExtent::corners, sizeof(vec3));
    if (const auto done =
            parts.write_corners(summing_blocks(sink, runs, 3 * sizeof(vec3), sums[0]));
        !done)
        return done;
    writer.begin("normals");
    runs = runs_of(parts.extents, &MeshExtent::normals, sizeof(vec3));
    if (const auto done =
            parts.write_normals(summing_blocks(sink, runs, 3 * sizeof(vec3), sums[1]));
        !done)
        return done;
    writer.begin("uv");
    runs = runs_of(parts.extents, &MeshExtent::uv, sizeof(vec2));
    const ByteSink uv_sink = summing_blocks(sink, runs, 3 * sizeof(vec2), sums[2]);
    for (const MeshInfo& mesh : scene.meshes)
        uv_sink(bytes_of(std::span<const vec2>(mesh.uv)));
    for (size_t i = 0; i < sums.size(); ++i)
        writer.part<uint64_t>(kBlockSums[i], sums[i]);
    return Done{};
}

/// Ends the file.
Result<Done> write_levels(const SaveLevels& save_levels, OutputFile& out, ArchiveWriter& writer) {
    if (save_levels) {
        writer.begin("levels");
        if (const Result<Done> saved = save_levels(sink_to(writer, out));
            !saved && !out.has_failed())
            return saved;
    }
    writer.finish();
    return out.commit();
}

Result<Done> write_file(const Scene& scene, const LargeParts& parts, const Provenance& from,
                        const SaveLevels& save_levels, const std::filesystem::path& path) {
    Result<OutputFile> out = OutputFile::create(path);
    if (!out)
        return out.error();
    ArchiveWriter writer(out->sink(), kSceneKind, kSceneVersion);
    const ByteSink sink = sink_to(writer, *out);
    if (const Result<Done> done = write_front(scene, parts, from, sink, writer); !done)
        return done;
    return write_levels(save_levels, *out, writer);
}

/// The scene must outlive what is returned.
LargeParts parts_of(const Scene& scene) {
    LargeParts parts{extents_of(scene), {}, {}};
    parts.write_corners = [&scene, extents = parts.extents](const ByteSink& sink) {
        for (size_t m = 0; m < extents.size(); ++m)
            if (extents[m].corners > 0)
                sink(bytes_of(scene.soup.chunks[m].corners()));
        return Done{};
    };
    parts.write_normals = [&scene](const ByteSink& sink) {
        for (const MeshInfo& mesh : scene.meshes)
            sink(bytes_of(std::span<const vec3>(mesh.normals)));
        return Done{};
    };
    return parts;
}

LargeParts parts_of(const Scene& scene, const TriangleStore& store) {
    assert(store.meshes() == scene.meshes.size());
    LargeParts parts;
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        MeshExtent extent{scene.soup.chunks[m].origin(), store.corners(m), store.normals(m),
                          scene.meshes[m].uv.size()};
        extent.mask = scene.soup.chunks[m].mask();
        parts.extents.push_back(extent);
    }
    parts.write_corners = [&](const ByteSink& sink) { return store.write_corners(sink); };
    parts.write_normals = [&](const ByteSink& sink) { return store.write_normals(sink); };
    return parts;
}

} // namespace

Result<Done> write_scene_file(const Scene& scene, const Provenance& from,
                              const SaveLevels& save_levels, const std::filesystem::path& path) {
    return write_file(scene, parts_of(scene), from, save_levels, path);
}

bool write_scene(const Scene& scene, const Provenance& from, const ByteSink& sink) {
    ArchiveWriter writer(sink, kSceneKind, kSceneVersion);
    const auto write = [&](Bytes bytes) {
        writer.write(bytes);
        return true;
    };
    return write_front(scene, parts_of(scene), from, write, writer) && writer.finish();
}

Result<Done> write_scene_file(const Scene& scene, const TriangleStore& store,
                              const Provenance& from, const SaveLevels& save_levels,
                              const std::filesystem::path& path) {
    return write_file(scene, parts_of(scene, store), from, save_levels, path);
}

Result<std::vector<ArchivePart>> write_front(const Scene& scene, const TriangleStore& store,
                                             const Provenance& from, OutputFile& out) {
    ArchiveWriter writer(out.sink(), kSceneKind, kSceneVersion);
    const ByteSink sink = sink_to(writer, out);
    if (const Result<Done> done = write_front(scene, parts_of(scene, store), from, sink, writer);
        !done)
        return done.error();
    std::vector<ArchivePart> parts = writer.end_part();
    if (const Result<Done> flushed = out.flush(); !flushed)
        return flushed.error();
    return parts;
}

uint64_t end_of(const SceneFront& front) {
    return ArchiveWriter({}, kSceneKind, kSceneVersion, front.parts).bytes();
}

Result<Done> finish_scene_file(const SceneFront& front, const SaveLevels& save_levels,
                               OutputFile& out) {
    ArchiveWriter writer(out.sink(), kSceneKind, kSceneVersion, front.parts);
    return write_levels(save_levels, out, writer);
}

/// Returns how many blocks of values, each with a checksum, such meshes have.
static uint64_t blocks_of(std::span<const MeshExtent> extents) {
    uint64_t blocks = 0;
    for (const MeshExtent& extent : extents)
        blocks += blocks_of(extent.corners / 3) + blocks_of(extent.normals / 3) +
                  blocks_of(extent.uv / 3);
    return blocks;
}

static uint64_t file_bytes(const Scene& scene, std::span<const MeshExtent> extents,
                           uint64_t levels_bytes) {
    constexpr uint64_t kFrame = 1024; // header, table, and the gaps between parts
    ByteWriter fields;
    fields(scene, scene.meshes);
    uint64_t bytes = kFrame + fields.bytes().size() + levels_bytes + extents.size_bytes() +
                     blocks_of(extents) * sizeof(uint64_t);
    for (const MeshExtent& extent : extents)
        bytes += (extent.corners + extent.normals) * sizeof(vec3) + extent.uv * sizeof(vec2);
    return bytes;
}

uint64_t scene_file_bytes(const Scene& scene, uint64_t levels_bytes) {
    return scene.on_disk ? scene.on_disk->file.bytes()
                         : file_bytes(scene, extents_of(scene), levels_bytes);
}

uint64_t scene_file_bytes(const Scene& scene, const TriangleStore& store, uint64_t levels_bytes) {
    return file_bytes(scene, parts_of(scene, store).extents, levels_bytes);
}

uint64_t bytes_for_shading(const Scene& scene, const TriangleStore& store, uint64_t host_bytes) {
    return SceneOnDisk::own_bytes_of(host_bytes, blocks_of(parts_of(scene, store).extents));
}

uint64_t checksum_of(const Scene& scene) {
    ByteWriter fields;
    fields(scene, scene.meshes);
    Checksum sum;
    sum.add(fields.bytes());
    const std::vector<MeshExtent> extents = extents_of(scene);
    sum.add(bytes_of(std::span<const MeshExtent>(extents)));
    if (scene.on_disk) {
        sum.add_value(scene.on_disk->values_checksum);
        return sum.value();
    }
    std::array<Checksum, 3> values; // as a file has them of its large parts
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        if (extents[m].corners > 0)
            values[0].add(bytes_of(scene.soup.chunks[m].corners()));
        values[1].add(bytes_of(std::span<const vec3>(scene.meshes[m].normals)));
        values[2].add(bytes_of(std::span<const vec2>(scene.meshes[m].uv)));
    }
    Checksum all;
    for (const Checksum& part : values)
        all.add_value(part.value());
    sum.add_value(all.value());
    return sum.value();
}

Result<Done> write_ovc(const Scene& scene, const std::filesystem::path& path) {
    return write_scene_file(scene, {}, {}, path);
}

} // namespace ovc
