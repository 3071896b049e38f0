// SPDX-License-Identifier: Apache-2.0
// The structure of libovercast-mpi.so: two-level, whose pages are shared out between ranks where
// they do not fit, or where the config says so.
#include "core/file/checksum.h"
#include "core/system/caught_error.h"
#include "core/text/format_text.h"
#include "plugin/leaf_store/corner_sums.h"
#include "plugin/ranks/agreement.h"
#include "plugin/ranks/ranked_scene.h"
#include "plugin/ranks/sharing.h"
#include "plugin/ranks/transport/mpi_transport.h"
#include "plugin/ranks/transport/notes.h"
#include "plugin/structure/failure.h"
#include "plugin/two_level/make_two_level.h"
#include "plugin/two_level/two_level.h"

#include <algorithm>

namespace ovc {

/// Leaves for each rank, at least, where the host does not say: so many that shares can be equal.
static constexpr uint64_t kLeavesPerRank = 8;

namespace {

/// Builds what is traced on this rank. An exception becomes an error, which the others learn of.
Result<std::unique_ptr<TwoLevel>> built_here(const Soup& soup, const BuildRequest& request,
                                             const TwoLevelOptions& options) {
    try {
        return TwoLevel::build(soup, request.gl, options, request.log, request.progress);
    } catch (const Cancelled&) {
        return Error{"commit was cancelled", ErrorKind::Cancelled};
    } catch (...) {
        return caught_error();
    }
}

/// Returns a checksum of the meshes, besides corners that lie on a disk: those are checked by what
/// was saved of them.
uint64_t checksum_of_meshes(const Soup& soup) {
    const bool is_stored = std::ranges::any_of(soup.chunks, &Chunk::stored_corners);
    Checksum sum;
    sum.add_value((is_stored ? unsummed(soup) : corner_sums_of(soup)).checksum());
    for (const Chunk& chunk : soup.chunks)
        sum.add_value(uint64_t(chunk.mask()));
    return sum.value();
}

RankTerms terms_of(const Soup& soup, const DeviceInfo& device, const ovc_scene_config& config,
                   const TwoLevelOptions& options) {
    RankTerms terms;
    terms.alike = {soup.chunks.size(), soup.triangle_count(), checksum_of_meshes(soup),
                   config.ranks_own,   config.precision,      options.leaf_triangles,
                   options.leaves};
    terms.own.gpu_bytes =
        config.gpu_memory_bytes ? config.gpu_memory_bytes : device.default_budget_bytes();
    if (config.host_memory_bytes)
        terms.own.host_bytes = config.host_memory_bytes;
    if (const Result<MemoryPlan> plan = plan_memory(soup, options, device)) {
        terms.own.pool_bytes = plan->pool_bytes;
        terms.own.buffer_bytes = plan->buffer_bytes;
    }
    terms.own.has_saved = !options.saved.empty() || options.store;
    return terms;
}

/// Lets this rank cut the scene as all ranks do.
void cut_alike(const RankTerms::Own& all, uint32_t ranks, TwoLevelOptions& options) {
    options.cut_pool_bytes = all.pool_bytes;
    options.cut_buffer_bytes = all.buffer_bytes;
    if (!all.has_saved)
        options.saved = {};
    if (!all.has_saved && !options.leaf_triangles && !options.leaves)
        options.leaves = kLeavesPerRank * ranks;
}

} // namespace

void check_config(const ovc_scene_config& config, const DeviceInfo& device) {
    check_two_level(config, device);
}

Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, const BuildRequest& request,
                                                  LeafStore* store) {
    const ovc_scene_config& config = request.config;
    Result<std::unique_ptr<Transport>> transport =
        make_mpi_transport({config.communicator, config.rank_timeout});
    if (!transport)
        return transport.error();
    TwoLevelOptions options = two_level_options(config);
    options.store = store;
    Notes notes(**transport);
    const Result<RankTerms::Own> terms =
        agreed_terms(notes, **transport, terms_of(soup, request.gl.info(), config, options));
    if (!terms)
        return terms.error();
    SharingOptions share{.rank = (*transport)->rank(),
                         .always = config.ranks_own == OVC_RANKS_OWN_SHARE,
                         .gpu_bytes = terms->gpu_bytes,
                         .host_bytes = terms->host_bytes};
    share.shares.ranks = (*transport)->ranks();
    share.shares.sample = {reinterpret_cast<const Ray*>(config.sample), size_t(config.sample_rays)};
    Sharing sharing(share, request.log);
    if ((*transport)->ranks() > 1 && config.ranks_own != OVC_RANKS_OWN_ALL) {
        options.choose_pages = [&](const BuiltScene& scene) { return sharing.choose(scene); };
        cut_alike(*terms, (*transport)->ranks(), options);
    }
    Result<std::unique_ptr<TwoLevel>> local = built_here(soup, request, options);
    // Where one could not build, its leaves would differ from those of the others as well.
    const Result<Done> built = local ? Result<Done>(Done{}) : Result<Done>(local.error());
    if (const Result<Done> all = first_error(notes, **transport, built); !all)
        return all.error();
    const Result<Done> alike = check_shares(notes, **transport, sharing.checksum());
    if (const Result<Done> all = first_error(notes, **transport, alike); !all)
        return all.error();
    if (!sharing.shares())
        return std::unique_ptr<Structure>(std::move(*local));
    return std::unique_ptr<Structure>(std::make_unique<RankedScene>(
        soup, RankedParts{std::move(*transport), std::move(*local), sharing.take_finder(),
                          LoopThreads::of_this_thread()}));
}

Result<ovc_plan> plan_structure(const Soup& soup, const BuildRequest& request, LeafStore* store) {
    return plan_two_level(soup, request.gl.info(), request.config, request.progress, store);
}

Result<Done> save_structure(const StreamedScene&, const BuildRequest&, const ByteSink&) {
    throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                  "save_streamed: one process builds what is saved; libovercast.so does it"};
}

Result<ovc_plan> plan_streamed_structure(TriangleSource&, uint64_t, const BuildRequest&) {
    throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                  "plan_streamed: one process builds what is saved; libovercast.so plans it"};
}

} // namespace ovc
