// SPDX-License-Identifier: Apache-2.0
// Backend: what answers rays. The plugin, or what it is compared with: the systems of
// the thesis, the CPU KD-tree and Embree.
#pragma once

#include "core/batched_stream.h"
#include "core/file/archive.h"
#include "core/ray.h"
#include "core/result.h"
#include "core/soup.h"
#include "core/system/log.h"
#include "host/arguments/memory_size.h"
#include "plugin/overcast.h"

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace ovc {

class DeviceOpening;
class PluginDevice;
struct KdTree;

/// Built over one soup, which it may use in place: the soup outlives it unchanged.
class Backend {
public:
    virtual ~Backend() = default;

    /// The nearest hit of each ray. skip: empty, or for each ray the triangle it starts on and does
    /// not see. hits: as many as rays.
    virtual Result<Done> intersect(std::span<const Ray> rays, std::span<const TriangleId> skip,
                                   std::span<Hit> hits) = 0;
    /// occluded[i] = 1 when ray i hits anything, else 0.
    virtual Result<Done> occluded(std::span<const Ray> rays, std::span<const TriangleId> skip,
                                  std::span<uint8_t> occluded) = 0;
    /// The mixed form: traces what the host pushes until there is no more. Error of the kind
    /// Cancelled: it stopped.
    virtual Result<Done> stream(StreamHost& host) { return stream_in_batches(*this, host); }
    /// intersect() with notes. Error: a backend without leaves.
    virtual Result<Done> intersect_noted(std::span<const Ray> rays,
                                         std::span<const TriangleId> skip, std::span<Hit> hits,
                                         const RayNotes& notes) {
        return notes.any()
                   ? Error{"leaf, passes and flagged can be told by --backend two-level alone"}
                   : intersect(rays, skip, hits);
    }
    /// The pages that rays went through since this was asked last; none where the options did not
    /// ask for it or the backend cannot tell.
    virtual std::optional<ovc_active> take_active() { return {}; }
    /// Whether save() can do anything.
    virtual bool saves() const { return false; }
    /// Passes on what BackendOptions::saved of a later run over the same soup takes.
    virtual Result<Done> save(const ByteSink&) const { return Error{"this backend saves nothing"}; }
    /// Counted since it was built. What a backend does not have is 0.
    virtual ovc_statistics statistics() const = 0;
    /// What does the work, for a person: the GL renderer's name, or the CPU.
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

/// What the backend is to the ABI: two-level unless it is one of the thesis.
inline ovc_structure structure_of(BackendKind kind) {
    return kind < BackendKind::SingleTexture
               ? OVC_STRUCTURE_TWO_LEVEL
               : ovc_structure(int(kind) - int(BackendKind::SingleTexture) +
                               OVC_STRUCTURE_SINGLE_TEXTURE);
}

/// Whether Ctrl-C cancels the plugin's building, which then is an Error of the kind Cancelled, and
/// a line on a terminal says how far it is. Not while another InterruptGuard lives.
enum class BuildWatching { None, Silent, Shown };

struct BackendOptions {
    BackendKind kind = BackendKind::Auto;
    MemorySize gpu_memory;
    uint64_t leaf_triangles = 0; // 0: the plugin's default
    uint32_t leaves = 0;         // 0: as leaf_triangles says
    std::string device;          // empty: the plugin chooses
    ovc_precision precision = OVC_PRECISION_CERTIFIED;
    ovc_kernel kernel = OVC_KERNEL_AUTO;
    ovc_level1 level1 = OVC_LEVEL1_KD_TREE; // of ThesisTwoLevel, as the next
    ovc_level1_build level1_build = OVC_LEVEL1_BUILD_TOP_DOWN;
    bool tell_active = false; // of two-level: take_active() is asked
    BuildWatching watching = BuildWatching::None;
    Bytes saved{}; // of an earlier run over the same soup; outlives the backend. Two-level only
};

/// Auto is the plugin; where no device opens and none was named it is the CPU KD-tree, and the log
/// gets a warning that says so.
Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log);

/// The same with a device that was begun to be opened for these options.
Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log, DeviceOpening& opening);

/// What make_backend() would make of the soup, told by the plugin before anything is built. Error:
/// no plugin or no device; a backend that cannot tell.
Result<ovc_plan> make_plan(const Soup& soup, const BackendOptions& options, const LogSink& log);

/// The options' device is not looked at again. Through plugin/overcast.h and nothing else. The log
/// is told of a budget beyond what the device has.
Result<std::unique_ptr<Backend>> make_plugin_backend(PluginDevice device, const Soup& soup,
                                                     const BackendOptions& options,
                                                     const LogSink& log);

Result<ovc_plan> make_plugin_plan(const PluginDevice& device, const Soup& soup,
                                  const BackendOptions& options, const LogSink& log);

std::unique_ptr<Backend> make_cpu_backend(const Soup& soup);
/// Over a tree that is there already, and took so long to build.
std::unique_ptr<Backend> make_cpu_backend(const Soup& soup, std::shared_ptr<const KdTree> tree,
                                          double build_seconds);

/// Medium and High are its build qualities (High splits triangles that are long); Robust is High
/// with RTC_SCENE_FLAG_ROBUST, with which Embree 3 splits none; Packets is High, asked for 16 rays
/// in a call.
enum class EmbreeMode { Medium, High, Robust, Packets };

/// Embree has floats only: world positions and rays are rounded to them, and rays with numbers
/// beyond 1.8e18 miss. Error: this program was built without Embree, or Embree cannot build.
Result<std::unique_ptr<Backend>> make_embree_backend(const Soup& soup, EmbreeMode mode);

} // namespace ovc
