// SPDX-License-Identifier: Apache-2.0
// The reference where doubles leave a doubt: it computes the same determinants exactly.
#include "core/exact/triangle.h"

#include "core/exact/coplanar.h"
#include "core/exact/refined.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

/// Returns which corners of `b` lie where the corners of `a` do that `support` names; 0 where not
/// all of those have one. A ray that meets `a` there then meets `b` in the same point, unless it
/// runs along b's plane.
uint32_t shared_support(const Triangle& a, uint32_t support, const Triangle& b) {
    uint32_t shared = 0;
    for (int i = 0; i < 3; ++i) {
        if (!(support >> i & 1))
            continue;
        const int k = a[i] == b[0] ? 0 : a[i] == b[1] ? 1 : a[i] == b[2] ? 2 : 3;
        if (k == 3)
            return 0;
        shared |= 1u << k;
    }
    return shared;
}

int sign_of(TriangleId a, TriangleId b) {
    return a < b ? -1 : b < a ? 1 : 0;
}

/// Returns whether the line crosses the triangle's plane for sure.
bool surely_crosses(const PreparedRay& p, const Triangle& triangle) {
    const dvec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
    const dvec3 d = p.ray.dir;
    const dvec3 left = dvec3(ab.y * ac.z, ab.z * ac.x, ab.x * ac.y);
    const dvec3 right = dvec3(ab.z * ac.y, ab.x * ac.z, ab.y * ac.x);
    const double det = glm::dot(left - right, d);
    const double magnitude = glm::dot(glm::abs(left) + glm::abs(right), glm::abs(d));
    // The bound covers eight roundings in a row, and underflow.
    const double error = 0x1p-49 * magnitude + 1e-300 * (1 + max_component(glm::abs(d)));
    return std::abs(det) > error && std::isfinite(magnitude);
}

} // namespace

std::optional<Candidate> exact_candidate(const PreparedRay& p, const Triangle& triangle,
                                         TriangleId id) {
    if (!is_finite(triangle[0]) || !is_finite(triangle[1]) || !is_finite(triangle[2]))
        return std::nullopt;
    if (const RefinedAnswer refined = refined_candidate(p, triangle, id); refined.known)
        return refined.candidate;
    const ExactSolution exact(p.ray, triangle);
    if (!exact.inside() || exact.compare_t(p.ray.t_min) < 0 || exact.compare_t(p.ray.t_max) > 0)
        return std::nullopt;
    const double t = exact.t();
    return Candidate{
        {t, exact.u(), exact.v(), id}, 0, 0x1p-53 * std::abs(t) + 0x1p-1074, exact.support()};
}

bool Nearest::offer_neighbour(const Triangle& triangle, TriangleId id) {
    assert(is_hit() && best_.found.support != Candidate::kAllCorners);
    const uint32_t shared = shared_support(best_.triangle, best_.found.support, triangle);
    if (shared == 0)
        return false;
    if (best_.found.hit.id < id)
        return true; // it is hit in the same point or, seen edge-on, not at all
    if (!surely_crosses(p_, triangle))
        return false;
    Candidate same = best_.found; // except u and v, which hit() computes anew
    same.hit.id = id;
    same.support = shared;
    if (!counts(same, triangle))
        return false;
    best_ = {same, triangle};
    return true;
}

std::optional<Candidate> Nearest::in_doubt(const Triangle& triangle, TriangleId id) {
    if (!decided_)
        decided_.emplace();
    if (decided_->has(id))
        return std::nullopt;
    decided_->add(id);
    return exact_candidate(p_, triangle, id);
}

/// Tells the order of two hits whose t doubles leave open.
int ComparedHit::order_closely(const PreparedRay& p, Candidate& other, const Triangle& of_other) {
    const int by_id = sign_of(other.hit.id, found.hit.id);
    if (shared_support(triangle, found.support, of_other) != 0 ||
        surely_coplanar(triangle, of_other))
        return by_id;
    const auto refine = [&](Candidate& candidate, const Triangle& of) {
        if (candidate.refined)
            return;
        if (const RefinedAnswer better = refined_candidate(p, of, candidate.hit.id);
            better.candidate)
            candidate = *better.candidate;
    };
    refine(found, triangle);
    refine(other, of_other);
    int by_t = other.compare_t(found);
    if (by_t == 0) {
        if (!exactly)
            exactly.emplace(p.ray, triangle);
        by_t = ExactSolution(p.ray, of_other).compare_t(*exactly);
    }
    return by_t != 0 ? by_t : by_id;
}

std::optional<Candidate> hit_at(const Ray& ray, const Triangle& triangle, const HitPlace& place) {
    const PreparedRay p(PreparedRay::behind(ray, place));
    const std::optional<Candidate> found = candidate(p, triangle, place.id);
    const bool is_there =
        found &&
        (place.is_certain || rounded_hit(p, triangle, place.id, found->support).t == place.t);
    return is_there ? found : std::nullopt;
}

Behind::Behind(const PreparedRay& p, const Triangle* triangle) : p_(p) {
    if (!triangle)
        return;
    if (const std::optional<Candidate> found = hit_at(p.ray, *triangle, p.after))
        place_.emplace(*found, *triangle);
}

bool Behind::has(Candidate& found, const Triangle& triangle) {
    const HitPlace& after = p_.after;
    if (!std::isfinite(after.t) || (place_ && found.hit.id == after.id))
        return false;
    if (place_)
        return place_->order(p_, found, triangle) > 0;
    const int by_t = found.compare_t(Candidate{{after.t, 0, 0, after.id}});
    const int exactly = by_t != 0 ? by_t : ExactSolution(p_.ray, triangle).compare_t(after.t);
    return exactly != 0 ? exactly > 0 : found.hit.id > after.id;
}

Hit Nearest::hit() const {
    const Candidate& best = best_.found;
    return is_hit() ? rounded_hit(p_, best_.triangle, best.hit.id, best.support) : Hit{};
}

std::optional<Hit> intersect(const PreparedRay& p, const Triangle& triangle, TriangleId id) {
    const std::optional<Candidate> found = candidate(p, triangle, id);
    if (!found)
        return std::nullopt;
    return rounded_hit(p, triangle, id, found->support);
}

} // namespace ovc
