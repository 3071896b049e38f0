// SPDX-License-Identifier: Apache-2.0
// Reads scene files. Everything that a renderer relies on is checked, except the levels.
#include "core/file/file_blocks.h"
#include "core/file/value_bytes.h"
#include "core/function_ref.h"
#include "importers/readers.h"
#include "importers/scene_file/scene_fields.h"
#include "importers/scene_file/scene_file.h"
#include "importers/scene_file/scene_file_format.h"
#include "importers/scene_file/sound_meshes.h"
#include "importers/scene_file/sound_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace ovc {

namespace {

/// Returns the chunk of a mesh with corners of its own, which begin behind so many.
using OwnChunk = FunctionRef<Chunk(const MeshExtent& extent, uint64_t first_corner)>;

/// Returns a mesh's chunk; nothing if the extent cannot be true. first, end: the corners that are
/// left.
std::optional<Chunk> chunk_of(const MeshExtent& extent, uint64_t first, uint64_t end,
                              const OwnChunk& own_chunk, const Soup& before) {
    if (extent.corners > end - first || extent.corners % 3 || extent.corners / 3 > kMaxTriangles ||
        !is_finite(extent.origin))
        return std::nullopt;
    const bool has_own = extent.corners_from == MeshExtent::kOwnCorners;
    if (!has_own && (extent.corners > 0 || extent.corners_from >= before.chunks.size()))
        return std::nullopt;
    Chunk chunk =
        has_own ? own_chunk(extent, first) : before.chunks[extent.corners_from].unplaced();
    if (extent.is_placed == 0)
        return chunk;
    for (const auto& row : extent.transform.rows)
        for (const double number : row)
            if (!std::isfinite(number))
                return std::nullopt;
    chunk.place(extent.transform);
    return chunk;
}

/// Numbers of corners, normals and texture coordinates.
struct Amounts {
    uint64_t corners = 0;
    uint64_t normals = 0;
    uint64_t uv = 0;
};

/// The functions by which meshes get their values from the large parts.
struct Sharing {
    Amounts all;
    OwnChunk own_chunk;
    /// Gives a mesh its normals and texture coordinates, which begin behind so many.
    FunctionRef<void(MeshInfo& mesh, const MeshExtent& extent, const Amounts& first)> give_values;
};

/// Gives the meshes their corners, their normals and their texture coordinates. Returns false if
/// the extents do not use them up exactly.
bool share_out(std::span<const MeshExtent> extents, const Sharing& sharing, Scene& scene) {
    const Amounts& all = sharing.all;
    Amounts first;
    if (extents.size() != scene.meshes.size())
        return false;
    for (size_t m = 0; m < extents.size(); ++m) {
        const MeshExtent& extent = extents[m];
        std::optional<Chunk> chunk =
            chunk_of(extent, first.corners, all.corners, sharing.own_chunk, scene.soup);
        if (!chunk || extent.normals > all.normals - first.normals ||
            extent.uv > all.uv - first.uv || extent.normals % 3 || extent.uv % 3)
            return false;
        sharing.give_values(scene.meshes[m], extent, first);
        chunk->set_mask(extent.mask);
        scene.soup.chunks.push_back(std::move(*chunk));
        first.corners += extent.corners;
        first.normals += extent.normals;
        first.uv += extent.uv;
    }
    return first.corners == all.corners && first.normals == all.normals && first.uv == all.uv;
}

bool is_sound(const FaceCamera& camera) {
    if (camera.meshes.empty() || camera.order > FaceCamera::Order::ByUv)
        return false;
    return std::all_of(camera.meshes.begin(), camera.meshes.end(), [&](const FaceMesh& mesh) {
        const size_t faces = mesh.corners.size();
        const bool has_uv = camera.order == FaceCamera::Order::ByUv;
        return (mesh.normals.empty() || mesh.normals.size() == faces) &&
               mesh.uv.size() == (has_uv ? faces : 0);
    });
}

/// Checks what the host relies on.
bool is_sound(const Scene& scene) {
    constexpr uint32_t kMaxPixels = 65535; // per side
    if (!has_sound_meshes(scene))
        return false;
    const auto fits = [](uint32_t side) { return side >= 1 && side <= kMaxPixels; };
    if (scene.size && !(fits(scene.size->width) && fits(scene.size->height)))
        return false;
    if (scene.part && !scene.part->lies_in_picture())
        return false;
    if (!(scene.exposure > 0))
        return false;
    for (const Light& light : scene.lights)
        if (light.projector && !light.projector->triangles.is_sound())
            return false;
    for (const Material& material : scene.materials)
        if (material.optics && material.optics->boundary > Optics::Boundary::Thin)
            return false;
    if (!has_sound_textures(scene))
        return false;
    for (const Cutout& cutout : scene.cutouts)
        if (cutout.beyond > Cutout::Beyond::Hole ||
            (cutout.opacity.empty() && cutout.texture == kNoTexture) ||
            cutout.opacity.size() != uint64_t(cutout.width) * cutout.height)
            return false;
    if (scene.faces && !is_sound(*scene.faces))
        return false;
    using Bend = ImageWindow::Bend;
    return !scene.camera || !scene.camera->window ||
           (scene.camera->window->bend >= Bend::Flat &&
            scene.camera->window->bend <= Bend::Cylinder4);
}

/// Reads everything but the large parts.
template <class AnyArchive>
Result<SceneFile> read(const AnyArchive& archive, const Sharing& sharing) {
    const Error unsound{"is damaged: what it holds is no scene"};
    const auto fields = archive.template items<std::byte>("fields");
    if (!fields)
        return fields.error();
    const auto extents = archive.template items<MeshExtent>("extents");
    if (!extents)
        return extents.error();
    SceneFile file;
    ByteReader reader(*fields);
    reader(file.scene, file.scene.meshes, file.from.request, file.from.files, file.from.warnings);
    if (!reader.done() || !share_out(*extents, sharing, file.scene) || !is_sound(file.scene))
        return unsound;
    return file;
}

template <class T>
std::vector<T> copy_of(std::span<const T> values) {
    return {values.begin(), values.end()};
}

/// Leaves corners and levels where they are mapped.
Result<SceneFile> read(const Archive& archive) {
    const auto corners = archive.items<vec3>("corners");
    if (!corners)
        return corners.error();
    const auto normals = archive.items<vec3>("normals");
    if (!normals)
        return normals.error();
    const auto uv = archive.items<vec2>("uv");
    if (!uv)
        return uv.error();
    const auto own_chunk = [&](const MeshExtent& extent, uint64_t first) {
        return Chunk::borrowing(extent.origin, corners->subspan(first, extent.corners));
    };
    const auto give_values = [&](MeshInfo& mesh, const MeshExtent& extent, const Amounts& first) {
        mesh.normals = copy_of(normals->subspan(first.normals, extent.normals));
        mesh.uv = copy_of(uv->subspan(first.uv, extent.uv));
    };
    Result<SceneFile> file = read<Archive>(
        archive, {{corners->size(), normals->size(), uv->size()}, own_chunk, give_values});
    if (file)
        file->scene.saved = archive.unchecked("levels");
    return file;
}

/// A part whose values stay on a disk, three of them for each triangle of the meshes in turn.
template <class T>
class StoredPart {
public:
    /// first_sum: of its blocks among those of all parts.
    StoredPart(const ArchivePart& part, std::string what, uint64_t first_sum, uint64_t sums)
        : part_(part), what_(std::move(what)), next_sum_(first_sum), end_sum_(first_sum + sums) {}

    uint64_t values() const { return part_.bytes / sizeof(T); }
    /// Returns the values of the next mesh, which begin behind so many.
    StoredValues next(SceneOnDisk& disk, uint64_t first, uint64_t count) {
        const FileBlocks blocks(disk.reader(), part_.offset + first * sizeof(T), count / 3,
                                3 * sizeof(T), next_sum_);
        next_sum_ += blocks_of(count / 3);
        return {disk, blocks, what_};
    }
    /// Returns whether all blocks had a checksum, and there were no more.
    bool is_used_up() const { return next_sum_ == end_sum_; }

private:
    const ArchivePart part_;
    const std::string what_;
    uint64_t next_sum_;
    const uint64_t end_sum_;
};

/// Leaves values and levels on the disk, which the scene then owns.
Result<SceneFile> read(std::shared_ptr<const DiskFile> opened, const StoredArchive& archive,
                       uint64_t host_bytes) {
    std::vector<uint64_t> sums;
    std::array<uint64_t, 3> counts{};
    for (size_t i = 0; i < counts.size(); ++i) {
        const auto more = archive.items<uint64_t>(kBlockSums[i]);
        if (!more)
            return more.error();
        counts[i] = more->size();
        sums.insert(sums.end(), more->begin(), more->end());
    }
    StoredPart<vec3> corners(archive.place("corners"), "corners", 0, counts[0]);
    StoredPart<vec3> normals(archive.place("normals"), "normals", counts[0], counts[1]);
    StoredPart<vec2> uv(archive.place("uv"), "texture coordinates", counts[0] + counts[1],
                        counts[2]);
    auto disk = std::make_unique<SceneOnDisk>(std::move(opened), host_bytes, std::move(sums));
    Checksum all;
    for (const char* name : {"corners", "normals", "uv"})
        all.add_value(archive.place(name).checksum);
    disk->values_checksum = all.value();
    disk->levels_offset = archive.place("levels").offset;
    disk->levels_bytes = archive.place("levels").bytes;
    const auto own_chunk = [&](const MeshExtent& extent, uint64_t first) {
        disk->meshes.push_back(
            std::make_unique<FileCorners>(corners.next(*disk, first, extent.corners)));
        return Chunk::stored(extent.origin, *disk->meshes.back(), uint32_t(extent.corners / 3));
    };
    const auto keep = [&](StoredValues values) {
        disk->values.push_back(std::make_unique<StoredValues>(std::move(values)));
        return disk->values.back().get();
    };
    const auto give_values = [&](MeshInfo& mesh, const MeshExtent& extent, const Amounts& first) {
        if (extent.normals > 0)
            mesh.stored_normals = keep(normals.next(*disk, first.normals, extent.normals));
        if (extent.uv > 0)
            mesh.stored_uv = keep(uv.next(*disk, first.uv, extent.uv));
    };
    Result<SceneFile> file = read<StoredArchive>(
        archive, {{corners.values(), normals.values(), uv.values()}, own_chunk, give_values});
    if (file && !(corners.is_used_up() && normals.is_used_up() && uv.is_used_up()))
        return Error{"is damaged: it has checksums of other blocks"};
    if (file)
        file->scene.on_disk = std::move(disk);
    return file;
}

} // namespace

const FileStamp* Provenance::changed_file() const {
    const auto changed = std::find_if(files.begin(), files.end(), [](const FileStamp& file) {
        return stamp_of(file.path) != file;
    });
    return changed == files.end() ? nullptr : &*changed;
}

Result<SceneFile> read_scene_file(const std::filesystem::path& path) {
    Result<MappedFile> mapped = MappedFile::open(path);
    if (!mapped)
        return mapped.error();
    const auto failed = [&](const Error& error) {
        return Error{fmt::format("{}: the file {}", path.string(), error.message)};
    };
    const Result<Archive> archive = Archive::open(mapped->bytes(), kSceneKind, kSceneVersion);
    if (!archive)
        return failed(archive.error());
    Result<SceneFile> file = read(*archive);
    if (!file)
        return failed(file.error());
    file->scene.files.push_back(std::move(*mapped));
    return file;
}

Result<SceneFile> open_scene_file(const std::filesystem::path& path, uint64_t host_bytes) {
    Result<DiskFile> opened = DiskFile::open(path);
    if (!opened)
        return opened.error();
    const auto disk = std::make_shared<const DiskFile>(std::move(*opened));
    const auto failed = [&](const Error& error) {
        const auto said = disk->error();
        return said ? *said : Error{fmt::format("{}: the file {}", path.string(), error.message)};
    };
    const auto read_bytes = [&](uint64_t offset, std::span<std::byte> to) {
        return disk->read(offset, to);
    };
    const auto archive = StoredArchive::open(read_bytes, disk->bytes(), kSceneKind, kSceneVersion);
    if (!archive)
        return failed(archive.error());
    if (archive->place("levels").bytes == 0)
        return failed({"holds no levels: overcast convert makes one that does"});
    Result<SceneFile> file = read(disk, *archive, host_bytes);
    return file ? std::move(file) : failed(file.error());
}

namespace {

/// Returns read(archive) of an unfinished file with these parts.
template <class Read>
auto of_unfinished(const std::filesystem::path& path, const std::vector<ArchivePart>& parts,
                   Read&& read) -> decltype(read(std::declval<const StoredArchive&>())) {
    const Result<DiskFile> file = DiskFile::open(path);
    if (!file)
        return file.error();
    const auto read_bytes = [&](uint64_t offset, std::span<std::byte> to) {
        return file->read(offset, to);
    };
    auto done = read(StoredArchive::of_parts(read_bytes, parts));
    if (!done)
        return Error{fmt::format("{}: the file {}", path.string(), done.error().message)};
    return done;
}

Result<SceneFront> read_front(const StoredArchive& archive) {
    const auto fields = archive.items<std::byte>("fields");
    if (!fields)
        return fields.error();
    const auto extents = archive.items<MeshExtent>("extents");
    if (!extents)
        return extents.error();
    SceneFront front;
    Scene scene;
    ByteReader reader(*fields);
    reader(scene, scene.meshes, front.from.request, front.from.files, front.from.warnings);
    if (!reader.done())
        return Error{"is damaged: what it holds is no scene"};
    uint64_t offset = archive.place("corners").offset;
    for (const MeshExtent& extent : *extents) {
        front.meshes.push_back({extent.origin, extent.corners / 3, offset});
        offset += extent.corners * sizeof(vec3);
    }
    return front;
}

} // namespace

Result<SceneFront> open_front(const std::filesystem::path& path, std::vector<ArchivePart> parts) {
    Result<SceneFront> front = of_unfinished(path, parts, read_front);
    if (front)
        front->parts = std::move(parts);
    return front;
}

Result<Done> check_front(const std::filesystem::path& path, const SceneFront& front) {
    return of_unfinished(path, front.parts, [](const StoredArchive& archive) {
        for (const char* name :
             {"corners", "normals", "uv", kBlockSums[0], kBlockSums[1], kBlockSums[2]})
            if (const Result<Done> fine = archive.check_part(name); !fine)
                return fine;
        return Result<Done>(Done{});
    });
}

/// Repeats the warnings of the time when the scene was made.
Result<Scene> read_ovc(const std::filesystem::path& path, const ImportOptions& options) {
    note(options.files, path);
    Result<SceneFile> file =
        options.host_bytes > 0 ? open_scene_file(path, options.host_bytes) : read_scene_file(path);
    if (!file)
        return file.error();
    for (const std::string& warning : file->from.warnings)
        say(options.log, LogLevel::Warning, warning);
    if (const FileStamp* changed = file->from.changed_file())
        say(options.log, LogLevel::Warning,
            fmt::format("{}: it shows {} as that was before it changed", path.string(),
                        changed->path));
    return std::move(file->scene);
}

} // namespace ovc
