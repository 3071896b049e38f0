// SPDX-License-Identifier: Apache-2.0
// Embree as a peer. The only file of the host that sees Embree.
#include "host/report/embree_peer.h"

#include "core/parallel.h"

#include <embree3/rtcore.h>

namespace ovc {

namespace {

/// What the filter needs to know of a ray.
struct Context {
    RTCIntersectContext base; // first: Embree hands its address to the filter
    TriangleId skip;
};

void refuse_skipped(const RTCFilterFunctionNArguments* a) {
    const TriangleId skip = reinterpret_cast<const Context*>(a->context)->skip;
    if (RTCHitN_geomID(a->hit, a->N, 0) == skip.mesh &&
        RTCHitN_primID(a->hit, a->N, 0) == skip.prim)
        a->valid[0] = 0;
}

/// False for what Embree asserts that nobody asks: NaN, an empty range, numbers beyond its
/// FLT_LARGE.
bool can_ask(const Ray& ray) {
    constexpr double large = 1.844e18;
    const auto within = [](const dvec3& v) {
        return max_component(glm::abs(v)) <= large && is_finite(v);
    };
    return ray.valid() && within(ray.org) && within(ray.dir);
}

RTCRayHit query_of(const Ray& ray) {
    RTCRayHit query{};
    query.ray.org_x = float(ray.org.x);
    query.ray.org_y = float(ray.org.y);
    query.ray.org_z = float(ray.org.z);
    query.ray.tnear = float(ray.t_min);
    query.ray.dir_x = float(ray.dir.x);
    query.ray.dir_y = float(ray.dir.y);
    query.ray.dir_z = float(ray.dir.z);
    query.ray.tfar = float(ray.t_max);
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

class RobustEmbree final : public EmbreePeer {
public:
    explicit RobustEmbree(const Soup& soup)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
        for (const Chunk& chunk : soup.chunks)
            add(chunk);
        rtcCommitScene(scene_);
    }
    ~RobustEmbree() override {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    RobustEmbree(const RobustEmbree&) = delete;
    RobustEmbree& operator=(const RobustEmbree&) = delete;

    void intersect(std::span<const Ray> rays, std::span<const TriangleId> skip,
                   std::span<Hit> hits) const override {
        parallel_for(rays.size(), 256, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                hits[i] = nearest(rays[i], skip.empty() ? TriangleId{} : skip[i]);
        });
    }

private:
    void add(const Chunk& chunk) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t corners = chunk.corners().size();
        auto* positions = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), corners));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), corners / 3));
        for (uint32_t i = 0; i < corners; ++i) {
            positions[i] = vec3(chunk.origin() + dvec3(chunk.corners()[i]));
            indices[i] = i;
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
    }

    Hit nearest(const Ray& ray, TriangleId skip) const {
        if (!can_ask(ray))
            return {};
        Context context;
        rtcInitIntersectContext(&context.base);
        context.skip = skip;
        if (skip.mesh != kNone)
            context.base.filter = refuse_skipped;
        RTCRayHit query = query_of(ray);
        rtcIntersect1(scene_, &context.base, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return {};
        return {query.ray.tfar, 0, 0, {query.hit.geomID, query.hit.primID}};
    }

    RTCDevice device_;
    RTCScene scene_;
};

} // namespace

std::unique_ptr<EmbreePeer> make_embree_peer(const Soup& soup) {
    return std::make_unique<RobustEmbree>(soup);
}

} // namespace ovc
