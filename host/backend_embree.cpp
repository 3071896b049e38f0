// SPDX-License-Identifier: Apache-2.0
// Embree 3 as a backend: a peer to compare with. The only file of the host that sees Embree.
#include "host/backend.h"

#include "core/parallel.h"
#include "core/stopwatch.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cassert>

namespace ovc {

namespace {

/// What the filter needs to know of a ray.
struct Context {
    RTCIntersectContext base; // first: Embree hands its address to the filter
    TriangleId skip;

    explicit Context(TriangleId skipped);
};

void refuse_skipped(const RTCFilterFunctionNArguments* a) {
    const TriangleId skip = reinterpret_cast<const Context*>(a->context)->skip;
    if (RTCHitN_geomID(a->hit, a->N, 0) == skip.mesh &&
        RTCHitN_primID(a->hit, a->N, 0) == skip.prim)
        a->valid[0] = 0;
}

Context::Context(TriangleId skipped) : skip(skipped) {
    rtcInitIntersectContext(&base);
    if (skip.mesh != kNone)
        base.filter = refuse_skipped;
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

RTCRay rounded(const Ray& ray) {
    RTCRay r{};
    r.org_x = float(ray.org.x);
    r.org_y = float(ray.org.y);
    r.org_z = float(ray.org.z);
    r.tnear = float(ray.t_min);
    r.dir_x = float(ray.dir.x);
    r.dir_y = float(ray.dir.y);
    r.dir_z = float(ray.dir.z);
    r.tfar = float(ray.t_max);
    r.mask = ~0u;
    return r;
}

class EmbreeBackend final : public Backend {
public:
    EmbreeBackend(const Soup& soup, EmbreeMode mode)
        : mode_(mode), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        const Stopwatch watch;
        rtcSetSceneFlags(scene_, RTCSceneFlags((mode == EmbreeMode::Robust ? RTC_SCENE_FLAG_ROBUST
                                                                           : RTC_SCENE_FLAG_NONE) |
                                               RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
        for (const Chunk& chunk : soup.chunks)
            add(chunk);
        rtcCommitScene(scene_);
        statistics_.struct_size = sizeof(statistics_);
        statistics_.triangles = soup.triangle_count();
        statistics_.seconds_level2 = watch.seconds();
    }
    ~EmbreeBackend() override {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeBackend(const EmbreeBackend&) = delete;
    EmbreeBackend& operator=(const EmbreeBackend&) = delete;

    /// What went wrong while it was built.
    Result<Done> built() const {
        const RTCError code = rtcGetDeviceError(device_);
        if (code == RTC_ERROR_NONE)
            return Done{};
        return Error{fmt::format("Embree cannot build the scene: its error {}{}", int(code),
                                 code == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : "")};
    }

    Result<Done> intersect(std::span<const Ray> rays, std::span<const TriangleId> skip,
                           std::span<Hit> hits) override {
        assert(hits.size() == rays.size());
        for_each(rays, skip, [&](size_t i, TriangleId s) { hits[i] = nearest(rays[i], s); });
        statistics_.nearest_rays += rays.size();
        return Done{};
    }

    Result<Done> occluded(std::span<const Ray> rays, std::span<const TriangleId> skip,
                          std::span<uint8_t> occluded) override {
        assert(occluded.size() == rays.size());
        for_each(rays, skip, [&](size_t i, TriangleId s) { occluded[i] = any(rays[i], s); });
        statistics_.occlusion_rays += rays.size();
        return Done{};
    }

    ovc_statistics statistics() const override { return statistics_; }
    std::string renderer() const override {
        return fmt::format("Embree {}{} on the CPU, float32", RTC_VERSION_STRING,
                           mode_ == EmbreeMode::Robust ? " robust" : "");
    }

private:
    void add(const Chunk& chunk) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t corners = chunk.corners().size();
        auto* positions = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), corners));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), corners / 3));
        for (size_t i = 0; positions && indices && i < corners; ++i) {
            positions[i] = vec3(chunk.origin() + dvec3(chunk.corners()[i]));
            indices[i] = uint32_t(i);
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
    }

    template <class Answer>
    void for_each(std::span<const Ray> rays, std::span<const TriangleId> skip,
                  const Answer& answer) {
        assert(skip.empty() || skip.size() == rays.size());
        const Stopwatch watch;
        parallel_for(rays.size(), 256, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                answer(i, skip.empty() ? TriangleId{} : skip[i]);
        });
        statistics_.seconds_trace += watch.seconds();
    }

    Hit nearest(const Ray& ray, TriangleId skip) const {
        if (!can_ask(ray))
            return {};
        Context context(skip);
        RTCRayHit query{rounded(ray), {}};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context.base, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return {};
        return {query.ray.tfar, query.hit.u, query.hit.v, {query.hit.geomID, query.hit.primID}};
    }

    bool any(const Ray& ray, TriangleId skip) const {
        if (!can_ask(ray))
            return false;
        Context context(skip);
        RTCRay query = rounded(ray);
        rtcOccluded1(scene_, &context.base, &query);
        return query.tfar < 0;
    }

    EmbreeMode mode_;
    RTCDevice device_;
    RTCScene scene_;
    ovc_statistics statistics_{};
};

} // namespace

Result<std::unique_ptr<Backend>> make_embree_backend(const Soup& soup, EmbreeMode mode) {
    for (const Chunk& chunk : soup.chunks)
        if (chunk.corners().size() > 0xffffffffu)
            return Error{"Embree takes meshes of at most 1,431,655,765 triangles"};
    auto backend = std::make_unique<EmbreeBackend>(soup, mode);
    if (const Result<Done> built = backend->built(); !built)
        return built.error();
    return Result<std::unique_ptr<Backend>>(std::move(backend));
}

} // namespace ovc
