// SPDX-License-Identifier: Apache-2.0
// Compares refraction and mirrors with formulas.
#include "host/suites/optics/optics_exact.h"

#include "host/shade/refract.h"
#include "host/shade/shade.h"
#include "testscenes/corners.h"
#include "testscenes/random.h"

#include <algorithm>
#include <numbers>

namespace ovc {

namespace {

using Wide = long double;
using WideVec = glm::vec<3, long double>;

constexpr double kUlp = 0x1p-53;
constexpr uint64_t kRays = 20'000; // in the short form
constexpr uint32_t kBounces = 200;

/// The textbook's formula.
struct Textbook {
    Wide square; // of the cosine behind the plane; below 0: total reflection
    WideVec dir; // set where square is above 0

    Textbook(const dvec3& incoming, const dvec3& plane_normal, double from, double to) {
        const WideVec d = glm::normalize(WideVec(incoming));
        const WideVec n = glm::normalize(WideVec(plane_normal));
        const Wide eta = Wide(from) / Wide(to), cosine = -glm::dot(d, n);
        square = 1 - eta * eta * (1 - cosine * cosine);
        if (square > 0)
            dir = eta * d + (eta * cosine - std::sqrt(square)) * n;
    }
};

/// Returns the largest error that roundings of the direction and of a few operations explain. Near
/// the critical angle a small turn of the incoming light is a large turn of the outgoing light.
double tolerance(double eta, double cosine_in, double cosine_out) {
    return 8 * kUlp * (1 + eta + eta * eta * cosine_in / cosine_out);
}

} // namespace

OpticsScore snell(const OpticsOptions& options, double ior) {
    OpticsScore score;
    Random random(/* seed= */ 1621);
    for (uint64_t i = 0; i < kRays * options.times; ++i) {
        const dvec3 normal = random.direction();
        dvec3 dir = random.direction();
        if (glm::dot(dir, normal) > 0)
            dir = -dir;
        const bool entering = random.chance(0.5);
        const double from = entering ? 1 : ior, to = entering ? ior : 1;
        const Textbook exact(dir, normal, from, to);
        const std::optional<dvec3> found = refracted(dir, normal, from, to);
        ++score.rays;
        if (exact.square < 1e-6) {
            score.wrong += exact.square < -1e-12 && found;
            continue;
        }
        const double off = found ? double(glm::length(WideVec(*found) - exact.dir)) : 1;
        score.wrong +=
            !(off <= tolerance(from / to, -glm::dot(dir, normal), double(std::sqrt(exact.square))));
        score.error = std::max(score.error, off);
    }
    return score;
}

OpticsScore critical_angle(const OpticsOptions& options, double ior) {
    OpticsScore score;
    Random random(/* seed= */ 1841);
    const double from = std::max(ior, 1.0), to = std::min(ior, 1.0);
    const Wide critical = std::asin(Wide(to) / Wide(from));
    for (uint64_t i = 0; i < kRays * options.times; ++i) {
        const Wide beside = std::pow(10.0, random.uniform(-15, -6)) * (random.chance(0.5) ? 1 : -1);
        const dvec3 normal = random.direction(), along = any_perpendicular(normal);
        const Wide angle = critical + beside;
        const dvec3 dir(std::sin(angle) * WideVec(along) - std::cos(angle) * WideVec(normal));
        const Textbook exact(dir, normal, from, to);
        const std::optional<dvec3> found = refracted(dir, normal, from, to);
        const double bent = from / to * glm::dot(dir, normal);
        const bool certain = std::abs(exact.square) > 16 * kUlp * (1 + bent * bent);
        ++score.rays;
        score.wrong +=
            (certain && found.has_value() != (exact.square > 0)) || (found && !is_finite(*found));
    }
    return score;
}

Result<OpticsScore> facing_mirrors(const OpticsOptions& options, const LogSink& log) {
    Scene scene;
    scene.materials = {{"mirror", vec3(0), 1}};
    Corners floor, ceiling;
    add_quad(floor, {-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0});
    add_quad(ceiling, {-4, -4, 1}, {-4, 4, 1}, {4, 4, 1}, {4, -4, 1});
    scene.add_mesh("floor", 0, Chunk::owning(dvec3(0), std::move(floor)));
    scene.add_mesh("ceiling", 0, Chunk::owning(dvec3(0), std::move(ceiling)));
    const Result<std::unique_ptr<Backend>> backend = make_backend(scene.soup, options.backend, log);
    if (!backend)
        return backend.error();

    Random random(/* seed= */ 200);
    const size_t count = 100 * options.times;
    std::vector<Ray> rays(count), first;
    std::vector<TriangleId> skip(count);
    std::vector<Hit> hits(count);
    for (Ray& ray : rays) {
        ray.org = {random.uniform(-1, 1), random.uniform(-1, 1), 0.5};
        ray.dir = {random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 1};
    }
    first = rays;
    OpticsScore score;
    std::vector<uint32_t> bounces(count);
    for (uint32_t bounce = 0; bounce < kBounces; ++bounce) {
        if (const Result<Done> done = (*backend)->intersect(rays, skip, hits); !done)
            return done.error();
        score.rays += count;
        for (size_t i = 0; i < count; ++i) {
            if (!hits[i].is_hit() || bounces[i] < bounce)
                continue;
            ++bounces[i];
            rays[i] = mirror_ray(rays[i], surface_point(scene, rays[i], hits[i]));
            skip[i] = hits[i].id;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        score.wrong += bounces[i] != kBounces;
        // The ray crosses half the gap to the ceiling, then the whole gap 199 times, at last to
        // the floor.
        const dvec3 way = (kBounces - 0.5) * first[i].dir;
        const dvec3 end(first[i].org.x + way.x, first[i].org.y + way.y, 0);
        score.error = std::max(score.error, glm::length(rays[i].org - end) / glm::length(way));
    }
    return score;
}

} // namespace ovc
