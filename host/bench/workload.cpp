// SPDX-License-Identifier: Apache-2.0
// Makes workloads of rays and frames. The buffers of rays are allocated once, so that no contender
// pays for them.
#include "host/bench/workload.h"

#include "host/render/render.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>

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
        if (!std::isfinite(right[i]))
            continue;
        if (!std::isfinite(distances[i])) {
            ++error.missed;
            continue;
        }
        const double one = relative_error(distances[i], right[i]);
        error.largest = std::max(error.largest, one);
        squares += one * one;
        ++both;
    }
    error.rms = both ? std::sqrt(squares / double(both)) : 0;
    return error;
}

static Workload nearest_workload(RaySet set) {
    auto rays = std::make_shared<const std::vector<Ray>>(std::move(set.rays));
    auto hits = std::make_shared<std::vector<Hit>>(rays->size());
    return {std::move(set.name),
            [rays, hits](Backend& backend) -> Result<uint64_t> {
                const Result<Done> traced = backend.intersect(*rays, {}, *hits);
                return traced ? Result<uint64_t>(rays->size()) : traced.error();
            },
            [hits] {
                std::vector<uint64_t> names;
                names.reserve(hits->size());
                for (const Hit& hit : *hits)
                    names.push_back(uint64_t(hit.id.mesh) << 32 | hit.id.prim);
                return names;
            },
            [hits] {
                std::vector<double> distances;
                distances.reserve(hits->size());
                for (const Hit& hit : *hits)
                    distances.push_back(hit.is_hit() ? hit.t : kInfinity);
                return distances;
            }};
}

static Workload occlusion_workload(RaySet set) {
    auto rays = std::make_shared<const std::vector<Ray>>(std::move(set.rays));
    auto occluded = std::make_shared<std::vector<uint8_t>>(rays->size());
    return {std::move(set.name),
            [rays, occluded](Backend& backend) -> Result<uint64_t> {
                const Result<Done> traced = backend.occluded(*rays, {}, *occluded);
                return traced ? Result<uint64_t>(rays->size()) : traced.error();
            },
            [occluded] { return std::vector<uint64_t>(occluded->begin(), occluded->end()); },
            [occluded] {
                std::vector<double> distances;
                distances.reserve(occluded->size());
                for (const uint8_t hit : *occluded)
                    distances.push_back(hit ? 0 : kInfinity);
                return distances;
            }};
}

Workload ray_workload(RaySet set) {
    return set.query == RayQuery::Nearest ? nearest_workload(std::move(set))
                                          : occlusion_workload(std::move(set));
}

static uint64_t answer_of(const vec4& pixel) {
    uint64_t hash = kFnvStart;
    for (int channel = 0; channel < 4; ++channel)
        hash = fnv(hash, std::bit_cast<uint32_t>(pixel[channel]));
    return hash;
}

Workload frame_workload(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                        StopRequest stop) {
    auto image = std::make_shared<Image>();
    return {"frame",
            [&scene, camera, image, width, height, stop](Backend& backend) -> Result<uint64_t> {
                Film film(width, height);
                const Result<RenderReport> report = render_picture(
                    scene, camera, backend, {}, [&](const RenderReport&) { return !stop(); }, film);
                *image = film.image();
                return report ? Result<uint64_t>(report->rays.total()) : report.error();
            },
            [image] {
                std::vector<uint64_t> answers;
                answers.reserve(image->pixels.size());
                for (const vec4& pixel : image->pixels)
                    answers.push_back(answer_of(pixel));
                return answers;
            },
            {}};
}

} // namespace ovc
