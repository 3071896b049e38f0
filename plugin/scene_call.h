// SPDX-License-Identifier: Apache-2.0
// What every function of the table that works on a scene begins and ends with.
#pragma once

#include "plugin/device.h"
#include "plugin/handles.h"

#include <fmt/format.h>

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

/// body() with the scene's turn taken.
template <class Body>
ovc_result on_scene(ovc_scene scene, const char* call, Body&& body) {
    if (!scene || scene->magic != kSceneMagic)
        return fail_without_device(OVC_ERROR_INVALID_ARGUMENT,
                                   fmt::format("{}: scene is NULL or not a scene", call).c_str());
    return guard(scene->device->messages, [&] {
        if (scene->streaming == std::this_thread::get_id())
            throw Failure{OVC_ERROR_INVALID_STATE,
                          fmt::format("{}: called from within the scene's own stream, where push "
                                      "is the only call on it",
                                      call)};
        const std::lock_guard turn(scene->turn);
        body();
    });
}

/// The triangles that rays do not see, as a span; empty for none.
inline std::span<const TriangleId> skip_of(const ovc_query* query, size_t ray_count) {
    if (!query)
        return {};
    if (query->struct_size != sizeof(ovc_query) &&
        query->struct_size != offsetof(ovc_query, leaf) &&
        query->struct_size != offsetof(ovc_query, flagged))
        invalid(fmt::format("ovc_query.struct_size is {}, expected sizeof(ovc_query) = {}",
                            query->struct_size, sizeof(ovc_query)));
    if (!query->skip)
        return {};
    return {reinterpret_cast<const TriangleId*>(query->skip), ray_count};
}

/// What else is to be told of rays. The query's size is in order: see skip_of().
inline RayNotes notes_of(const ovc_query* query, size_t ray_count) {
    if (!query || query->struct_size <= offsetof(ovc_query, leaf))
        return {};
    const auto span = [&](uint32_t* notes) {
        return notes ? std::span(notes, ray_count) : std::span<uint32_t>();
    };
    const bool has_flagged = query->struct_size > offsetof(ovc_query, flagged);
    return {span(query->leaf), span(query->passes), span(has_flagged ? query->flagged : nullptr)};
}

inline void refuse_notes(const char* call, const ovc_query* query, size_t ray_count) {
    if (notes_of(query, ray_count).any())
        invalid(fmt::format("{}: ovc_query.leaf, passes and flagged are for intersect", call));
}

inline Structure& committed(ovc_scene scene, const char* call) {
    if (!scene->structure)
        throw Failure{OVC_ERROR_INVALID_STATE,
                      fmt::format("{}: the scene is not committed yet", call)};
    return *scene->structure;
}

inline ovc_result code_of(ErrorKind kind, ovc_result otherwise) {
    switch (kind) {
    case ErrorKind::OutOfGpuMemory:
        return OVC_ERROR_OUT_OF_MEMORY;
    case ErrorKind::DeviceLost:
        return OVC_ERROR_DEVICE_LOST;
    case ErrorKind::Cancelled:
        return OVC_ERROR_CANCELLED;
    case ErrorKind::Other:
        break;
    }
    return otherwise;
}

inline void check(const Result<Done>& result) {
    if (!result)
        throw Failure{code_of(result.error().kind, OVC_ERROR_INTERNAL), result.error().message};
}

} // namespace ovc
