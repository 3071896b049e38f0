// SPDX-License-Identifier: Apache-2.0
// The structure of libovercast.so: two-level on one machine.
#include "core/text/format_text.h"
#include "plugin/out_of_core/streamed_build.h"
#include "plugin/out_of_core/streamed_plan.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/structure.h"
#include "plugin/two_level/make_two_level.h"
#include "plugin/two_level/two_level.h"

namespace ovc {

void check_config(const ovc_scene_config& config, const DeviceInfo& device) {
    if (config.communicator || config.ranks_own || config.rank_timeout > 0 || config.sample)
        throw Failure{OVC_ERROR_INVALID_ARGUMENT,
                      "ovc_scene_config.communicator, ranks_own, rank_timeout and sample are for "
                      "libovercast-mpi.so: expected 0"};
    check_two_level(config, device);
}

Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, const BuildRequest& request,
                                                  LeafStore* store) {
    TwoLevelOptions options = two_level_options(request.config);
    options.store = store;
    Result<std::unique_ptr<TwoLevel>> built =
        TwoLevel::build(soup, request.gl, options, request.log, request.progress);
    if (!built)
        return built.error();
    return std::unique_ptr<Structure>(std::move(*built));
}

Result<ovc_plan> plan_structure(const Soup& soup, const BuildRequest& request, LeafStore* store) {
    return plan_two_level(soup, request.gl.info(), request.config, request.progress, store);
}

Result<Done> save_structure(const StreamedScene& scene, const BuildRequest& request,
                            const ByteSink& sink) {
    const Result<StreamedLevels> saved =
        save_streamed(scene, two_level_options(request.config), request.gl.info(), sink,
                      request.log, request.progress);
    if (!saved)
        return saved.error();
    return Done{};
}

Result<ovc_plan> plan_streamed_structure(TriangleSource& source, uint64_t host_bytes,
                                         const BuildRequest& request) {
    return plan_streamed(source, host_bytes, two_level_options(request.config), request.gl.info(),
                         request.progress);
}

} // namespace ovc
