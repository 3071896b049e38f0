// SPDX-License-Identifier: Apache-2.0
// Makes workloads of rays and frames. The buffers of rays are allocated once, so that no contender
// pays for them.
#include "host/bench/workload.h"

#include "host/render/render.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace ovc {

static constexpr double kInfinity = std::numeric_limits<double>::infinity();
static constexpr uint64_t kFnvStart = 0xcbf29ce484222325u;

static uint64_t fnv(uint64_t hash, uint64_t value) {
    for (int byte = 0; byte < 8; ++byte)
        hash = (hash ^ (value >> (8 * byte) & 0xff)) * 0x100000001b3u;
    return hash;
}

uint64_t checksum(std::span<const uint64_t> answers) {
    uint64_t hash = kFnvStart;
    for (const uint64_t answer : answers)
        hash = fnv(hash, answer);
    return hash;
}

static double relative_error(double t, double right) {
    if (t == right)
        return 0;
    return right == 0 ? 1 : std::abs(t - right) / std::abs(right);
}

DistanceError distance_error(std::span<const double> distances, std::span<const double> right) {
    assert(distances.size() == right.size());
    DistanceError error;
    uint64_t both = 0;
    double squares = 0;
    for (size_t i = 0; i < right.size(); ++i) {
        if (!std::isfinite(right[i]) || !std::isfinite(distances[i]))
            continue;
        const double one = relative_error(distances[i], right[i]);
        error.largest = std::max(error.largest, one);
        error.largest_ulps = std::max(error.largest_ulps, float_ulps(distances[i], right[i]));
        squares += one * one;
        ++both;
    }
    error.rms = both ? std::sqrt(squares / double(both)) : 0;
    return error;
}

Workload ray_workload(RaySet set) {
    const size_t count = set.rays.size();
    if (set.query == RayQuery::Nearest)
        return {std::move(set.name),
                NearestTask{std::move(set.rays), std::vector<Hit>(count), count}};
    return {std::move(set.name),
            OcclusionTask{std::move(set.rays), std::vector<uint8_t>(count), count}};
}

Workload in_small_calls(Workload workload) {
    workload.name += kSmall;
    if (auto* nearest = std::get_if<NearestTask>(&workload.task))
        nearest->call_rays = kSmallCallRays;
    else
        std::get<OcclusionTask>(workload.task).call_rays = kSmallCallRays;
    return workload;
}

static void round_rays(std::vector<Ray>& rays) {
    for (Ray& ray : rays)
        ray = {dvec3(vec3(ray.org)), double(float(ray.t_min)), dvec3(vec3(ray.dir)),
               double(float(ray.t_max))};
}

void round_rays(Workload& workload) {
    if (auto* nearest = std::get_if<NearestTask>(&workload.task))
        round_rays(nearest->rays);
    else if (auto* occlusion = std::get_if<OcclusionTask>(&workload.task))
        round_rays(occlusion->rays);
}

Workload frame_workload(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                        StopRequest stop) {
    return {"frame", FrameTask{&scene, camera, {width, height}, std::move(stop), {}}};
}

/// Calls ask(first, count) for the task's rays, some in each call.
template <class Task, class Ask>
static Result<uint64_t> in_calls(const Task& task, Ask&& ask) {
    for (size_t first = 0; first < task.rays.size(); first += task.call_rays) {
        const Result<Done> traced = ask(first, std::min(task.call_rays, task.rays.size() - first));
        if (!traced)
            return traced.error();
    }
    return task.rays.size();
}

static Result<uint64_t> run(NearestTask& task, Backend& backend) {
    return in_calls(task, [&](size_t first, size_t count) {
        return backend.intersect(std::span(task.rays).subspan(first, count), {},
                                 std::span(task.hits).subspan(first, count));
    });
}

static Result<uint64_t> run(OcclusionTask& task, Backend& backend) {
    return in_calls(task, [&](size_t first, size_t count) {
        return backend.occluded(std::span(task.rays).subspan(first, count), {},
                                std::span(task.occluded).subspan(first, count));
    });
}

static Result<uint64_t> run(FrameTask& task, Backend& backend) {
    Film film(task.size.width, task.size.height);
    const Result<RenderReport> report = render_picture(
        *task.scene, task.camera, backend, {}, [&](const RenderReport&) { return !task.stop(); },
        film);
    task.image = film.image();
    return report ? Result<uint64_t>(report->rays.total()) : report.error();
}

static uint64_t answer_of(const Hit& hit) {
    return uint64_t(hit.id.mesh) << 32 | hit.id.prim;
}

static uint64_t answer_of(uint8_t occluded) {
    return occluded;
}

static uint64_t answer_of(const vec4& pixel) {
    uint64_t hash = kFnvStart;
    for (int channel = 0; channel < 4; ++channel)
        hash = fnv(hash, std::bit_cast<uint32_t>(pixel[channel]));
    return hash;
}

static const std::vector<Hit>& last_answers(const NearestTask& task) {
    return task.hits;
}

static const std::vector<uint8_t>& last_answers(const OcclusionTask& task) {
    return task.occluded;
}

static const std::vector<vec4>& last_answers(const FrameTask& task) {
    return task.image.pixels;
}

static double distance_of(const Hit& hit) {
    return hit.is_hit() ? hit.t : kInfinity;
}

static double distance_of(uint8_t occluded) {
    return occluded ? 0 : kInfinity;
}

Result<uint64_t> Workload::run(Backend& backend) {
    return std::visit([&](auto& kind) { return ovc::run(kind, backend); }, task);
}

std::vector<uint64_t> Workload::answers() const {
    std::vector<uint64_t> numbers;
    std::visit(
        [&](const auto& kind) {
            for (const auto& answer : last_answers(kind))
                numbers.push_back(answer_of(answer));
        },
        task);
    return numbers;
}

std::vector<double> Workload::distances() const {
    std::vector<double> distances;
    std::visit(
        [&](const auto& kind) {
            if constexpr (!std::is_same_v<decltype(kind), const FrameTask&>)
                for (const auto& answer : last_answers(kind))
                    distances.push_back(distance_of(answer));
        },
        task);
    return distances;
}

static std::vector<TriangleId> triangles_of(std::span<const uint64_t> answers) {
    std::vector<TriangleId> ids;
    for (const uint64_t answer : answers)
        ids.push_back({uint32_t(answer >> 32), uint32_t(answer)});
    return ids;
}

Verdicts Workload::judged(const Soup& soup, std::span<const uint64_t> right,
                          std::span<const double> right_distances) const {
    if (const auto* nearest = std::get_if<NearestTask>(&task)) {
        const std::vector<double> own = distances();
        return judge(soup, nearest->rays, {triangles_of(answers()), own},
                     {triangles_of(right), right_distances});
    }
    if (const auto* occlusion = std::get_if<OcclusionTask>(&task))
        return judge(occlusion->occluded, std::vector<uint8_t>(right.begin(), right.end()));
    return {};
}

} // namespace ovc
