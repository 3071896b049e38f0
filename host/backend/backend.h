// SPDX-License-Identifier: Apache-2.0
// A Backend answers rays. It is the plugin, or one of those that it is compared with: the systems
// of the thesis, the CPU KD-tree and Embree.
#pragma once

#include "core/exclusions.h"
#include "core/file/archive.h"
#include "core/ray.h"
#include "core/result.h"
#include "core/soup.h"
#include "core/stream/batched_stream.h"
#include "core/system/log.h"
#include "host/arguments/memory_size.h"
#include "plugin/overcast.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

class DeviceOpening;
class PluginDevice;
struct KdTree;
class SceneOnDisk;
struct SoupDifference;

/// A backend is built over one soup, whose corners it may use in place: the soup outlives it, and
/// changes only as update() is told. One thread at a time calls the backend.
class Backend {
public:
    virtual ~Backend() = default;

    /// Writes the nearest hit of each ray that `without` does not exclude. hits: as many as rays.
    /// Error: sieves, which the systems of the thesis do not have.
    virtual Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                                   std::span<Hit> hits) = 0;
    /// Writes occluded[i] = 1 where ray i hits anything, else 0. Sizes as in intersect().
    virtual Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                                  std::span<uint8_t> occluded) = 0;
    /// The mixed form: traces the rays that the host pushes until there are no more. An Error of
    /// the kind Cancelled means that the host stopped it.
    virtual Result<Done> stream(StreamHost& host) { return stream_in_batches(*this, host); }
    /// Does intersect() and takes notes of each ray. Error: the backend has no leaves.
    virtual Result<Done> intersect_noted(std::span<const Ray> rays, const Exclusions& without,
                                         std::span<Hit> hits, const RayNotes& notes) {
        return notes.any()
                   ? Error{"leaf, passes and flagged can be told by --backend two-level alone"}
                   : intersect(rays, without, hits);
    }
    /// Takes up the soup after take_over() has changed it so (host/scene/soup_difference.h).
    /// Returns false where the backend must be made anew.
    virtual Result<bool> update(const Soup&, const SoupDifference&) { return false; }
    /// Returns the pages that rays went through since the last call; none where the options did not
    /// ask for them or the backend cannot tell.
    virtual std::optional<ovc_active> take_active() { return {}; }
    /// Gives back GPU memory, and what host memory only serves speed, until rays are traced again;
    /// not where the backend cannot.
    virtual void purge() {}
    /// Returns for each ray the rank whose leaves it comes by first, of those that no other rank
    /// has, or kNone; nothing where ranks do not share a scene out.
    virtual std::vector<uint32_t> first_ranks(std::span<const Ray>) const { return {}; }
    /// Returns whether save() can do anything.
    virtual bool saves() const { return false; }
    /// Writes what was built, as a later run over the same soup takes it in BackendOptions::saved.
    virtual Result<Done> save(const ByteSink&) const { return Error{"this backend saves nothing"}; }
    /// Whether pages lie outside of the GPU's memory. The order of calls then decides which of them
    /// are moved.
    virtual bool moves_pages() const { return false; }
    /// Returns what was counted since the backend was built; 0 for what a backend does not have.
    virtual ovc_statistics statistics() const = 0;
    /// Returns the name, for the user, of the GL renderer or the CPU library that does the work.
    virtual std::string renderer() const = 0;
};

enum class BackendKind {
    Auto,
    TwoLevel,
    CpuKdTree,
    Embree,
    // of libovercast-thesis.so, in the order of ovc_structure
    SingleTexture,
    MultiTexture,
    GpuGrid,
    GpuKdTree,
    SkipBvh,
    ThesisTwoLevel
};

/// Returns the ABI's name for the backend: two-level unless it is a system of the thesis.
inline ovc_structure structure_of(BackendKind kind) {
    return kind < BackendKind::SingleTexture
               ? OVC_STRUCTURE_TWO_LEVEL
               : ovc_structure(int(kind) - int(BackendKind::SingleTexture) +
                               OVC_STRUCTURE_SINGLE_TEXTURE);
}

/// Silent: Ctrl-C cancels the plugin's building, with an Error of the kind Cancelled. Shown: a line
/// on a terminal tells the progress as well.
enum class BuildWatching { None, Silent, Shown };

struct BackendOptions {
    BackendKind kind = BackendKind::Auto;
    MemorySize gpu_memory;
    uint64_t leaf_triangles = 0; // 0: the plugin's default
    uint32_t leaves = 0;         // 0: as leaf_triangles says
    std::string device;          // empty: the plugin chooses
    ovc_precision precision = OVC_PRECISION_CERTIFIED;
    ovc_kernel kernel = OVC_KERNEL_AUTO;
    std::string kernel_variant;             // as in ovc_scene_config; empty: the plugin's default
    ovc_level1 level1 = OVC_LEVEL1_KD_TREE; // of ThesisTwoLevel, like the next
    ovc_level1_build level1_build = OVC_LEVEL1_BUILD_TOP_DOWN;
    bool tell_active = false; // counts pages for take_active(); two-level only
    BuildWatching watching = BuildWatching::None;
    uint64_t host_bytes = 0;              // of host memory, for a scene on a disk; 0: no limit
    bool host_bytes_may_grow = false;     // to what the scene needs, where nobody asked for so few
    uint32_t host_shares = 1;             // so many backends share host_bytes evenly
    const SceneOnDisk* on_disk = nullptr; // what was saved lies there; outlives the backend
    ovc_ranks_own ranks_own = OVC_RANKS_OWN_AUTO; // where there are several ranks, like the next
    double rank_timeout = 0;                      // seconds; 0: the library's default
    std::span<const Ray> sample{}; // rays such as will be traced; outlives the making
    Bytes saved{}; // of an earlier run over the same soup; outlives the backend. Two-level only
};

/// Makes the backend that the options ask for. Auto is the plugin; where the machine has no device
/// and the options name none, it is the CPU KD-tree, and a warning in the log says so.
Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log);

/// Makes the same with a device whose opening for these options has begun. It takes the device: the
/// opening cannot be used again.
Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log, DeviceOpening& opening);

/// Returns what make_backend() would make of the soup, as the plugin tells it before anything is
/// built. Error: there is no plugin or no device, or the backend cannot tell.
Result<ovc_plan> make_plan(const Soup& soup, const BackendOptions& options, const LogSink& log);

/// Makes a backend on `device`, through plugin/overcast.h and nothing else; options.device is not
/// read. A warning in the log tells of a budget beyond the device's memory.
Result<std::unique_ptr<Backend>> make_plugin_backend(PluginDevice device, const Soup& soup,
                                                     const BackendOptions& options,
                                                     const LogSink& log);

Result<ovc_plan> make_plugin_plan(const PluginDevice& device, const Soup& soup,
                                  const BackendOptions& options, const LogSink& log);

/// A warning in the log tells of triangles that it leaves out.
std::unique_ptr<Backend> make_cpu_backend(const Soup& soup, const LogSink& log = {});
/// Makes the backend over a tree of this soup, which outlives it. build_seconds goes into the
/// statistics.
std::unique_ptr<Backend> make_cpu_backend(const Soup& soup, const KdTree& tree,
                                          double build_seconds);

/// Medium and High are Embree's build qualities (High splits triangles that are long). Robust is
/// High with RTC_SCENE_FLAG_ROBUST, with which Embree 3 splits none. Packets is High, asked for 16
/// rays in a call.
enum class EmbreeMode { Medium, High, Robust, Packets };

/// Embree has floats only: world positions and rays are rounded to floats, and rays with numbers
/// beyond 1.8e18 miss. A warning in the log tells of triangles that it leaves out. Error: this
/// program was built without Embree, or Embree cannot build.
Result<std::unique_ptr<Backend>> make_embree_backend(const Soup& soup, EmbreeMode mode,
                                                     const LogSink& log = {});

} // namespace ovc
