// SPDX-License-Identifier: Apache-2.0
// Embree as a backend: a peer to compare with.
#include "host/backend/backend.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/backend/embree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>

namespace ovc {

namespace {

/// The context of a call, with what its rays do not see.
struct Context {
    RTCRayQueryContext base;   // first, because Embree hands its address to the filter
    const Exclusions* without; // of the rays of the task; null where they see everything
    const double* begins;      // t of the rays of the task where Embree's is 0
    size_t first;              // the ray among them whose id is 0
    const Soup* soup;

    Context(const Exclusions* excluded, const double* begins_, size_t first_ray, const Soup& of);

    RTCIntersectArguments nearest(RTCRayQueryFlags flags) {
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        return filled(arguments, flags);
    }
    RTCOccludedArguments any(RTCRayQueryFlags flags) {
        RTCOccludedArguments arguments;
        rtcInitOccludedArguments(&arguments);
        return filled(arguments, flags);
    }

    bool counts(size_t ray, const Hit& hit) const {
        if (!without->skip.empty() && without->skip[ray] == hit.id)
            return false;
        const RaySieve sieve = without->sieves[ray];
        if (!sees(sieve.mask, soup->chunks[hit.id.mesh].mask()))
            return false;
        uint8_t keep = 1;
        return !sieve.filter ||
               (sieve.filter->keep({&sieve.name, 1}, {&hit, 1}, {&keep, 1}) && keep);
    }

private:
    template <class Arguments>
    Arguments filled(Arguments arguments, RTCRayQueryFlags flags);
};

void refuse_excluded(const RTCFilterFunctionNArguments* a) {
    const Context& context = *reinterpret_cast<const Context*>(a->context);
    for (unsigned i = 0; i < a->N; ++i) {
        const size_t ray = context.first + RTCRayN_id(a->ray, a->N, i);
        const Hit hit{context.begins[ray] + RTCRayN_tfar(a->ray, a->N, i),
                      RTCHitN_u(a->hit, a->N, i),
                      RTCHitN_v(a->hit, a->N, i),
                      {RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i)}};
        if (a->valid[i] && !context.counts(ray, hit))
            a->valid[i] = 0;
    }
}

Context::Context(const Exclusions* excluded, const double* begins_, size_t first_ray,
                 const Soup& of)
    : without(excluded), begins(begins_), first(first_ray), soup(&of) {
    rtcInitRayQueryContext(&base);
}

template <class Arguments>
Arguments Context::filled(Arguments arguments, RTCRayQueryFlags flags) {
    arguments.context = &base;
    arguments.flags = flags;
    if (without) {
        arguments.flags = RTCRayQueryFlags(flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
        arguments.filter = refuse_excluded;
    }
    return arguments;
}

/// Whether Embree takes such numbers: none beyond its FLT_LARGE, and no NaN.
bool can_take(const dvec3& v) {
    constexpr double kLarge = 1.844e18;
    return max_component(glm::abs(v)) <= kLarge && is_finite(v);
}

/// Returns false for rays that fail Embree's assertions, as those with an empty range do.
bool can_ask(const Ray& ray) {
    return ray.valid() && can_take(ray.org) && can_take(ray.dir);
}

/// The functions of Embree that trace N rays in one call.
template <unsigned N>
struct Calls;

template <>
struct Calls<1> {
    using Query = RTCRayHit;
    static void nearest(RTCScene scene, Context& context, const int* valid, Query& query) {
        RTCIntersectArguments arguments = context.nearest(RTC_RAY_QUERY_FLAG_INCOHERENT);
        if (*valid)
            rtcIntersect1(scene, &query, &arguments);
    }
    static void any(RTCScene scene, Context& context, const int* valid, Query& query) {
        RTCOccludedArguments arguments = context.any(RTC_RAY_QUERY_FLAG_INCOHERENT);
        if (*valid)
            rtcOccluded1(scene, &query.ray, &arguments);
    }
};

template <>
struct Calls<16> {
    using Query = RTCRayHit16;
    static void nearest(RTCScene scene, Context& context, const int* valid, Query& query) {
        RTCIntersectArguments arguments = context.nearest(RTC_RAY_QUERY_FLAG_COHERENT);
        rtcIntersect16(valid, scene, &query, &arguments);
    }
    static void any(RTCScene scene, Context& context, const int* valid, Query& query) {
        RTCOccludedArguments arguments = context.any(RTC_RAY_QUERY_FLAG_COHERENT);
        rtcOccluded16(valid, scene, &query.ray, &arguments);
    }
};

/// The rays of a task, rounded to floats, which Embree takes N at a time.
template <unsigned N>
class Block {
public:
    static constexpr size_t kRays = 256;

    explicit Block(const Soup& soup) : soup_(soup) {}

    /// without: must stay until the rays are traced.
    void load(std::span<const Ray> rays, const Exclusions& without) {
        assert(rays.size() <= kRays);
        count_ = rays.size();
        without_ = &without;
        sees_all_ = without.skip.empty() && without.sieves.pass_all();
        valid_.fill(0);
        for (size_t i = 0; i < count_; ++i)
            put(i, rays[i]);
    }

    void find_nearest(RTCScene scene) { call(scene, Calls<N>::nearest); }
    void find_any(RTCScene scene) { call(scene, Calls<N>::any); }

    Hit nearest(size_t i) {
        RTCHitN* hit = RTCRayHitN_HitN(at(i), N);
        const unsigned lane = i % N;
        if (!valid_[i] || RTCHitN_geomID(hit, N, lane) == RTC_INVALID_GEOMETRY_ID)
            return {};
        return {begins_[i] + RTCRayN_tfar(ray(i), N, lane),
                RTCHitN_u(hit, N, lane),
                RTCHitN_v(hit, N, lane),
                {RTCHitN_geomID(hit, N, lane), RTCHitN_primID(hit, N, lane)}};
    }
    bool any(size_t i) { return valid_[i] && RTCRayN_tfar(ray(i), N, i % N) < 0; }

private:
    RTCRayHitN* at(size_t i) { return reinterpret_cast<RTCRayHitN*>(&queries_[i / N]); }
    RTCRayN* ray(size_t i) { return RTCRayHitN_RayN(at(i), N); }

    /// Embree has no t below 0; a ray that begins there is moved on its line.
    void put(size_t i, Ray from) {
        begins_[i] = std::min(from.t_min, 0.0);
        if (from.t_min < 0)
            from = {from.at(from.t_min), 0, from.dir, from.t_max - from.t_min};
        valid_[i] = can_ask(from) ? -1 : 0;
        RTCRayN* to = ray(i);
        const unsigned lane = i % N;
        RTCRayN_org_x(to, N, lane) = float(from.org.x);
        RTCRayN_org_y(to, N, lane) = float(from.org.y);
        RTCRayN_org_z(to, N, lane) = float(from.org.z);
        RTCRayN_tnear(to, N, lane) = float(from.t_min);
        RTCRayN_dir_x(to, N, lane) = float(from.dir.x);
        RTCRayN_dir_y(to, N, lane) = float(from.dir.y);
        RTCRayN_dir_z(to, N, lane) = float(from.dir.z);
        RTCRayN_tfar(to, N, lane) = float(from.t_max);
        RTCRayN_time(to, N, lane) = 0;
        RTCRayN_mask(to, N, lane) = ~0u;
        RTCRayN_id(to, N, lane) = lane;
        RTCRayN_flags(to, N, lane) = 0;
        RTCHitN_geomID(RTCRayHitN_HitN(at(i), N), N, lane) = RTC_INVALID_GEOMETRY_ID;
    }

    template <class Call>
    void call(RTCScene scene, const Call& ask) {
        for (size_t i = 0; i < count_; i += N) {
            Context context(sees_all_ ? nullptr : without_, begins_.data(), i, soup_);
            ask(scene, context, &valid_[i], queries_[i / N]);
        }
    }

    std::array<typename Calls<N>::Query, kRays / N> queries_;
    alignas(64) std::array<int, kRays> valid_;
    std::array<double, kRays> begins_;
    const Soup& soup_;
    const Exclusions* without_ = nullptr;
    bool sees_all_ = true;
    size_t count_ = 0;
};

const char* words_of(EmbreeMode mode) {
    switch (mode) {
    case EmbreeMode::Medium:
        return ", medium quality";
    case EmbreeMode::High:
        return ", high quality";
    case EmbreeMode::Robust:
        return " robust";
    case EmbreeMode::Packets:
        break;
    }
    return ", high quality, 16 rays a call";
}

class EmbreeBackend final : public Backend {
public:
    EmbreeBackend(const Soup& soup, EmbreeMode mode)
        : soup_(soup), mode_(mode), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        const Stopwatch watch;
        rtcSetSceneBuildQuality(scene_, mode == EmbreeMode::Medium ? RTC_BUILD_QUALITY_MEDIUM
                                                                   : RTC_BUILD_QUALITY_HIGH);
        rtcSetSceneFlags(scene_, RTCSceneFlags((mode == EmbreeMode::Robust ? RTC_SCENE_FLAG_ROBUST
                                                                           : RTC_SCENE_FLAG_NONE) |
                                               RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS));
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

    /// Returns the error that Embree met while it built, if any.
    Result<Done> built() const {
        const RTCError code = rtcGetDeviceError(device_);
        if (code == RTC_ERROR_NONE)
            return Done{};
        return Error{fmt::format("Embree cannot build the scene: its error {}{}", int(code),
                                 code == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : "")};
    }

    /// Returns how many triangles Embree leaves out.
    uint64_t left_out() const { return left_out_; }

    Result<Done> intersect(std::span<const Ray> rays, const Exclusions& without,
                           std::span<Hit> hits) override {
        assert(hits.size() == rays.size());
        const auto find = [&](auto& block) { block.find_nearest(scene_); };
        for_each(rays, without, find,
                 [&](auto& block, size_t i, size_t at) { hits[i] = block.nearest(at); });
        statistics_.nearest_rays += rays.size();
        return Done{};
    }

    Result<Done> occluded(std::span<const Ray> rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override {
        assert(occluded.size() == rays.size());
        const auto find = [&](auto& block) { block.find_any(scene_); };
        for_each(rays, without, find,
                 [&](auto& block, size_t i, size_t at) { occluded[i] = block.any(at); });
        statistics_.occlusion_rays += rays.size();
        return Done{};
    }

    ovc_statistics statistics() const override { return statistics_; }
    std::string renderer() const override {
        return fmt::format("Embree {}{} on the CPU, float32", RTC_VERSION_STRING, words_of(mode_));
    }

private:
    void add(const Chunk& chunk) {
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t corners = 3 * size_t(chunk.size());
        auto* positions = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), corners));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), corners / 3));
        for (uint32_t t = 0; positions && indices && t < chunk.size(); ++t) {
            const Triangle triangle = chunk.triangle(t);
            for (size_t i = 0; i < 3; ++i) {
                positions[3 * size_t(t) + i] = vec3(triangle[i]);
                indices[3 * size_t(t) + i] = 3 * t + uint32_t(i);
            }
            left_out_ += !std::ranges::all_of(triangle, can_take);
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
    }

    /// Calls find(block), which asks Embree, for all rays in blocks, then tell(block, i, at) for
    /// each ray i, whose answer is in the block's place `at`.
    template <class Find, class Tell>
    void for_each(std::span<const Ray> rays, const Exclusions& without, const Find& find,
                  const Tell& tell) {
        assert(without.are_for(rays.size()) && without.after.empty());
        const Stopwatch watch;
        if (mode_ == EmbreeMode::Packets)
            for_each_block<16>(rays, without, find, tell);
        else
            for_each_block<1>(rays, without, find, tell);
        statistics_.seconds_trace += watch.seconds();
    }

    template <unsigned N, class Find, class Tell>
    void for_each_block(std::span<const Ray> rays, const Exclusions& without, const Find& find,
                        const Tell& tell) {
        constexpr size_t kRays = Block<N>::kRays;
        const Stopwatch call;
        std::atomic<double> inside = 0, all = 0; // seconds of all threads together
        parallel_for((rays.size() + kRays - 1) / kRays, 1, [&](size_t first, size_t last) {
            const Stopwatch task;
            Block<N> block(soup_);
            for (size_t b = first; b < last; ++b) {
                const size_t from = b * kRays;
                const size_t count = std::min(kRays, rays.size() - from);
                const Exclusions part = without.subspan(from, count);
                block.load(rays.subspan(from, count), part);
                const Stopwatch watch;
                find(block);
                inside += watch.seconds();
                for (size_t i = 0; i < count; ++i)
                    tell(block, from + i, i);
            }
            all += task.seconds();
        });
        // The kernel's share of the call does not depend on how many threads were free.
        if (all > 0)
            statistics_.seconds_kernel += call.seconds() * inside / all;
    }

    const Soup& soup_;
    EmbreeMode mode_;
    RTCDevice device_;
    RTCScene scene_;
    uint64_t left_out_ = 0;
    ovc_statistics statistics_{};
};

} // namespace

Result<std::unique_ptr<Backend>> make_embree_backend(const Soup& soup, EmbreeMode mode,
                                                     const LogSink& log) {
    for (const Chunk& chunk : soup.chunks)
        if (chunk.size() > 0xffffffffu / 3)
            return Error{"Embree takes meshes of at most 1,431,655,765 triangles"};
    auto backend = std::make_unique<EmbreeBackend>(soup, mode);
    if (const Result<Done> built = backend->built(); !built)
        return built.error();
    if (backend->left_out() > 0)
        say(log, LogLevel::Warning,
            fmt::format("Embree leaves out {} triangles with a corner that is not finite or lies "
                        "beyond 1.8e18",
                        backend->left_out()));
    return Result<std::unique_ptr<Backend>>(std::move(backend));
}

} // namespace ovc
