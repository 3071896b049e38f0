// SPDX-License-Identifier: Apache-2.0
// The structs that the opaque handles of overcast.h point to, and guard(), which turns failures
// into result codes.
#pragma once

#include "core/changes.h"
#include "core/soup.h"
#include "core/system/caught_error.h"
#include "core/system/log.h"
#include "core/system/parallel.h"
#include "core/system/turn.h"
#include "core/text/printable.h"
#include "gpu/gl/fork_mark.h"
#include "gpu/gl/gl_thread.h"
#include "plugin/abi/asked_filter.h"
#include "plugin/abi/calls_inside.h"
#include "plugin/abi/float_mode.h"
#include "plugin/abi/host_function.h"
#include "plugin/abi/submissions.h"
#include "plugin/leaf_store/leaf_store.h"
#include "plugin/overcast.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/faster_by_turns.h"
#include "plugin/structure/single_rays.h"
#include "plugin/structure/structure.h"

#include <atomic>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>

namespace ovc {

/// Keeps the last message of each thread, and tells the host's function of each.
class Messages {
public:
    /// Sets the host's function (NULL: none), before any call fails. It runs on the thread of the
    /// call that fails, and may ask for the message.
    void tell(ovc_error_function function, void* user) {
        function_ = function;
        user_ = user;
    }
    void set(ovc_result code, const std::string& message) {
        {
            const std::lock_guard lock(mutex_);
            messages_[std::this_thread::get_id()] = printable(message);
        }
        if (!function_ || in_host_function)
            return;
        const HostFunction mark;
        function_(user_, code, get());
    }
    const char* get() noexcept {
        const std::lock_guard lock(mutex_);
        const auto found = messages_.find(std::this_thread::get_id());
        return found == messages_.end() ? "" : found->second.c_str();
    }

private:
    std::mutex mutex_;
    std::map<std::thread::id, std::string> messages_;
    ovc_error_function function_ = nullptr;
    void* user_ = nullptr;
};

inline constexpr uint32_t kDeviceMagic = 0x6f766344;
inline constexpr uint32_t kSceneMagic = 0x6f766353;
inline constexpr uint32_t kStreamMagic = 0x6f766354;
inline constexpr uint32_t kTicketMagic = 0x6f766355;
inline constexpr uint32_t kDestroyed = 0x6f766300;

class RayStream;
struct RayCall;

/// What reads a mesh's corners: the host's function and its user, how many triangles there are, and
/// whether corners are doubles. Meshes of the same one show the same corners, as instances do.
using CornerReader = std::tuple<ovc_read_corners_function, void*, uint64_t, uint32_t>;

/// The mesh whose corners a chunk has.
struct MeshSource {
    uint32_t mesh;          // its own number for a mesh; kNone once it is removed
    uint32_t instances = 0; // of a mesh: those that are not removed
};

} // namespace ovc

/// The handle that push() takes. It is part of its scene, so that a push() after the stream's end
/// is an error and no access to freed memory.
struct ovc_stream_t {
    std::atomic<uint32_t> magic{0}; // kStreamMagic while stream() runs
    ovc_scene scene = nullptr;
    ovc::RayStream* rays = nullptr;       // set while a function of the host runs
    std::deque<ovc::AskedFilter> filters; // of the rays that were pushed
};

struct ovc_ticket_t {
    std::atomic<uint32_t> magic{ovc::kTicketMagic};
    ovc::CallsInside calls;
    ovc_device device = nullptr;
    ovc_scene scene = nullptr; // alive until the submission is done
    std::shared_ptr<ovc::Submission> submission;
    std::unique_ptr<ovc_ticket_t> next; // of those that are released
};

struct ovc_scene_t {
    std::atomic<uint32_t> magic{ovc::kSceneMagic};
    ovc::CallsInside calls;
    ovc_device device = nullptr;
    ovc::Turn turn; // calls on one scene wait here
    ovc_scene_config config{sizeof(ovc_scene_config)};
    std::string kernel_variant;            // what the config points to
    std::unique_ptr<ovc::LeafStore> store; // of a scene that need not fit into host memory
    std::map<ovc::CornerReader, const ovc::StoredCorners*> stored; // the store's meshes
    ovc::Soup soup;
    /// By number: chunks that no ray hits themselves; the soup has an empty one in their place.
    std::map<uint32_t, ovc::Chunk> templates;
    std::vector<ovc::MeshSource> sources;            // one per chunk
    std::map<uint32_t, ovc::Transform> placed_first; // by what an instance's mesh was placed
    ovc::Changes changes;                            // since the commit; none without a structure
    std::unique_ptr<ovc::Structure> structure;       // set by commit
    ovc::Submissions submissions;
    ovc::SingleRays single_rays{turn};
    ovc::Gathering<const ovc::RayCall> batches; // of threads that ask at once
    ovc::FasterByTurns ways_of_batches;         // of nearest hits; 1: on the CPU
    std::atomic<std::thread::id> streaming;     // the thread that is inside stream(), if any
    ovc_stream_t stream;
    std::unique_ptr<ovc_scene_t> next; // of those that are destroyed
};

namespace ovc {

/// Keeps the handles that a device has destroyed last, emptied, so that a thread that comes too
/// late with one of them gets an error. Each has the next, so that keeping one takes no memory.
template <class Handle>
class DestroyedHandles {
public:
    DestroyedHandles() = default;
    ~DestroyedHandles() {
        while (first_)
            pop_first();
    }
    DestroyedHandles(const DestroyedHandles&) = delete;

    void add(std::unique_ptr<Handle> handle) noexcept {
        const std::lock_guard lock(mutex_);
        Handle* const added = handle.get();
        (first_ ? last_->next : first_) = std::move(handle);
        last_ = added;
        if (++count_ > kMax && first_->calls.none())
            pop_first();
    }

private:
    static constexpr size_t kMax = 1000;

    void pop_first() {
        first_ = std::move(first_->next);
        --count_;
    }

    std::mutex mutex_;
    std::unique_ptr<Handle> first_;
    Handle* last_ = nullptr; // where there is a first
    size_t count_ = 0;
};

} // namespace ovc

struct ovc_device_t {
    explicit ovc_device_t(uint32_t threads) : loops(threads) {}

    std::atomic<uint32_t> magic{ovc::kDeviceMagic};
    ovc::CallsInside calls;
    ovc::ForkMark mark;
    ovc::Messages messages;
    ovc::LogSink log;
    ovc::LoopThreads loops;
    std::unique_ptr<ovc::GlThread> gl;
    std::atomic<int> scenes{0};
    std::atomic<int> tickets{0};
    ovc::DestroyedHandles<ovc_scene_t> destroyed;
    ovc::DestroyedHandles<ovc_ticket_t> released;
};

namespace ovc {

/// Runs body() in the default floating-point mode. Returns OVC_OK, or the code of what body()
/// throws, whose message goes to messages.set(code, message) in the host's floating-point mode
/// and may throw for want of memory.
template <class Keeper, class Body>
ovc_result told_result(Keeper& messages, Body&& body) {
    const auto fail = [&](ovc_result code, const std::string& message) {
        messages.set(code, message);
        return code;
    };
    try {
        const DefaultFloatMode mode;
        if (in_host_function)
            throw Failure{
                OVC_ERROR_INVALID_STATE,
                "called from within a function for errors, logs, progress or what is saved, where "
                "last_error is the only call"};
        body();
        return OVC_OK;
    } catch (const Failure& failure) {
        return fail(failure.code, failure.message);
    } catch (const std::bad_alloc&) {
        return fail(OVC_ERROR_OUT_OF_MEMORY, "out of host memory");
    } catch (const std::exception& e) {
        const std::optional<Error> refused = refused_thread(e);
        return refused ? fail(OVC_ERROR_OUT_OF_MEMORY, refused->message)
                       : fail(OVC_ERROR_INTERNAL, std::string("internal error: ") + e.what());
    } catch (...) {
        return fail(OVC_ERROR_INTERNAL, "internal error");
    }
}

/// Does the same, but throws nothing.
template <class Keeper, class Body>
ovc_result guard(Keeper& messages, Body&& body) noexcept {
    try {
        return told_result(messages, std::forward<Body>(body));
    } catch (...) {
        return OVC_ERROR_OUT_OF_MEMORY; // there was no room even for a message
    }
}

template <auto function>
struct NoThrow;

template <class Value, class... Args, Value (*function)(Args...)>
struct NoThrow<function> {
    static Value call(Args... args) noexcept {
        try {
            return function(args...);
        } catch (...) {
            if constexpr (!std::is_void_v<Value>)
                return OVC_ERROR_OUT_OF_MEMORY;
        }
    }
};

/// A function of the ABI, for a table that C calls. Before and behind guard() it may throw for want
/// of memory, as where it has a message about a handle that is none. This throws nothing.
template <auto function>
inline constexpr auto no_throw = NoThrow<function>::call;

} // namespace ovc
