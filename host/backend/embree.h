// SPDX-License-Identifier: Apache-2.0
// Embree 4, or Embree 3 by the names of Embree 4, as far as they are needed here. No other file
// includes Embree.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>

using RTCRayQueryContext = RTCIntersectContext;
using RTCRayQueryFlags = RTCIntersectContextFlags;
inline constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_INCOHERENT =
    RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
inline constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_COHERENT = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
/// Embree 3 invokes the filter of a call in any case.
inline constexpr RTCRayQueryFlags RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER{};
inline constexpr RTCSceneFlags RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS =
    RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

struct RTCIntersectArguments {
    RTCRayQueryFlags flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    RTCRayQueryContext* context = nullptr;
    RTCFilterFunctionN filter = nullptr;
};
using RTCOccludedArguments = RTCIntersectArguments;

/// Hands the flags and the filter over as Embree 3 takes them.
inline RTCIntersectContext* embree3_context(RTCIntersectArguments* arguments) {
    arguments->context->flags = arguments->flags;
    arguments->context->filter = arguments->filter;
    return arguments->context;
}

inline void rtcInitRayQueryContext(RTCRayQueryContext* context) {
    rtcInitIntersectContext(context);
}
inline void rtcInitIntersectArguments(RTCIntersectArguments* arguments) {
    *arguments = {};
}
inline void rtcInitOccludedArguments(RTCOccludedArguments* arguments) {
    *arguments = {};
}
inline void rtcIntersect1(RTCScene scene, RTCRayHit* query, RTCIntersectArguments* arguments) {
    rtcIntersect1(scene, embree3_context(arguments), query);
}
inline void rtcOccluded1(RTCScene scene, RTCRay* ray, RTCOccludedArguments* arguments) {
    rtcOccluded1(scene, embree3_context(arguments), ray);
}
inline void rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* query,
                           RTCIntersectArguments* arguments) {
    rtcIntersect16(valid, scene, embree3_context(arguments), query);
}
inline void rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays,
                          RTCOccludedArguments* arguments) {
    rtcOccluded16(valid, scene, embree3_context(arguments), rays);
}

#endif
