// SPDX-License-Identifier: Apache-2.0
// The backends behind the C ABI, which takes the soup and its rays without a copy.
#include "core/file/scene_on_disk.h"
#include "host/backend/backend.h"
#include "host/backend/mesh_numbers.h"
#include "host/backend/plugin_config.h"
#include "host/backend/plugin_loader.h"
#include "host/ranks/ranks.h"
#include "host/scene/soup_difference.h"
#include "host/terminal/build_watch.h"
#include "host/terminal/interrupt.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>

namespace ovc {

// The records are the same on both sides, so arrays are handed over as they are.
static_assert(sizeof(Ray) == sizeof(ovc_ray) && offsetof(Ray, org) == offsetof(ovc_ray, org) &&
              offsetof(Ray, t_min) == offsetof(ovc_ray, t_min) &&
              offsetof(Ray, dir) == offsetof(ovc_ray, dir) &&
              offsetof(Ray, t_max) == offsetof(ovc_ray, t_max));
static_assert(sizeof(Hit) == sizeof(ovc_hit) && offsetof(Hit, t) == offsetof(ovc_hit, t) &&
              offsetof(Hit, u) == offsetof(ovc_hit, u) &&
              offsetof(Hit, v) == offsetof(ovc_hit, v) &&
              offsetof(Hit, id) == offsetof(ovc_hit, mesh));
static_assert(sizeof(TriangleId) == sizeof(ovc_triangle) &&
              offsetof(TriangleId, prim) == offsetof(ovc_triangle, prim) && kNone == OVC_NONE);
static_assert(sizeof(vec3) == 3 * sizeof(float));

static const ovc_ray* as_abi(std::span<const Ray> rays) {
    return reinterpret_cast<const ovc_ray*>(rays.data());
}

/// Asks a HitFilter, which is the user of the C function.
static int ask_filter(void* user, size_t count, const uint64_t* rays, const ovc_hit* hits,
                      uint8_t* keep) {
    HitFilter& filter = *static_cast<HitFilter*>(user);
    return filter.keep({rays, count}, {reinterpret_cast<const Hit*>(hits), count}, {keep, count})
               ? 0
               : 1;
}

/// Returns the query for what is excluded. The library names rays as Sieves do by default.
static ovc_query query_of(const Exclusions& without) {
    const auto pointer = [](auto array) { return array.empty() ? nullptr : array.data(); };
    const Sieves& sieves = without.sieves;
    assert(sieves.filters.size() <= 1); // one for all rays of a call
    ovc_query query{};
    query.struct_size = sizeof(query);
    query.skip = reinterpret_cast<const ovc_triangle*>(pointer(without.skip));
    query.after = reinterpret_cast<const ovc_hit*>(pointer(without.after));
    query.masks = pointer(sieves.masks);
    if (!sieves.filters.empty() && sieves.filters[0]) {
        query.filter = ask_filter;
        query.filter_user = sieves.filters[0];
    }
    return query;
}

/// Translates between a StreamHost and the callbacks of the C ABI, in both directions.
class CalledBack final : public RayStream {
public:
    CalledBack(const ovc_api& api, StreamHost& host, const MeshNumbers& numbers)
        : api_(api), host_(host), numbers_(numbers) {}

    ovc_stream_host as_abi() { return {sizeof(ovc_stream_host), this, more, answered}; }

    void push(const StreamRays& rays) override {
        assert(rays.tokens.size() == rays.rays.size());
        const LibraryExclusions excluded(numbers_, rays.skip, rays.after);
        Exclusions without(excluded.skip(), excluded.after());
        HitFilter* const filter =
            rays.filters.empty() || !rays.filters[0] ? nullptr : filter_of(*rays.filters[0]);
        without.sieves = {rays.masks, {&filter, filter ? size_t(1) : 0}, rays.tokens};
        const ovc_query query = query_of(without);
        refused_ = refused_ || api_.push(stream_, ovc::as_abi(rays.rays), rays.tokens.data(),
                                         rays.rays.size(), rays.any_hit, &query) != OVC_OK;
    }

private:
    static int more(void* user, ovc_stream stream, size_t wanted) {
        CalledBack& self = *static_cast<CalledBack*>(user);
        self.stream_ = stream;
        return self.go_on(self.host_.more(self, wanted));
    }
    static int answered(void* user, ovc_stream stream, const ovc_stream_answers* answers) {
        CalledBack& self = *static_cast<CalledBack*>(user);
        self.stream_ = stream;
        const std::span<const uint64_t> tokens(answers->tokens, answers->count);
        if (answers->hits)
            return self.go_on(self.give_hits(
                tokens, {reinterpret_cast<const Hit*>(answers->hits), answers->count}));
        return self.go_on(self.host_.occlusions(self, tokens, {answers->occluded, answers->count}));
    }
    bool give_hits(std::span<const uint64_t> tokens, std::span<const Hit> hits) {
        if (!numbers_.differ())
            return host_.hits(*this, tokens, hits);
        std::vector<Hit> in_scene(hits.begin(), hits.end());
        numbers_.to_scene(in_scene);
        return host_.hits(*this, tokens, in_scene);
    }
    /// Returns a filter for the library, which lives as long as the stream.
    HitFilter* filter_of(HitFilter& filter) {
        return &filters_.try_emplace(&filter, numbers_, filter).first->second;
    }
    int go_on(bool wanted) const { return wanted && !refused_ ? 0 : 1; }

    const ovc_api& api_;
    StreamHost& host_;
    const MeshNumbers& numbers_;
    std::map<HitFilter*, LibraryFilter> filters_;
    ovc_stream stream_ = nullptr;
    bool refused_ = false; // the library refused a push
};

/// Reads corners of a mesh that is stored, which is the user of the C function. The library checks
/// them.
static int read_corners(void* user, uint64_t first, uint64_t count, void* corners) {
    const StoredCorners& stored = *static_cast<const StoredCorners*>(user);
    const size_t size = size_t(count) * stored.triangle_bytes();
    return stored.read_unchecked(uint32_t(first), {static_cast<std::byte*>(corners), size}) ? 0 : 1;
}

/// Reads what was saved, of the scene that is the user of the C function.
static int read_saved(void* user, uint64_t offset, void* bytes, size_t size) {
    const SceneOnDisk& disk = *static_cast<const SceneOnDisk*>(user);
    return disk.file.read(disk.levels_offset + offset, {static_cast<std::byte*>(bytes), size}) ? 0
                                                                                               : 1;
}

static ovc_mesh mesh_of(const Chunk& chunk) {
    ovc_mesh mesh{};
    mesh.struct_size = sizeof(mesh);
    for (int axis = 0; axis < 3; ++axis)
        mesh.origin[axis] = chunk.origin()[axis];
    if (chunk.transform())
        mesh.transform = chunk.transform()->rows[0].data();
    mesh.mask = chunk.mask();
    if (const StoredCorners* stored = chunk.stored_corners()) {
        mesh.triangle_count = chunk.size();
        mesh.read_corners = read_corners;
        mesh.read_user = const_cast<StoredCorners*>(stored);
        mesh.reads_doubles = stored->has_doubles();
        return mesh;
    }
    if (chunk.double_corners().empty())
        mesh.positions = reinterpret_cast<const float*>(chunk.corners().data());
    else
        mesh.positions_double = reinterpret_cast<const double*>(chunk.double_corners().data());
    mesh.vertex_count = 3 * uint64_t(chunk.size());
    mesh.flags = OVC_MESH_SHARED; // instances of a mesh point to the same corners, and share pages
    return mesh;
}

/// Returns triangles [first, end) of the chunk as update_mesh takes them.
static ovc_mesh part_of(const Chunk& chunk, uint32_t first, uint32_t end) {
    ovc_mesh part = mesh_of(chunk);
    if (part.positions)
        part.positions += 9 * size_t(first);
    else
        part.positions_double += 9 * size_t(first);
    part.vertex_count = 3 * uint64_t(end - first);
    part.transform = nullptr;
    part.mask = 0;
    return part;
}

/// The exclusions of a call, in the library's numbers.
class LibraryQuery {
public:
    LibraryQuery(const MeshNumbers& numbers, const Exclusions& without)
        : excluded_(numbers, without.skip, without.after), without_(without) {
        without_.skip = excluded_.skip();
        without_.after = excluded_.after();
        const auto filters = without.sieves.filters;
        if (numbers.differ() && !filters.empty() && filters[0]) {
            filter_.emplace(numbers, *filters[0]);
            one_ = &*filter_;
            without_.sieves.filters = {&one_, 1};
        }
    }
    LibraryQuery(const LibraryQuery&) = delete; // it refers to itself

    ovc_query query() const { return query_of(without_); }

private:
    LibraryExclusions excluded_;
    std::optional<LibraryFilter> filter_;
    HitFilter* one_ = nullptr;
    Exclusions without_;
};

/// Adds the meshes of the soup whose numbers are not known yet.
static Result<Done> add_meshes(const PluginDevice& device, ovc_scene scene, const Soup& soup,
                               MeshNumbers& numbers) {
    while (numbers.count() < soup.chunks.size()) {
        const ovc_mesh mesh = mesh_of(soup.chunks[numbers.count()]);
        uint32_t number = 0;
        const Result<Done> added = device.checked(device.api()->add_mesh(scene, &mesh, &number));
        if (!added)
            return added;
        numbers.add(number);
    }
    return Done{};
}

/// Returns what the library says, and where it could not read, why: it only knows that.
static Result<Done> explained(const SceneOnDisk* on_disk, Result<Done> done) {
    return done || !on_disk ? std::move(done) : on_disk->explained(done.error());
}

/// Adds what the host reads and keeps by itself, of one budget with the library.
static void add_own_share(const SceneOnDisk& disk, ovc_statistics& statistics) {
    statistics.host_budget_bytes = disk.budget_bytes();
    statistics.host_budget_peak_bytes += disk.bytes();
    statistics.disk_reads += disk.misses();
    statistics.disk_bytes += disk.read_bytes();
    statistics.disk_hits += disk.hits();
    statistics.disk_misses += disk.misses();
}

class PluginBackend final : public Backend {
public:
    /// watch: that of the scene's config, or null. numbers: of the scene's meshes.
    PluginBackend(PluginDevice device, std::string renderer, std::unique_ptr<BuildWatch> watch,
                  PluginScene scene, MeshNumbers numbers, const BackendOptions& options)
        : device_(std::move(device)),
          renderer_(std::move(renderer)),
          watch_(std::move(watch)),
          scene_(std::move(scene)),
          numbers_(std::move(numbers)),
          on_disk_(options.on_disk),
          is_two_level_(structure_of(options.kind) == OVC_STRUCTURE_TWO_LEVEL) {
        look_for_pages();
    }

    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        return intersect_noted(rays, without, hits, {});
    }

    Result<Done> intersect_noted(std::span<const Ray> rays, const Exclusions& without,
                                 std::span<Hit> hits, const RayNotes& notes) override {
        assert(hits.size() == rays.size() && without.are_for(rays.size()));
        const LibraryQuery asked(numbers_, without);
        ovc_query query = asked.query();
        ends_early(query);
        query.leaf = notes.leaf.empty() ? nullptr : notes.leaf.data();
        query.passes = notes.passes.empty() ? nullptr : notes.passes.data();
        query.flagged = notes.flagged.empty() ? nullptr : notes.flagged.data();
        const Result<Done> done =
            checked(api().intersect(scene_.get(), as_abi(rays), rays.size(),
                                    reinterpret_cast<ovc_hit*>(hits.data()), &query));
        if (done)
            numbers_.to_scene(hits);
        return done;
    }

    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        assert(occluded.size() == rays.size() && without.are_for(rays.size()));
        const LibraryQuery asked(numbers_, without);
        ovc_query query = asked.query();
        ends_early(query);
        return checked(
            api().occluded(scene_.get(), as_abi(rays), rays.size(), occluded.data(), &query));
    }

    Result<Done> stream(StreamHost& host) override {
        CalledBack called(api(), host, numbers_);
        const ovc_stream_host callbacks = called.as_abi();
        return checked(api().stream(scene_.get(), &callbacks));
    }

    std::optional<ovc_active> take_active() override {
        ovc_active active{};
        active.struct_size = sizeof(active);
        return api().active(scene_.get(), &active) == OVC_OK ? std::optional(active) : std::nullopt;
    }

    void purge() override { (void)api().purge(scene_.get()); }

    std::vector<uint32_t> first_ranks(std::span<const Ray> rays) const override {
        const Ranks* const ranks = Ranks::of_run();
        return ranks && is_two_level_ ? ranks->first_ranks(scene_.get(), rays)
                                      : std::vector<uint32_t>();
    }

    Result<bool> update(const Soup& soup, const SoupDifference& difference) override {
        if (!is_two_level_)
            return false;
        if (const Result<Done> told = tell(soup, difference); !told)
            return told.error();
        std::optional<BuildWatch::Building> watched;
        if (watch_)
            watched.emplace(*watch_);
        if (const Result<Done> done = checked(api().commit(scene_.get())); !done)
            return done.error();
        look_for_pages();
        return true;
    }

    bool saves() const override { return is_two_level_; }

    Result<Done> save(const ByteSink& sink) const override {
        const auto write = [](void* user, const void* bytes, size_t size) {
            return (*static_cast<const ByteSink*>(user))(
                       {static_cast<const std::byte*>(bytes), size})
                       ? 0
                       : 1;
        };
        return checked(api().save(scene_.get(), write, const_cast<ByteSink*>(&sink)));
    }

    bool moves_pages() const override { return moves_pages_; }

    ovc_statistics statistics() const override {
        ovc_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        api().statistics(scene_.get(), &statistics);
        if (on_disk_)
            add_own_share(*on_disk_, statistics);
        return statistics;
    }

    std::string renderer() const override { return renderer_; }

private:
    /// Commit moves all pages that fit.
    void look_for_pages() {
        const ovc_statistics now = statistics();
        moves_pages_ = moves_pages_ || now.bytes_in < now.level2_bytes;
    }

    const ovc_api& api() const { return *device_.api(); }
    Result<Done> checked(ovc_result result) const {
        return explained(on_disk_, device_.checked(result));
    }

    /// Among ranks, a call may wait for one that has ended; and then there is no time to lose.
    static void ends_early(ovc_query& query) {
        if (Ranks::of_run())
            query.progress = [](void*, double, const char*) { return is_interrupted() ? 1 : 0; };
    }

    /// Tells the library what has changed in the soup.
    Result<Done> tell(const Soup& soup, const SoupDifference& difference) {
        for (uint32_t mesh = difference.kept; mesh < numbers_.count(); ++mesh)
            if (const auto done =
                    checked(api().remove_mesh(scene_.get(), numbers_.in_library(mesh)));
                !done)
                return done;
        numbers_.forget_from(difference.kept);
        for (const PrimRange& range : difference.moved) {
            const ovc_mesh part = part_of(soup.chunks[range.mesh], range.first, range.end);
            if (const auto done = checked(api().update_mesh(
                    scene_.get(), numbers_.in_library(range.mesh), &part, range.first));
                !done)
                return done;
        }
        for (const uint32_t mesh : difference.placed) {
            const Transform* transform = soup.chunks[mesh].transform();
            if (const auto done =
                    checked(api().update_instance(scene_.get(), numbers_.in_library(mesh),
                                                  transform ? transform->rows[0].data() : nullptr));
                !done)
                return done;
        }
        return add_meshes(device_, scene_.get(), soup, numbers_);
    }

    PluginDevice device_;
    std::string renderer_;
    std::unique_ptr<BuildWatch> watch_;
    PluginScene scene_; // after those, so that it is destroyed first
    MeshNumbers numbers_;
    const SceneOnDisk* const on_disk_; // null where the scene lies in memory
    const bool is_two_level_;          // the systems of the thesis neither save nor update
    bool moves_pages_ = false;
};

/// Warns of a budget beyond the memory. A scene may take less than its budget, so it is no error.
static void check_budget(uint64_t budget_bytes, const ovc_device_info& info, const LogSink& log) {
    // A software renderer takes the machine's memory, whatever number it reports.
    const uint64_t there = info.is_software
                               ? uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE))
                               : info.memory_bytes;
    if (budget_bytes > there)
        say(log, LogLevel::Warning,
            fmt::format("--gpu-memory: {} is more than the {} that {} has{}",
                        human_bytes(budget_bytes), human_bytes(there), info.renderer,
                        info.is_software ? "" : " free, as far as its driver tells"));
}

Result<ovc_scene_config> config_of(const BackendOptions& options, const ovc_device_info& info,
                                   const LogSink& log) {
    ovc_scene_config config{};
    config.struct_size = sizeof(config);
    config.gpu_memory_bytes = options.gpu_memory.of(info.memory_bytes);
    if (options.gpu_memory.share > 0 && config.gpu_memory_bytes == 0)
        return Error{fmt::format("--gpu-memory: {}% of the device's {} is less than one byte",
                                 100 * options.gpu_memory.share, human_bytes(info.memory_bytes))};
    check_budget(config.gpu_memory_bytes, info, log);
    config.leaf_triangles = options.leaf_triangles;
    config.leaves = options.leaves;
    config.precision = options.precision;
    config.kernel = options.kernel;
    if (!options.kernel_variant.empty())
        config.kernel_variant = options.kernel_variant.c_str();
    config.structure = structure_of(options.kind);
    config.level1 = options.level1;
    config.level1_build = options.level1_build;
    config.tell_active = options.tell_active && config.structure == OVC_STRUCTURE_TWO_LEVEL;
    if (config.structure == OVC_STRUCTURE_TWO_LEVEL) {
        config.saved = options.saved.data();
        config.saved_bytes = options.saved.size();
    }
    if (options.on_disk) {
        // At least a byte: 0 would be no limit.
        config.host_memory_bytes =
            std::max<uint64_t>(options.on_disk->for_plugin() / options.host_shares, 1);
        config.read_saved = read_saved;
        config.read_user = const_cast<SceneOnDisk*>(options.on_disk);
        config.saved_bytes = options.on_disk->levels_bytes;
    }
    if (Ranks::of_run() && config.structure == OVC_STRUCTURE_TWO_LEVEL) {
        config.ranks_own = options.ranks_own;
        config.rank_timeout = options.rank_timeout;
        config.sample = as_abi(options.sample);
        config.sample_rays = options.sample.size();
    }
    return config;
}

/// Returns the error of a commit. Where the library's share of host memory is too small, the
/// sentence names the smallest budget of all.
static Error why_not_built(const PluginDevice& device, ovc_scene scene,
                           const BackendOptions& options, const Error& error) {
    const SceneOnDisk* disk = options.on_disk;
    if (!disk || error.kind != ErrorKind::OverBudget)
        return disk ? disk->explained(error) : error;
    ovc_plan plan{};
    plan.struct_size = sizeof(plan);
    if (device.api()->plan(scene, &plan) != OVC_OK ||
        plan.smallest_host_bytes <= disk->for_plugin() / options.host_shares)
        return error; // it is the GPU's budget
    return over_budget(
        fmt::format("{} bytes of host memory are too few for this scene: the smallest number that "
                    "works is {}",
                    disk->budget_bytes(),
                    disk->smallest_budget(plan.smallest_host_bytes * options.host_shares)));
}

Result<ovc_plan> make_plugin_plan(const PluginDevice& device, const Soup& soup,
                                  const BackendOptions& options, const LogSink& log) {
    const Result<ovc_device_info> info = device.describe();
    if (!info)
        return info.error();
    const Result<ovc_scene_config> config = config_of(options, *info, log);
    if (!config)
        return config.error();
    const Result<PluginScene> scene = device.create_scene(*config);
    if (!scene)
        return scene.error();
    MeshNumbers numbers;
    if (const Result<Done> added = add_meshes(device, scene->get(), soup, numbers); !added)
        return added.error();
    ovc_plan plan{};
    plan.struct_size = sizeof(plan);
    if (const Result<Done> done =
            explained(options.on_disk, device.checked(device.api()->plan(scene->get(), &plan)));
        !done)
        return done.error();
    if (options.on_disk) {
        plan.host_bytes += options.on_disk->own_bytes();
        plan.smallest_host_bytes = options.on_disk->smallest_budget(plan.smallest_host_bytes);
    }
    return plan;
}

Result<std::unique_ptr<Backend>> make_plugin_backend(PluginDevice device, const Soup& soup,
                                                     const BackendOptions& options,
                                                     const LogSink& log) {
    const Result<ovc_device_info> info = device.describe();
    if (!info)
        return info.error();
    Result<ovc_scene_config> config = config_of(options, *info, log);
    if (!config)
        return config.error();
    if (options.on_disk && options.host_bytes_may_grow) {
        const Result<ovc_plan> plan = make_plugin_plan(device, soup, options, LogSink());
        if (!plan)
            return plan.error();
        config->host_memory_bytes =
            std::max<uint64_t>(config->host_memory_bytes, plan->smallest_host_bytes);
    }
    std::unique_ptr<BuildWatch> watch;
    if (options.watching != BuildWatching::None) {
        watch = std::make_unique<BuildWatch>(options.watching == BuildWatching::Shown);
        watch->watch(*config);
    }
    Result<PluginScene> scene = device.create_scene(*config);
    if (!scene)
        return scene.error();
    MeshNumbers numbers;
    if (const Result<Done> added = add_meshes(device, scene->get(), soup, numbers); !added)
        return added.error();
    {
        std::optional<BuildWatch::Building> watched;
        if (watch)
            watched.emplace(*watch);
        const Result<Done> done = device.checked(device.api()->commit(scene->get()));
        if (!done)
            return why_not_built(device, scene->get(), options, done.error());
    }
    return std::unique_ptr<Backend>(
        std::make_unique<PluginBackend>(std::move(device), info->renderer, std::move(watch),
                                        std::move(*scene), std::move(numbers), options));
}

} // namespace ovc
