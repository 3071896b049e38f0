// SPDX-License-Identifier: Apache-2.0
// Structure: the interface of what answers rays behind the C ABI. Each library defines the
// functions at the end for itself: libovercast.so makes two-level (two_level/make_two_level.cpp),
// libovercast-thesis.so the structures that two-level is compared with (thesis/).
#pragma once

#include "core/all_hits.h"
#include "core/build_progress.h"
#include "core/changes.h"
#include "core/exclusions.h"
#include "core/file/archive.h"
#include "core/ray_span.h"
#include "core/result.h"
#include "core/soup.h"
#include "core/stream/batched_stream.h"
#include "core/system/log.h"
#include "gpu/gl/gl_thread.h"
#include "plugin/overcast.h"
#include "plugin/structure/call_watch.h"
#include "plugin/structure/triangle_source.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>

namespace ovc {

class LeafStore;

/// So many rays the CPU answers before a pass of the kernel has begun: that takes 75 us and more,
/// whatever is asked, and a ray on the CPU 0.1 to 1 (docs/benchmarks.md, "Single rays").
inline constexpr size_t kMaxFewRays = 64;

/// Answers rays through a soup. It takes one call at a time, except where a function says
/// otherwise.
class Structure {
public:
    virtual ~Structure() = default;

    /// Returns the watch that intersect() and occluded() ask as they go on, where the structure
    /// supports it. They end with an error of the kind Cancelled when it tells them to stop.
    CallWatch& call_watch() { return watch_; }

    /// Sets hits[i], one per ray, to the nearest hit of rays[i] that is not excluded. Only skipped
    /// triangles may be excluded, and no sieves be there, unless takes_after().
    virtual Result<Done> intersect(RaySpan rays, const Exclusions& without,
                                   std::span<Hit> hits) = 0;
    virtual bool takes_after() const { return false; }
    /// Writes all hits that are not excluded. Needs takes_after().
    virtual Result<Done> all_hits(RaySpan, const Exclusions&, const AllHits&) {
        return Error{"this structure cannot tell all hits of a ray"};
    }
    /// Sets occluded[i], one per ray, to 1 where rays[i] hits anything that is not excluded, else
    /// to 0.
    virtual Result<Done> occluded(RaySpan rays, const Exclusions& without,
                                  std::span<uint8_t> occluded) = 0;
    /// Traces the rays that the host pushes until there are no more. Error of the kind Cancelled:
    /// the host stopped it. This default traces batch after batch.
    virtual Result<Done> stream(StreamHost& host) { return stream_in_batches(*this, host); }
    /// Does the same as intersect(), and fills in the notes, which are empty unless takes_notes().
    virtual Result<Done> intersect_noted(RaySpan rays, const Exclusions& without,
                                         std::span<Hit> hits,
                                         [[maybe_unused]] const RayNotes& notes) {
        assert(!notes.any());
        return intersect(rays, without, hits);
    }
    virtual bool takes_notes() const { return false; }
    /// Whether the next two functions answer single rays, which must be valid, on the CPU. They may
    /// be called from any thread and beside all other calls, and answer the same bits as
    /// intersect() and occluded() in certified precision.
    virtual bool has_cpu_tree() const { return false; }
    virtual Hit nearest_on_cpu(const Ray&, const Exclusion&, const RaySieve&) const { return {}; }
    virtual bool occluded_on_cpu(const Ray&, const Exclusion&, const RaySieve&) const {
        return false;
    }
    /// Answer rays on the CPU: with the same bits as intersect() and occluded(), from any thread
    /// and beside all other calls; hundreds of them on all cores. Add to `invalid` how many are.
    /// Return false, having done nothing, where the kernel is to answer them.
    virtual bool intersect_few(RaySpan, const Exclusions&, std::span<Hit>,
                               [[maybe_unused]] uint64_t& invalid) const {
        return false;
    }
    virtual bool occluded_few(RaySpan, const Exclusions&, std::span<uint8_t>,
                              [[maybe_unused]] uint64_t& invalid) const {
        return false;
    }
    /// Sets ranks[i] to the rank whose pages ray i comes by first, of those that no other rank has;
    /// kNone where there is none, as always where the structure is one process's.
    virtual void first_ranks([[maybe_unused]] RaySpan rays, std::span<uint32_t> ranks) const {
        std::ranges::fill(ranks, kNone);
    }
    /// Counts the pages that rays were traced through since the last call of this. Error: the
    /// structure cannot tell, or was not asked to when it was built.
    virtual Result<ovc_active> take_active() {
        return Error{"this structure does not tell which pages are active"};
    }
    /// Writes to the sink what a structure over the same soup can be made from without building.
    /// Error of the kind Cancelled: the sink wanted no more; of another kind: the structure cannot
    /// be saved.
    virtual Result<Done> save(const ByteSink&) const {
        return Error{"only two-level can be saved"};
    }
    /// The soup is about to change: from now on nobody may read it, not even to answer other
    /// processes, until update() or the structure's end.
    virtual void leave_soup() {}
    /// Brings the structure up to date with its soup, which has changed so. Returns false where it
    /// must be made anew instead; it is then of no use any more, as where this throws or returns an
    /// error. Throws Cancelled when `progress` is told to stop.
    virtual Result<bool> update([[maybe_unused]] const Changes& changes,
                                [[maybe_unused]] BuildProgress* progress) {
        return false;
    }
    /// Gives back all GPU memory, and host memory that only serves speed; the next call that needs
    /// it brings it in again. Error: the structure cannot.
    virtual Result<Done> purge() { return Error{"only two-level can be purged"}; }
    /// Counted since it was built. What a structure does not have is 0.
    virtual ovc_statistics report() const = 0;

protected:
    CallWatch watch_;
};

/// Throws a Failure where the config asks for something that this library cannot do on the device,
/// as far as that can be told before there are triangles. The caller has checked the config's size
/// and its enumerators.
void check_config(const ovc_scene_config& config, const DeviceInfo& device);

/// How a structure is to be built, whatever it is built of.
struct BuildRequest {
    GlThread& gl;                   // outlives what is built
    const ovc_scene_config& config; // which check_config() has let pass
    const LogSink& log;
    BuildProgress* progress = nullptr; // throws Cancelled when it is told to stop
};

/// Builds the structure that the config asks for. The soup must outlive it, and so must the store,
/// which reads a scene that lies on a disk. Error: the budget is too small, with the smallest that
/// works, or GL refuses something.
Result<std::unique_ptr<Structure>> make_structure(const Soup& soup, const BuildRequest& request,
                                                  LeafStore* store = nullptr);

/// Writes to the sink what save() of such a structure over the scene's meshes would, within the
/// scene's host memory. Throws as make_structure() does, and Cancelled where a function of the
/// caller's fails. Error: host or GPU memory is too small, or the structure cannot be saved.
Result<Done> save_structure(const StreamedScene& scene, const BuildRequest& request,
                            const ByteSink& sink);

/// Tells what save_structure() would write of the source, within so many bytes of host memory;
/// ovc_plan.seconds is left to the caller. Throws and fails as it does.
Result<ovc_plan> plan_streamed_structure(TriangleSource& source, uint64_t host_bytes,
                                         const BuildRequest& request);

/// Tells what make_structure() would make of the soup, or of what the store reads; ovc_plan.seconds
/// is left to the caller. Throws as make_structure() does. Error: the GPU's budget is too small for
/// any scene, the structure cannot tell, or what the store reads is damaged.
Result<ovc_plan> plan_structure(const Soup& soup, const BuildRequest& request,
                                LeafStore* store = nullptr);

} // namespace ovc
