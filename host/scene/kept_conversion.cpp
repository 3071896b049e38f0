// SPDX-License-Identifier: Apache-2.0
// KeptConversion: a conversion with --continue always builds its levels from the front that lies in
// the unfinished file, whether this run has written it or an earlier one.
#include "host/scene/kept_conversion.h"

#include "core/file/disk_file.h"
#include "core/system/parallel.h"
#include "host/backend/plugin_loader.h"
#include "host/backend/streamed_levels.h"
#include "host/scene/scene_cache.h"

#include <fmt/format.h>

#include <cassert>
#include <cstring>

namespace ovc {

namespace fs = std::filesystem;

/// A program or a library that was built anew may make another scene of the same files.
static std::string version_of(const fs::path& path) {
    const FileStamp stamp = stamp_of(path);
    return fmt::format("{} {} {}", stamp.path, stamp.bytes, stamp.time_ns);
}

/// Returns everything besides the files that are read that the bytes of the output depend on.
static std::string work_of(const SceneArguments& source, const BackendOptions& options) {
    std::error_code ec;
    return fmt::format("{} host memory {} device {} threads {} programs {}, {}",
                       request_of(source, options, std::nullopt), options.host_bytes,
                       options.device, thread_count(),
                       version_of(fs::read_symlink("/proc/self/exe", ec)),
                       version_of(find_plugin()));
}

Result<KeptConversion> KeptConversion::open(const fs::path& output, const SceneArguments& source,
                                            const BackendOptions& options) {
    fs::path unfinished = behind_links(output);
    unfinished.replace_extension("unfinished.ovc");
    fs::path scratch = unfinished, steps = unfinished;
    scratch.replace_extension("scratch");
    steps.replace_extension("steps");
    Result<StepFile> file = StepFile::open(steps, work_of(source, options));
    if (!file)
        return file.error();
    return KeptConversion(output, std::move(unfinished), std::move(scratch), std::move(*file));
}

Result<Done> KeptConversion::take(Result<SceneFront> front) {
    const auto begin_anew = [&](const std::string& why) {
        steps_.begin_anew();
        return Error{why};
    };
    if (!front)
        return begin_anew(front.error().message);
    if (const FileStamp* changed = front->from.changed_file())
        return begin_anew(fmt::format("{} has changed", changed->path));
    front_ = std::move(*front);
    return Done{};
}

Result<Done> KeptConversion::take_front() {
    if (steps_.steps().empty())
        return Error{
            fmt::format("there is no {} of this work to go on with", unfinished_.string())};
    const Bytes step = steps_.steps().front();
    std::vector<ArchivePart> parts(step.size() / sizeof(ArchivePart));
    std::memcpy(parts.data(), step.data(), parts.size() * sizeof(ArchivePart));
    Result<SceneFront> front = open_front(unfinished_, std::move(parts));
    const Result<Done> fine = front ? check_front(unfinished_, *front) : Done{};
    return take(fine ? std::move(front) : fine.error());
}

Result<Done> KeptConversion::write_front(const Scene& scene, const TriangleStore& store,
                                         const Provenance& from) {
    Result<OutputFile> out = OutputFile::go_on(output_, unfinished_, 0);
    if (!out)
        return out.error();
    const auto parts = ovc::write_front(scene, store, from, *out);
    if (!parts)
        return parts.error();
    if (!steps_.keep(bytes_of(std::span<const ArchivePart>(*parts))))
        return *steps_.error();
    return take(open_front(unfinished_, *parts));
}

static StreamedTriangles triangles_in(const SceneFront& front, const DiskFile& file) {
    StreamedTriangles triangles;
    for (const SceneFront::Mesh& mesh : front.meshes)
        triangles.meshes.push_back({mesh.origin, mesh.triangles});
    triangles.read = [&](uint32_t mesh, uint64_t first, std::span<vec3> corners) {
        return file.read(front.meshes[mesh].offset + 3 * sizeof(vec3) * first,
                         std::as_writable_bytes(corners));
    };
    triangles.error = [&] { return file.error(); };
    return triangles;
}

Result<Done> KeptConversion::finish(BackendOptions options, const LogSink& log) {
    assert(front_);
    options.watching = BuildWatching::Shown;
    const uint64_t levels = end_of(*front_);
    Result<OutputFile> out = OutputFile::go_on(output_, unfinished_, levels);
    if (!out)
        return out.error();
    const Result<DiskFile> file = DiskFile::open(unfinished_);
    if (!file)
        return file.error();
    Result<ScratchFile> scratch = ScratchFile::open_named(scratch_);
    if (!scratch)
        return scratch.error();
    const KeptLevels kept{
        steps_, 1,
        [&](uint64_t offset, std::span<std::byte> to) { return file->read(levels + offset, to); },
        [&] { return bool(out->flush()); }};
    const SaveLevels save_levels = [&](const ByteSink& sink) {
        return save_streamed_levels(triangles_in(*front_, *file), options.host_bytes, *scratch,
                                    options, log, sink, &kept);
    };
    if (Result<Done> done = finish_scene_file(*front_, save_levels, *out); !done) {
        if (done.error().kind == ErrorKind::Unreadable)
            steps_.begin_anew(); // what is kept is damaged
        return done;
    }
    remove();
    return Done{};
}

void KeptConversion::remove() {
    std::error_code ignored;
    for (const fs::path& path : {unfinished_, scratch_, steps_.path()})
        fs::remove(path, ignored);
}

} // namespace ovc
