// SPDX-License-Identifier: Apache-2.0
// on_scene() and beside_scene(): the frames of every function of the table that works on a scene.
#pragma once

#include "core/text/format_text.h"
#include "plugin/abi/device.h"
#include "plugin/abi/handles.h"
#include "plugin/structure/in_stream.h"

#include <cstddef>

namespace ovc {

// The records of the ABI are the records of core, byte for byte: batches cross without a copy.
static_assert(sizeof(ovc_ray) == sizeof(Ray) && offsetof(ovc_ray, t_min) == offsetof(Ray, t_min) &&
              offsetof(ovc_ray, dir) == offsetof(Ray, dir) &&
              offsetof(ovc_ray, t_max) == offsetof(Ray, t_max));
static_assert(sizeof(ovc_hit) == sizeof(Hit) && offsetof(ovc_hit, u) == offsetof(Hit, u) &&
              offsetof(ovc_hit, mesh) == offsetof(Hit, id));
static_assert(sizeof(ovc_triangle) == sizeof(TriangleId) && OVC_NONE == kNone);

[[noreturn]] inline void invalid(std::string message) {
    throw Failure{OVC_ERROR_INVALID_ARGUMENT, std::move(message)};
}

/// Returns whether the handle is that of a scene that lives and belongs to this process, not to the
/// one that this was forked from. If not, it records a message for last_error(NULL).
inline bool is_scene(ovc_scene scene, const char* call) {
    if (scene && scene->magic == kSceneMagic)
        return is_device(scene->device, call);
    const bool destroyed = scene && scene->magic == kDestroyed;
    const std::string message = format_text(
        "{}: {}", call, destroyed ? "the scene is destroyed" : "scene is NULL or not a scene");
    if (destroyed && is_device(scene->device, call))
        scene->device->messages.set(OVC_ERROR_INVALID_ARGUMENT, message);
    fail_without_device(OVC_ERROR_INVALID_ARGUMENT, message);
    return false;
}

/// Runs body() beside all other calls on the handle of a scene or a ticket, which is not destroyed
/// before body() ends. lives(handle, call): whether the handle is alive; if not, it has recorded a
/// message.
template <class Handle, class Lives, class Body>
ovc_result beside_calls(Handle* handle, const char* call, Lives&& lives, Body&& body) {
    if (!lives(handle, call))
        return OVC_ERROR_INVALID_ARGUMENT;
    const CallsInside::Call inside(handle->calls);
    if (!lives(handle, call)) // a thread may have destroyed it before this call was counted
        return OVC_ERROR_INVALID_ARGUMENT;
    return guard(handle->device->messages, [&] {
        const LoopThreads::Scope threads(handle->device->loops);
        body();
    });
}

/// Runs body() beside all other calls on the scene, without the scene's turn.
template <class Body>
ovc_result beside_scene(ovc_scene scene, const char* call, Body&& body) {
    return beside_calls(scene, call, is_scene, std::forward<Body>(body));
}

[[noreturn]] inline void cancelled(const char* call) {
    throw Failure{OVC_ERROR_CANCELLED, format_text("{}: cancelled", call)};
}

/// Throws a Failure where this thread, which is inside a stream and waits for the scene's turn or
/// for what is done in it, waits for a call that waits for the budget of that stream.
inline void check_budget(ovc_scene scene, const SharedBudget::Waiting& waiting, const char* call) {
    if (waiting.is_in_vain(scene->turn.owner()))
        throw Failure{
            OVC_ERROR_OUT_OF_BUDGET,
            format_text("{}: the stream that it comes from leaves the scene no room in the "
                        "budget that they share",
                        call)};
}

/// As Turn::lock_while(). Throws a Failure where it would wait for ever.
template <class GoesOn>
bool lock_within_stream(ovc_scene scene, const char* call, GoesOn&& goes_on) {
    const SharedBudget::Waiting waiting(scene->device->gl->budget());
    return scene->turn.lock_while([&] {
        check_budget(scene, waiting, call);
        return goes_on();
    });
}

/// Runs body() in the scene's turn, within beside_scene(). goes_on() is asked while other calls
/// have the turn; where it returns false, this call throws the Failure of a cancelled one.
template <class GoesOn, class Body>
void in_turn(ovc_scene scene, const char* call, GoesOn&& goes_on, Body&& body) {
    if (scene->streaming == std::this_thread::get_id())
        throw Failure{OVC_ERROR_INVALID_STATE,
                      format_text("{}: called from within the scene's own stream, where push "
                                  "is the only call on it",
                                  call)};
    if (!(in_stream ? lock_within_stream(scene, call, goes_on) : scene->turn.lock_while(goes_on)))
        cancelled(call);
    const std::lock_guard turn(scene->turn, std::adopt_lock);
    if (scene->magic != kSceneMagic)
        throw Failure{OVC_ERROR_INVALID_STATE,
                      format_text("{}: the scene was destroyed before its turn came", call)};
    body();
}

/// Runs body() in the scene's turn.
template <class Body>
ovc_result on_scene(ovc_scene scene, const char* call, Body&& body) {
    return beside_scene(scene, call, [&] {
        in_turn(
            scene, call, [] { return true; }, body);
    });
}

[[noreturn]] inline void not_committed(const char* call) {
    throw Failure{
        OVC_ERROR_INVALID_STATE,
        format_text("{}: the scene is not committed yet, or has changed since it was", call)};
}

inline Structure& committed(ovc_scene scene, const char* call) {
    if (!scene->structure || scene->changes.any())
        not_committed(call);
    return *scene->structure;
}

inline ovc_result code_of(ErrorKind kind, ovc_result otherwise) {
    switch (kind) {
    case ErrorKind::InvalidArgument:
        return OVC_ERROR_INVALID_ARGUMENT;
    case ErrorKind::OutOfGpuMemory:
    case ErrorKind::OutOfMemory:
        return OVC_ERROR_OUT_OF_MEMORY;
    case ErrorKind::OverBudget:
        return OVC_ERROR_OUT_OF_BUDGET;
    case ErrorKind::DeviceLost:
        return OVC_ERROR_DEVICE_LOST;
    case ErrorKind::Cancelled:
        return OVC_ERROR_CANCELLED;
    case ErrorKind::Unreadable:
        return OVC_ERROR_UNREADABLE;
    case ErrorKind::InvalidState:
        return OVC_ERROR_INVALID_STATE;
    case ErrorKind::Other:
        break;
    }
    return otherwise;
}

template <class T>
void check(const Result<T>& result) {
    if (!result)
        throw Failure{code_of(result.error().kind, OVC_ERROR_INTERNAL), result.error().message};
}

} // namespace ovc
