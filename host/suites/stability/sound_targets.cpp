// SPDX-License-Identifier: Apache-2.0
// Finds adjacency by sorting, and aims rays at sound edges and vertices.
#include "host/suites/stability/sound_targets.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

namespace ovc {

namespace {

bool before(const dvec3& a, const dvec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

/// One side of a triangle, with its ends in order.
struct HalfEdge {
    uint32_t low, high;
    bool forward; // the triangle goes from low to high
    uint32_t triangle;

    bool operator<(const HalfEdge& other) const {
        return std::pair(low, high) < std::pair(other.low, other.high);
    }
};

} // namespace

SoundTargets::SoundTargets(const Soup& soup) {
    number_corners(soup);
    find_edges();
    find_vertices();
}

void SoundTargets::number_corners(const Soup& soup) {
    assert(!soup.chunks.empty());
    const Chunk& chunk = soup.chunks[0];
    const auto position = [&](uint32_t corner) {
        return chunk.origin() + dvec3(chunk.corners()[corner]);
    };
    std::vector<uint32_t> order(chunk.corners().size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order,
                      [&](uint32_t a, uint32_t b) { return before(position(a), position(b)); });
    corners_.resize(order.size());
    Box bounds;
    for (const uint32_t corner : order) {
        const dvec3 p = position(corner);
        if (positions_.empty() || positions_.back() != p)
            positions_.push_back(p);
        corners_[corner] = uint32_t(positions_.size() - 1);
        bounds.add(p);
    }
    size_ = max_component(bounds.extent());
}

void SoundTargets::find_edges() {
    std::vector<HalfEdge> halves;
    halves.reserve(corners_.size());
    for (uint32_t corner = 0; corner < corners_.size(); ++corner) {
        const uint32_t triangle = corner / 3;
        const uint32_t a = corners_[corner], b = corners_[3 * triangle + (corner + 1) % 3];
        halves.push_back({std::min(a, b), std::max(a, b), a < b, triangle});
    }
    std::ranges::sort(halves, [](const HalfEdge& a, const HalfEdge& b) { return a < b; });
    for (size_t first = 0, last; first < halves.size(); first = last) {
        const HalfEdge& one = halves[first];
        for (last = first + 1; last < halves.size() && !(one < halves[last]);)
            ++last;
        ++edge_count_;
        if (last == first + 2 && one.low != one.high && one.forward != halves[first + 1].forward)
            edges_.push_back({one.low, one.high, one.triangle, halves[first + 1].triangle});
    }
}

void SoundTargets::find_vertices() {
    first_at_.assign(positions_.size() + 1, 0);
    for (const uint32_t vertex : corners_)
        ++first_at_[vertex + 1];
    std::partial_sum(first_at_.begin(), first_at_.end(), first_at_.begin());
    at_.resize(corners_.size());
    std::vector<uint32_t> next(first_at_.begin(), first_at_.end() - 1);
    for (uint32_t corner = 0; corner < corners_.size(); ++corner)
        at_[next[corners_[corner]]++] = corner / 3;
    // A triangle has two edges at a vertex, and a sound edge has two triangles, so a sound vertex
    // has as many sound edges as triangles.
    std::vector<uint32_t> sound_at(positions_.size(), 0);
    for (const Edge& edge : edges_) {
        ++sound_at[edge.a];
        ++sound_at[edge.b];
    }
    for (uint32_t vertex = 0; vertex < positions_.size(); ++vertex)
        if (sound_at[vertex] > 0 && sound_at[vertex] == triangles_at(vertex).size())
            vertices_.push_back(vertex);
}

std::span<const uint32_t> SoundTargets::triangles_at(uint32_t vertex) const {
    return {at_.data() + first_at_[vertex], at_.data() + first_at_[vertex + 1]};
}

/// Returns whether the ray sees all fronts or all backs, none of them so narrow or so steep that
/// the rounding of the ray matters.
bool SoundTargets::surrounds(std::span<const uint32_t> triangles, const Ray& ray) const {
    double side = 0;
    for (const uint32_t triangle : triangles) {
        const uint32_t* v = &corners_[size_t(triangle) * 3];
        const dvec3 &a = positions_[v[0]], &b = positions_[v[1]], &c = positions_[v[2]];
        const dvec3 normal = glm::cross(b - a, c - a);
        const double longest =
            std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        const double reach = std::max(max_component(glm::abs(ray.org)), max_component(glm::abs(a)));
        const double facing = glm::dot(normal, ray.dir);
        // facing / (longest |dir|) is the triangle's min height as the ray sees it.
        if (!(std::abs(facing) > 1e-13 * reach * longest * glm::length(ray.dir)) ||
            side * facing < 0)
            return false;
        side = facing;
    }
    return true;
}

AimedRays SoundTargets::rays(Random& random, size_t count) const {
    AimedRays set;
    if (edges_.empty() || vertices_.empty())
        return set;
    // Tries are limited, because far from the origin nearly all triangles may be too narrow for
    // double.
    for (size_t tries = 0; set.rays.size() < count && tries < 1000 * count; ++tries) {
        const Edge& edge = edges_[random.below(uint32_t(edges_.size()))];
        const bool at_vertex = random.chance(0.5);
        const uint32_t vertex = vertices_[random.below(uint32_t(vertices_.size()))];
        const double weight = random.uniform(0.125, 0.875);
        const dvec3 &a = positions_[edge.a], &b = positions_[edge.b];
        const dvec3 target = at_vertex ? positions_[vertex] : a + weight * (b - a);
        const double nearest = glm::length(b - a), share = random.uniform();
        const double away = std::pow(nearest, 1 - share) * std::pow(2 * size_, share);
        Ray ray;
        ray.org = target + away * random.direction();
        ray.dir = target - ray.org;
        const std::array<uint32_t, 2> beside = {edge.left, edge.right};
        if (surrounds(at_vertex ? triangles_at(vertex) : beside, ray))
            set.rays.push_back(ray);
    }
    return set;
}

} // namespace ovc
