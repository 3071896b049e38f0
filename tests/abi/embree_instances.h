// SPDX-License-Identifier: Apache-2.0
// A scene of Embree's own instances, to compare those behind the C ABI with.
#pragma once

#include "core/ray.h"
#include "core/soup.h"
#include "host/backend/embree.h"

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace ovc::test {

/// Traces Embree's instances in robust mode. Their transforms are floats.
class EmbreeInstances {
public:
    EmbreeInstances() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {}
    ~EmbreeInstances() {
        rtcReleaseScene(scene_);
        for (RTCScene mesh : meshes_)
            rtcReleaseScene(mesh);
        rtcReleaseDevice(device_);
    }
    void add_mesh(const std::vector<vec3>& corners) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                            corners.size()),
                    corners.data(), corners.size() * 12);
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, corners.size() / 3));
        for (uint32_t i = 0; i < corners.size(); ++i)
            indices[i] = i;
        rtcCommitGeometry(mesh);
        RTCScene scene = rtcNewScene(device_);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcAttachGeometry(scene, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene);
        meshes_.push_back(scene);
    }
    void add_instance(size_t mesh, const std::array<double, 12>& rows) {
        RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, meshes_[mesh]);
        const std::vector<float> floats(rows.begin(), rows.end());
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, floats.data());
        rtcCommitGeometry(instance);
        rtcAttachGeometry(scene_, instance);
        rtcReleaseGeometry(instance);
    }
    void commit() {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
    }
    TriangleId nearest(const Ray& ray) const {
        RTCRayQueryContext context;
        rtcInitRayQueryContext(&context);
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        RTCRayHit query{};
        query.ray = {float(ray.org.x),
                     float(ray.org.y),
                     float(ray.org.z),
                     0,
                     float(ray.dir.x),
                     float(ray.dir.y),
                     float(ray.dir.z),
                     0,
                     INFINITY,
                     ~0u,
                     0,
                     0};
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &query, &arguments);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return {};
        return {query.hit.instID[0], query.hit.primID};
    }

private:
    RTCDevice device_;
    RTCScene scene_;
    std::vector<RTCScene> meshes_;
};

} // namespace ovc::test
