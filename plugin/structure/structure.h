// SPDX-License-Identifier: Apache-2.0
// Structure: what answers rays behind the C ABI. Each library has its own two functions below:
// libovercast.so makes two-level (make_two_level.cpp), libovercast-thesis.so what two-level is
// compared with (thesis/).
#pragma once

#include "core/batched_stream.h"
#include "core/build_progress.h"
#include "core/file/archive.h"
#include "core/ray_span.h"
#include "core/result.h"
#include "core/soup.h"
#include "core/system/log.h"
#include "gpu/gl/gl_thread.h"
#include "plugin/overcast.h"
#include "plugin/structure/call_watch.h"

#include <cassert>
#include <memory>
#include <span>

namespace ovc {

/// Built over a soup. One call at a time, but for those that say otherwise.
class Structure {
public:
    virtual ~Structure() = default;

    /// What intersect and occluded ask as they go on, if the structure can. Error of the kind
    /// Cancelled where they are told to stop.
    CallWatch& call_watch() { return watch_; }

    /// hits[i] for rays[i]; skip: empty, or per ray the triangle it does not see.
    virtual Result<Done> intersect(RaySpan rays, std::span<const TriangleId> skip,
                                   std::span<Hit> hits) = 0;
    /// occluded[i] = 1 or 0 for rays[i].
    virtual Result<Done> occluded(RaySpan rays, std::span<const TriangleId> skip,
                                  std::span<uint8_t> occluded) = 0;
    /// Traces what the host pushes until there is no more. Error of the kind Cancelled: the host
    /// stopped it. Here: batch after batch, for structures that know no better.
    virtual Result<Done> stream(StreamHost& host) { return stream_in_batches(*this, host); }
    /// intersect(), which fills in the notes as well. Only where takes_notes().
    virtual Result<Done> intersect_noted(RaySpan rays, std::span<const TriangleId> skip,
                                         std::span<Hit> hits,
                                         [[maybe_unused]] const RayNotes& notes) {
        assert(!notes.any());
        return intersect(rays, skip, hits);
    }
    virtual bool takes_notes() const { return false; }
    /// Whether single rays, valid ones, can be answered on the CPU, from any thread and beside all
    /// other calls: the same bits as intersect() and occluded(), those of certified precision.
    virtual bool has_cpu_tree() const { return false; }
    virtual Hit nearest_on_cpu(const Ray&, TriangleId) const { return {}; }
    virtual bool occluded_on_cpu(const Ray&, TriangleId) const { return false; }
    /// The pages that rays were traced through since this was asked last. Error: a structure that
    /// cannot tell, or was not asked to when it was built.
    virtual Result<ovc_active> take_active() {
        return Error{"this structure does not tell which pages are active"};
    }
    /// Passes on what a structure over the same soup can be made from without building. Error of
    /// the kind Cancelled: the sink wanted no more; else: it cannot be saved.
    virtual Result<Done> save(const ByteSink&) const {
        return Error{"only two-level can be saved"};
    }
    /// Gives back all GPU memory, and host memory that only serves speed; the next call that needs
    /// it brings it in again. Error: a structure that cannot.
    virtual Result<Done> purge() { return Error{"only two-level can be purged"}; }
    /// Counted since it was built. What a structure does not have is 0.
    virtual ovc_statistics report() const = 0;

protected:
    CallWatch watch_;
};

/// Throws a Failure for what this library cannot do on the device, as far as that can be told
/// before there are triangles. The config's size and its enumerators are in order.
void check_config(const ovc_scene_config& config, const DeviceInfo& device);

/// The structure that the config, checked before, asks for. The soup and the thread must outlive
/// it. Error: a budget too small, with the smallest that works; GL's refusals. Throws Cancelled
/// when told to stop.
Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, GlThread& gl,
                                                  const ovc_scene_config& config,
                                                  const LogSink& log,
                                                  BuildProgress* progress = nullptr);

/// What make_structure() would make, but for seconds. Throws as it does. Error: a budget too small
/// for anything, or a structure that cannot tell.
Result<ovc_plan> plan_structure(const Soup& soup, const DeviceInfo& device,
                                const ovc_scene_config& config, BuildProgress* progress = nullptr);

} // namespace ovc
